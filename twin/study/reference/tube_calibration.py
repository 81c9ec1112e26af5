"""The prediction tube of a ship from reference voyages (the ship file's [tube]; twin/live/prediction).

    s = |(along/sigma_along, across/sigma_across)|,  |heading|/sigma_heading        scores
    log sigma = log usual + c . phi      ridge regression of log|error|, a third of the voyages, 12 at most
    q = hierarchical quantile of the scores of all others, the voyage as unit

Split conformal prediction [Vovk 2012; Lee, Barber & Willett 2023, arXiv:2306.06342]: for a random moment of a
new voyage exchangeable with these the score is below q with the level at least, whatever the correlation
within voyages; a level is finite from V >= level/(1 - level) voyages on. With V of them q is that of the
level (V + 1)/V times as high, so a regime has its own q only where that costs no more than two per cent: 45
voyages.
"""

from collections.abc import Mapping, Sequence
from math import ceil, hypot
from typing import Any

import numpy as np
from numpy.typing import NDArray

from twin.errors import DataError
from twin.live.observer.predict import usual_error
from twin.live.prediction.calibrated import AXES, Horizon, RegionTable
from twin.live.prediction.circumstances import HELMS, NAMES, SEAS
from twin.live.prediction.judge import VerifiedPrediction
from twin.physics.ship import Ship
from twin.study.reference.foretold import Errors
from twin.study.reference.hierarchical import hierarchical_quantile

LEVEL = 0.9
LEVELS = (0.8, 0.85, 0.88, 0.9, 0.92, 0.94, 0.96, 0.98)
FEWEST_FIT, MOST_FIT = 4, 12  # voyages that the regression takes
COST = 0.02  # what a regime's own quantile may be above the level for want of voyages
LEAST_ERROR_SHARE = 0.05  # of the mean error: a smaller one counts as this in log|error|
Array = NDArray[np.float64]


def needed(level: float) -> int:
    """Voyages from which a level can be shown."""
    return ceil(level / (1.0 - level) - 1e-9)


def needed_for_regime() -> int:
    """Voyages from which a regime has a quantile of its own."""
    return ceil(LEVEL / COST - 1e-9)


def parted(count: int) -> list[bool]:
    """Which of so many voyages the regression takes, evenly spread; the others give the quantiles."""
    fit = min(count // 3, MOST_FIT, count - needed(LEVEL))
    if fit < FEWEST_FIT:
        return [False] * count
    chosen = {round((k + 0.5) * count / fit - 0.5) for k in range(fit)}
    return [k in chosen for k in range(count)]


def section(ship: Ship, model: str, voyages: Sequence[Errors], source: str) -> dict[str, Any]:
    """The table [tube]. DataError where no voyage shows anything."""
    used = [v for v in voyages if any(v.values())]
    if not used:
        raise DataError(
            "no prediction came due on these voyages with helm and engine held, so nothing can be learned of "
            "them. Give voyages with straight or steady stretches of some minutes."
        )
    horizons = [h for h in used[0] if any(v[h] for v in used)]
    every = [j for v in used for h in horizons for j in v[h]]
    phi = np.array([(*j.foretold.known.place, *j.foretold.known.heading[6:]) for j in every])
    table: dict[str, Any] = {
        "level": LEVEL,
        "voyages": len(used),
        "model": model,
        "source": source,
        "seas": [s for s in SEAS if any(j.foretold.known.sea == s for j in every)],
        "horizons_s": horizons,
        "levels": list(LEVELS),
        "lowest": digits(phi.min(axis=0)),
        "highest": digits(phi.max(axis=0)),
    }
    for h in horizons:
        table |= _horizon(ship, h, [v[h] for v in used if v[h]], table)
    return table


def _horizon(
    ship: Ship, h: float, voyages: Sequence[Sequence[VerifiedPrediction]], table: Mapping[str, Any]
) -> dict[str, Any]:
    """Coefficients and cells of one horizon."""
    usual, chosen = usual_error(ship, h)[:2], parted(len(voyages))
    fitted = [v for v, fit in zip(voyages, chosen, strict=True) if fit]
    rows = coefficients(fitted, usual)
    only = RegionTable(
        LEVEL,
        0,
        "",
        LEVELS,
        tuple(table["lowest"]),
        tuple(table["highest"]),
        (),
        {h: Horizon(tuple(tuple(c) for c in rows), {})},
    )
    scored = [
        [(j, *score(only, h, j, usual)) for j in v] for v, fit in zip(voyages, chosen, strict=True) if not fit
    ]
    out: dict[str, Any] = {f"{axis}_{h:g}s": c for axis, c in zip(AXES, rows, strict=True)}
    for name, cell in _cells(scored).items():
        out[f"cell_{h:g}s_{name}"] = cell
    return out


def score(
    table: RegionTable, h: float, j: VerifiedPrediction, usual: tuple[float, ...]
) -> tuple[float, float]:
    """Of place and of heading: the error over what is usual in these circumstances."""
    along, across, heading = table.sigmas(h, j.foretold.known, (usual[0], usual[1]))
    return hypot(j.along / along, j.across / across), abs(j.heading) / heading


def coefficients(
    voyages: Sequence[Sequence[VerifiedPrediction]], usual: tuple[float, ...]
) -> list[list[float]]:
    """c of along, across and heading; all zero without voyages."""
    if not voyages:
        return [[0.0] * len(NAMES)] * len(AXES)
    weights = np.concatenate([np.full(len(v), 1.0 / len(v)) for v in voyages])
    every = [j for v in voyages for j in v]
    place, heading = (np.array([getattr(j.foretold.known, of) for j in every]) for of in ("place", "heading"))
    targets = ((place, "along", usual[0]), (place, "across", usual[0]), (heading, "heading", usual[1]))
    return [
        digits(ridge(phi, np.array([abs(getattr(j, axis)) for j in every]) / by, weights))
        for phi, axis, by in targets
    ]


def ridge(phi: Array, errors: Array, weights: Array) -> Array:
    """c of log|error| = c . phi, each voyage of weight one; the penalty is that of one voyage, in units of
    each number's own spread. phi (N, F), errors and weights (N,), c (F,)."""
    y = np.log(np.maximum(errors, LEAST_ERROR_SHARE * max(errors.mean(), 1e-12)))
    mean = np.average(phi, axis=0, weights=weights)
    spread = np.sqrt(np.average((phi - mean) ** 2, axis=0, weights=weights))
    moves = spread > 1e-9
    z = (phi[:, moves] - mean[moves]) / spread[moves]
    middle = np.average(y, weights=weights)
    A = (z * weights[:, None]).T @ z + np.eye(z.shape[1])
    b = np.linalg.solve(A, (z * weights[:, None]).T @ (y - middle))
    c = np.zeros(phi.shape[1])
    c[moves] = b / spread[moves]
    c[0] = middle - float(mean[moves] @ c[moves])
    return c


def _cells(voyages: Sequence[Sequence[tuple[VerifiedPrediction, float, float]]]) -> dict[str, dict[str, Any]]:
    """The quantiles of all, and of each regime that enough voyages met."""
    names = ["all", *HELMS, *(f"{helm}_{sea}" for helm in HELMS for sea in SEAS)]
    out = {}
    for name in names:
        inside = [[s for s in v if name in regimes(s[0])] for v in voyages]
        inside = [v for v in inside if v]
        if name == "all" or len(inside) >= needed_for_regime():
            place = quantiles([[place for _, place, _ in v] for v in inside])
            heading = quantiles([[heading for _, _, heading in v] for v in inside])
            count = min(len(place), len(heading))
            out[name] = {"voyages": len(inside), "place": place[:count], "heading": heading[:count]}
    return out


def regimes(j: VerifiedPrediction) -> tuple[str, str, str]:
    """The cells a prediction belongs to, the smallest last."""
    known = j.foretold.known
    return "all", known.helm, f"{known.helm}_{known.sea}"


def quantiles(voyages: Sequence[Sequence[float]]) -> list[float]:
    """At LEVELS as far as they are finite; where the promised one is not, the greatest score alone: the best
    that so few voyages can show."""
    if len(voyages) < needed(LEVEL):
        return raised([max(s for v in voyages for s in v)])
    found = [hierarchical_quantile(voyages, level) for level in LEVELS]
    return raised([q for q in found if np.isfinite(q)])


def raised(values: Sequence[float]) -> list[float]:
    """Five digits, rounded up: what is promised stays promised."""
    return [float(f"{x:.5g}") if float(f"{x:.5g}") >= x else float(f"{x * 1.0001:.5g}") for x in values]


def digits(values: Any) -> list[float]:
    """Five digits are enough, and a person can read them."""
    return [float(f"{x:.5g}") for x in values]

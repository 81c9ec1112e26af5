"""Coverage, width and interval score of tubes on voyages that they were not calibrated with.

A tube is made of one set of voyages (`twin/study/reference/tube_calibration.py`) and judged on another by the
code that runs on board (`twin/live/prediction/calibrated.py`), without its slow correction."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from math import degrees, sqrt
from typing import NamedTuple

import numpy as np

from bench.tube.sailing import HORIZONS_S, TubeVoyage
from twin.live.observer.predict import usual_error
from twin.live.prediction.calibrated import SECTION, RegionTable, calibrated_of
from twin.live.prediction.circumstances import HELMS, SEAS
from twin.live.prediction.coverage import score
from twin.live.prediction.judge import VerifiedPrediction
from twin.physics import ship as ships
from twin.physics.ship import Ship
from twin.study.reference.foretold import Errors
from twin.study.reference.tube_calibration import section

LEAST_VOYAGES = 9  # voyages of which a row is made
EVERY = "every"


class TubeCoverage(NamedTuple):
    """One prediction: helm and sea, half widths and errors of place [m] and of heading [rad]."""

    helm: str
    sea: str
    radius: float
    error: float
    heading: float
    heading_error: float


class CoverageRow(NamedTuple):
    """One horizon, one group: `voyages` that were judged; shares inside, each voyage of weight one, and the
    standard deviation of such a share of places from voyage to voyage; means of half widths and scores."""

    horizon_s: float
    group: str
    voyages: int
    predictions: int
    calibrated_on: float
    place_inside: float
    place_spread: float
    heading_inside: float
    heading_spread: float
    place_m: float
    heading_deg: float
    place_score_m: float
    heading_score_deg: float


def table_of(ship: Ship, voyages: Sequence[Errors]) -> RegionTable:
    """The tube of these voyages, as a ship file's [tube] is read."""
    made = calibrated_of(replace(ship, notes={SECTION: section(ship, "", voyages, "")}))
    assert made is not None
    return made


def verified(
    ship: Ship, table: RegionTable, h: float, voyage: Sequence[VerifiedPrediction]
) -> list[TubeCoverage]:
    """The predictions of one voyage inside or outside a tube."""
    usual, out = usual_error(ship, h), []
    for j in voyage:
        known = j.foretold.known
        along, across, heading = table.sigmas(h, known, (usual[0], usual[1]))
        _, cell = table.cell(h, known)
        q, q_psi = (table.quantile(of, table.level) for of in (cell.place, cell.heading))
        radius, size = q * sqrt(along * across), sqrt((j.along / along) ** 2 + (j.across / across) ** 2)
        out.append(
            TubeCoverage(
                known.helm, known.sea, radius, size * sqrt(along * across), q_psi * heading, abs(j.heading)
            )
        )
    return out


def left_out(hull: str, voyages: Sequence[TubeVoyage], who: str) -> list[CoverageRow]:
    """Each voyage judged by a tube of all others; `who`: "model" or "reckoning"."""
    ship, errors = ships.load(hull), [getattr(v, who) for v in voyages]
    found: dict[float, list[list[TubeCoverage]]] = {h: [] for h in HORIZONS_S}
    rests: dict[float, list[int]] = {h: [] for h in HORIZONS_S}
    for k, mine in enumerate(errors):
        others = table_of(ship, [*errors[:k], *errors[k + 1 :]])
        for h in others.horizons:
            found[h].append(verified(ship, others, h, mine[h]))
            rests[h].append(others.horizons[h].cells["all"].voyages)
    return [r for h in HORIZONS_S for r in _rows(h, found[h], rests[h])]


def across(of: str, to: str, voyages: Mapping[str, Sequence[TubeVoyage]]) -> list[CoverageRow]:
    """Every voyage of hull `to` judged by the tube of all voyages of hull `of`."""
    table = table_of(ships.load(of), [v.model for v in voyages[of]])
    ship = ships.load(to)
    out: list[CoverageRow] = []
    for h in table.horizons:
        found = [verified(ship, table, h, v.model[h]) for v in voyages[to]]
        out += _rows(h, found, [table.horizons[h].cells["all"].voyages], regimes=False)
    return out


def _rows(
    h: float, voyages: Sequence[list[TubeCoverage]], rests: Sequence[int], regimes: bool = True
) -> Iterable[CoverageRow]:
    groups = [(EVERY, voyages)]
    for of, names in (("helm", HELMS), ("sea", SEAS)) if regimes else ():
        groups += [(f"{of} {n}", [[k for k in v if getattr(k, of) == n] for v in voyages]) for n in names]
    for name, group in groups:
        used = [v for v in group if v]
        if len(used) >= LEAST_VOYAGES:
            yield _row(h, name, used, float(np.mean(rests)))


def _row(h: float, name: str, voyages: Sequence[list[TubeCoverage]], rests: float) -> CoverageRow:
    place = [np.mean([k.error <= k.radius for k in v]) for v in voyages]
    heading = [np.mean([k.heading_error <= k.heading for k in v]) for v in voyages]

    def mean(of: str, by: str | None = None) -> float:
        values = [
            [score(getattr(k, of), getattr(k, by), 0.1) if by else getattr(k, of) for k in v] for v in voyages
        ]
        return float(np.mean([np.mean(v) for v in values]))

    return CoverageRow(
        h,
        name,
        len(voyages),
        sum(len(v) for v in voyages),
        rests,
        float(np.mean(place)),
        float(np.std(place)),
        float(np.mean(heading)),
        float(np.std(heading)),
        mean("radius"),
        degrees(mean("heading")),
        mean("radius", "error"),
        degrees(mean("heading", "heading_error")),
    )

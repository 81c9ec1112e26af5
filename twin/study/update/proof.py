"""Does a change of the model lower its error on measurements it was not fitted to? Paired windows,
bootstrapped in blocks.

Source: Kuensch (1989) The jackknife and the bootstrap for general stationary observations, Ann. Statist. 17,
    1217-1241.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import stdtrit

from twin.errors import DataError
from twin.physics.ship import Ship
from twin.study.prediction import locate, score
from twin.study.prediction.openloop import MODEL, SENSORS, Windows
from twin.study.track.track import MEASURED

FEWEST = 2.0  # windows that do not overlap, below which nothing can be proved
# windows from which a horizon can prove something; and it sails so many ship lengths
ENOUGH, LENGTHS = 10.0, 3.0
RESAMPLES = 2000
NOTHING = "no reading"  # what an effect changes that was fitted to nothing
UNCHANGED = 1e-6  # [m, rad] predictions of the position nearer than this are the same


@dataclass(frozen=True)
class Fall:
    """`measure`: what was judged, in `unit`; mean error at the horizon; low95, high95: interval of after -
    before."""

    measure: str
    unit: str
    before: float
    after: float
    low95: float
    high95: float
    windows: int
    horizon_s: float

    @property
    def proved(self) -> bool:
        return self.high95 < 0.0

    @property
    def idle(self) -> bool:
        """Whether nothing is predicted otherwise: the effect was fitted to nothing."""
        return self.measure.startswith(f"error of {NOTHING}")

    def sentence(self) -> str:
        change = f"{self.after - self.before:+.3g} ({self.low95:+.2g} to {self.high95:+.2g})"
        sizes = f"{self.before:.4g} -> {self.after:.4g} {self.unit}"
        return f"{self.measure} {sizes}, change {change} on {self.windows} held-out windows"


def judged_at(before: Sequence[Windows], horizons_s: Sequence[float], ship: Ship) -> float:
    """The longest horizon of which the voyages hold enough windows that do not overlap, but none so short
    that she hardly moves; the longest of all where none has. Two minutes are three lengths of a tanker and 20
    lengths of a boat, whose voyage may hold five of them."""
    least = LENGTHS * float(ship.scale("time"))
    enough = [
        h
        for h in horizons_s
        if h >= least and sum(w.valid[w.at(h)].sum() / _block(w, h) for w in before) >= ENOUGH
    ]
    return max(enough, default=max(horizons_s))


def fall(before: Sequence[Windows], after: Sequence[Windows], horizon_s: float) -> Fall:
    """Judge by the position error at the horizon; by the instruments that changed, when position predictions
    are the same."""
    measure, unit, pairs = _judged(before, after, horizon_s)
    errors = [(b, a, w) for (b, a), w in zip(pairs, before, strict=True)]
    kept = [np.isfinite(b) & np.isfinite(a) for b, a, _ in errors]
    b = np.concatenate([e[0][k] for e, k in zip(errors, kept, strict=True)])
    a = np.concatenate([e[1][k] for e, k in zip(errors, kept, strict=True)])
    changes, blocks = (
        [e[1][k] - e[0][k] for e, k in zip(errors, kept, strict=True)],
        [_block(w, horizon_s) for w in before],
    )
    independent = sum(c.size / block for c, block in zip(changes, blocks, strict=True))
    if independent < FEWEST:
        names = ", ".join(w.track.name for w in before)
        raise DataError(
            f"{names}: what is left to judge by holds {independent:.1f} windows of {horizon_s:g} s that do "
            "not overlap; "
            f"at least {FEWEST:g} are needed. Give a longer voyage, or another one with --held-out."
        )
    low, high = _interval(_bootstrap(changes, blocks), float((a - b).mean()), independent)
    return Fall(measure, unit, float(b.mean()), float(a.mean()), float(low), float(high), b.size, horizon_s)


def _interval(means: np.ndarray, middle: float, independent: float) -> tuple[float, float]:
    """95 % about the change, widened as Student's t is for so few independent windows."""
    wider = float(stdtrit(independent - 1.0, 0.975)) / 1.96
    low, high = np.quantile(means, [0.025, 0.975])
    return middle + wider * (float(low) - middle), middle + wider * (float(high) - middle)


def _judged(
    before: Sequence[Windows], after: Sequence[Windows], horizon_s: float
) -> tuple[str, str, list[tuple[np.ndarray, np.ndarray]]]:
    """The name and unit of the measure, and for each voyage the errors (W,) before and after."""
    moved = max(
        float(np.nanmax(np.abs(a.promised[MODEL, ..., :3] - b.promised[MODEL, ..., :3])))
        for b, a in zip(before, after, strict=True)
    )
    rows = [w.at(horizon_s) for w in before]
    if moved > UNCHANGED:
        name = f"position error at {horizon_s:g} s"
        return (
            name,
            "m",
            [
                (b.errors()["position"][k], a.errors()["position"][k])
                for b, a, k in zip(before, after, rows, strict=True)
            ],
        )
    touched = [
        i
        for i in range(3, len(MEASURED))
        if any(
            _read(b, i) and not np.allclose(a.promised[MODEL, ..., i], b.promised[MODEL, ..., i])
            for b, a in zip(before, after, strict=True)
        )
    ]
    names = [list(MEASURED.values())[i] for i in touched] or [NOTHING]
    noise = {
        i: float(np.mean([np.nanmean(np.abs(w.off(SENSORS)[..., i])) for w in before if _read(w, i)]))
        for i in touched
    }

    def size(w: Windows, k: int) -> np.ndarray:
        mine = [np.abs(w.off()[k, :, i]) / n for i, n in noise.items() if _read(w, i)]
        return np.mean(mine, axis=0) if mine else np.full(w.start.size, np.nan if touched else 0.0)

    return (
        f"error of {', '.join(names)} at {horizon_s:g} s",
        "times its noise",
        [(size(b, k), size(a, k)) for b, a, k in zip(before, after, rows, strict=True)],
    )


def _read(w: Windows, reading: int) -> bool:
    """Whether this instrument was on board: a log of one axis shows no drift."""
    return bool(np.isfinite(w.track.sd[reading]))


def _block(w: Windows, horizon_s: float) -> int:
    """Windows that overlap one another: they are one observation."""
    stride = (w.start[1] - w.start[0]) * w.track.h if w.start.size > 1 else horizon_s
    return max(1, int(np.ceil(horizon_s / stride)))


def _bootstrap(changes: Sequence[np.ndarray], blocks: Sequence[int]) -> np.ndarray:
    """(RESAMPLES,) means of the changes, resampled in blocks within each voyage (joined end to beginning)."""
    rng = np.random.default_rng(0)
    total, count = np.zeros(RESAMPLES), 0
    for change, block in zip(changes, blocks, strict=True):
        if not change.size:
            continue
        sums = np.cumsum(
            np.concatenate(
                [[0.0], change, change[: block - 1] if change.size >= block else np.resize(change, block - 1)]
            )
        )
        runs = sums[block:] - sums[:-block]
        needed = int(np.ceil(change.size / block))
        total += runs[rng.integers(0, runs.size, (RESAMPLES, needed))].sum(1) / (needed * block) * change.size
        count += change.size
    return total / count if count else np.array([])


def ladder(
    before: Sequence[Windows], after: Sequence[Windows], horizons_s: Sequence[float], structural: bool
) -> list[dict[str, Any]]:
    """One row for each horizon: errors before and after, and the floor."""
    rows = zip(
        score.horizons(before, horizons_s, structural),
        score.horizons(after, horizons_s, structural),
        strict=True,
    )
    keys = score.NAMES.values()
    return [
        {
            "horizon_s": b["horizon_s"],
            "windows": b["windows"],
            "before": {k: b[k] for k in keys},
            "after": {k: a[k] for k in keys},
            "noise_floor": a["noise_floor"],
        }
        for b, a in rows
    ]


def by_regime(
    before: Sequence[Windows], after: Sequence[Windows], horizon_s: float, ship: Ship, structural: bool
) -> list[dict[str, Any]]:
    """Where the model failed before, and what became of it: mean position error [m] before and after."""
    b, a = score.pooled(before, horizon_s)["position"], score.pooled(after, horizon_s)["position"]
    everywhere = [{"condition": "everywhere", "time_share": 1.0, "mask": np.isfinite(b)}]
    return [
        {
            "condition": r["condition"],
            "time_share": r["time_share"],
            "before_m": float(np.nanmean(b[r["mask"]])),
            "after_m": float(np.nanmean(a[r["mask"]])),
        }
        for r in everywhere + locate.regimes(before, horizon_s, ship, structural)
    ]

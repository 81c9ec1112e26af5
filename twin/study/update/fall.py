"""A change in metres: mean error before and after at one horizon, with the interval of the change. It
illustrates a proof and decides nothing."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.num import as_given, num
from twin.physics.ship import Ship
from twin.study.prediction import locate, score
from twin.study.prediction.expected import with_expected_errors
from twin.study.prediction.openloop import MODEL, Windows
from twin.study.track.track import MEASURED
from twin.study.update.proof import block_interval, independent

UNCHANGED = 1e-6  # [m, rad] predictions of the position nearer than this are the same
UNITS = ("m", "m", "deg", "m/s", "m/s", "deg/s", "m/s", "m/s")
ENOUGH = 2.0  # windows that do not overlap


@dataclass(frozen=True)
class Fall:
    """`measure`: what is shown, in `unit`; its mean at the horizon before and after; low95, high95: interval
    of after - before."""

    measure: str
    unit: str
    before: float
    after: float
    low95: float
    high95: float
    windows: int
    horizon_s: float

    def sentence(self) -> str:
        """The change in words, with its interval."""
        return (
            f"{self.measure} {num(self.before, 3)} -> {num(self.after, 3)} {self.unit} (change "
            f"{num(self.low95, 2, sign=True)} to {num(self.high95, 2, sign=True)})"
        )

    def entry(self) -> dict[str, Any]:
        """Its entry in the JSON."""
        names = ("measure", "unit", "before", "after", "low95", "high95")
        return {name: getattr(self, name) for name in names}


def fall(before: Sequence[Windows], after: Sequence[Windows], horizons_s: Sequence[float]) -> Fall:
    """Of the position at the longest horizon that the voyages hold twice; where none is predicted otherwise,
    of the reading that changed most."""
    horizon = max(
        (h for h in horizons_s if sum(independent(w, h) for w in before) >= ENOUGH), default=min(horizons_s)
    )
    reading = _reading(before, after)
    sizes = [[_size(w, reading, horizon) for w in both] for both in zip(before, after, strict=True)]
    kept = [np.isfinite(b) & np.isfinite(a) for b, a in sizes]
    b, a = (np.concatenate([each[i][k] for each, k in zip(sizes, kept, strict=True)]) for i in (0, 1))
    changes = [(each[1] - each[0])[k] for each, k in zip(sizes, kept, strict=True)]
    count = max(1, b.size)
    low, high = block_interval([c / count for c in changes], before, horizon)
    name = "position" if reading is None else list(MEASURED.values())[reading]
    unit = "m" if reading is None else UNITS[reading]
    mean_b, mean_a = (float(x.mean()) if x.size else float("nan") for x in (b, a))
    return Fall(f"{name} error at {as_given(horizon, 4)} s", unit, mean_b, mean_a, low, high, b.size, horizon)


def _reading(before: Sequence[Windows], after: Sequence[Windows]) -> int | None:
    """None where the position is predicted otherwise, or nothing is; else the reading that was on board and
    changed most in units of its scatter."""
    change = np.zeros(len(MEASURED))
    for b, a in zip(before, after, strict=True):
        moved = np.abs(a.promised[MODEL] - b.promised[MODEL]).max((0, 1), initial=0.0)
        if moved[:3].max() > UNCHANGED:
            return None
        change = np.maximum(change, np.where(np.isfinite(b.track.sd), np.nan_to_num(moved / b.track.sd), 0.0))
    return int(np.argmax(change)) if change.max() > UNCHANGED else None


def _size(w: Windows, reading: int | None, horizon_s: float) -> np.ndarray:
    """(W,) size of the error at the horizon."""
    k = w.at(horizon_s)
    if reading is None:
        return w.errors()["position"][k]
    return np.abs(w.off()[k, :, reading]) * (180.0 / np.pi if UNITS[reading].startswith("deg") else 1.0)


def error_rows(
    before: Sequence[Windows],
    after: Sequence[Windows],
    horizons_s: Sequence[float],
    ship: Ship,
    structural: bool,
) -> list[dict[str, Any]]:
    """One row for each horizon: errors before and after, and what a healthy ship would show."""
    rows = zip(
        *(with_expected_errors(score.horizons(w, horizons_s, structural), w, ship) for w in (before, after)),
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

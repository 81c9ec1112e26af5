"""What a fit does not see, and how wrong a model is on it, open loop: by horizon, and by how hard it
turns."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.study.prediction.openloop import HORIZONS_S, ends
from twin.study.reference.sailed import Sailed, fed
from twin.study.track.segments import FEWEST_STEPS, segments
from twin.study.track.track import Track

HeldOut = Sequence[tuple[Track, int]]  # tracks, each with the first grid step that was not used for the fit
LAST = "the last third of the voyages; the ship that is written was then fitted to all"
BANDS = (("straight", 0.0, 0.1), ("turning", 0.1, 0.4), ("turning hard", 0.4, np.inf))  # |r| L/U_0
FIRST = 0.7  # of each voyage is fitted where there are only one or two


def split(fitted: list[Sailed], held_out: list[Sailed], ship: Ship) -> tuple[list[Sailed], HeldOut, str]:
    """What is fitted, what is held out, and how to say so. DataError: the part of a voyage that is fitted is
    nowhere whole for long enough."""
    if held_out:
        return fitted, [(s.track, 0) for s in held_out], "the voyages given with --held-out"
    if len(fitted) > 2:
        keep = len(fitted) - max(1, len(fitted) // 3)
        return fitted[:keep], [(s.track, 0) for s in fitted[keep:]], LAST
    cuts = [int(FIRST * len(s.track)) for s in fitted]
    parts = [replace(s, track=s.track.part(0, cut)) for s, cut in zip(fitted, cuts, strict=True)]
    for t in (s.track for s in parts):
        if not segments([t], float(ship.scale("time"))):
            raise DataError(
                f"{t.name}: in its first {100 * FIRST:.0f} %, which is fitted, rudder, shaft and readings "
                f"are nowhere there together for {FEWEST_STEPS * t.h:.0f} s without a gap. Leave it out, or "
                "give another voyage with --held-out: then all of this one is fitted."
            )
    return (
        parts,
        [(s.track, cut) for s, cut in zip(fitted, cuts, strict=True)],
        "the last 30 % of each voyage",
    )


@dataclass(frozen=True)
class HeldOutErrors:
    """Means over all windows: by horizon, and after the middle horizon by how hard it turned."""

    by_horizon: list[dict[str, float]]
    by_regime: list[dict[str, Any]]


def errors(model: Model, held_out: HeldOut) -> HeldOutErrors:
    """How wrong the model is on what was held out."""
    found = _ends(model, held_out, HORIZONS_S)
    return HeldOutErrors(
        [_mean(horizon, *ends[1:]) for horizon, ends in zip(HORIZONS_S, found, strict=True)],
        _by_regime(HORIZONS_S[1], *found[1][:2]),
    )


def knowing_nothing(held_out: HeldOut, model: Model) -> list[dict[str, float]]:
    """How far off in place [m], mean over the same windows by horizon, predictions are that know nothing of
    the ship: `kept_m` keeps the speeds and the rate of turn with which it began, `stood_m` stands still where
    it began. NaN without a window."""
    means = []
    for horizon in HORIZONS_S:
        off = [_knowing_nothing(track, first, model, horizon) for track, first in held_out]
        found = np.concatenate([np.empty((2, 0)), *off], axis=1)
        kept, stood = found.mean(1).tolist() if found.size else (float("nan"), float("nan"))
        means.append({"kept_m": kept, "stood_m": stood})
    return means


def _knowing_nothing(track: Track, first: int, model: Model, horizon_s: float) -> np.ndarray:
    """(2, W) error in place [m] of each window: with u, v, r held, d(x + iy)/dt = (u + iv) exp(i (psi + r
    t)); with u = v = 0."""
    windows = ends(track, fed(model, track)[0], [horizon_s])[0]
    k = windows.at(horizon_s)
    ok = windows.valid[k] & (windows.start >= first)
    x, y, psi, u, v, r = track.state[windows.start[ok], :6].T
    t = windows.lead[k] * track.h
    chord = t * np.sinc(r * t / (2.0 * np.pi)) * np.exp(1j * (psi + 0.5 * r * t))  # of the circle's arc
    there = windows.seen[windows.step[k][ok]]
    to_go = there[:, 0] + 1j * there[:, 1] - (x + 1j * y)
    return np.abs([(u + 1j * v) * chord - to_go, to_go])


def _mean(horizon_s: float, position: np.ndarray, heading: np.ndarray) -> dict[str, float]:
    place, turn = (float(e.mean()) if e.size else float("nan") for e in (position, heading))
    return {
        "horizon_s": float(horizon_s),
        "windows": position.size,
        "position_m": place,
        "heading_deg": float(np.degrees(turn)),
    }


def _by_regime(horizon_s: float, turning: np.ndarray, position: np.ndarray) -> list[dict[str, Any]]:
    """Position error while sailing straight, turning, and turning hard."""
    parts = [(name, position[(turning >= lo) & (turning < hi)]) for name, lo, hi in BANDS]
    return [
        {"regime": name, "horizon_s": float(horizon_s), "windows": e.size, "position_m": float(e.mean())}
        for name, e in parts
        if e.size
    ]


def size(errors: Sequence[dict[str, float]]) -> float:
    """Errors in place and heading over all horizons, as one number to compare: their mean logarithm."""
    numbers = [e[name] for e in errors if e["windows"] for name in ("position_m", "heading_deg")]
    return float(np.log(np.maximum(numbers, 1e-9)).mean()) if numbers else 0.0


def _ends(
    model: Model, held_out: HeldOut, horizons_s: Sequence[float]
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """For each horizon, of every window that begins in what was held out: |r| L/U_0 as it begins, and how far
    off its end is in place [m] and heading [rad]."""
    found: list[list[list[np.ndarray]]] = [[[np.empty(0)] for _ in range(3)] for _ in horizons_s]
    for track, first in held_out:
        runs = ends(track, fed(model, track)[0], horizons_s)
        for horizon, windows, columns in zip(horizons_s, runs, found, strict=True):
            k = windows.at(horizon)
            ok = windows.valid[k] & (windows.start >= first)
            off = windows.errors()
            turning = np.abs(track.state[windows.start, 5]) * float(model.ship.scale("time"))
            for column, x in zip(columns, (turning, off["position"][k], off["heading"][k]), strict=True):
                column.append(x[ok])
    return [tuple(map(np.concatenate, columns)) for columns in found]  # type: ignore[misc]

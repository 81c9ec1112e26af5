"""Open-loop predictions as numbers: error by horizon and by channel, each beside what noise alone would make
of it."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from twin.study.prediction.windows import MODEL, SENSORS, STRUCTURE, Windows
from twin.study.track.track import MEASURED, READINGS

NAMES = {"position": "position_mae_m", "lateral": "lateral_mae_m", "heading": "heading_mae_deg"}
DEGREES = {"heading": 180.0 / np.pi}
ANGLES = ("psi", "r")  # readings in radians


def pooled(windows: Sequence[Windows], horizon_s: float, run: int = MODEL) -> dict[str, np.ndarray]:
    """(W,) errors at a horizon over all voyages (position, lateral [m], heading [deg]); NaN where there is
    none."""
    parts = [{name: e[w.at(horizon_s)] for name, e in w.errors(run).items()} for w in windows]
    return {name: np.concatenate([p[name] for p in parts]) * DEGREES.get(name, 1.0) for name in NAMES}


def horizons(
    windows: Sequence[Windows], horizons_s: Sequence[float], structural: bool
) -> list[dict[str, Any]]:
    """One row for each horizon that has windows; `noise_floor` is of sensors, and of structure when the ship
    knows it."""
    rows = []
    for horizon in horizons_s:
        errors = pooled(windows, horizon)
        count = int(np.isfinite(errors["position"]).sum())
        if not count:
            continue
        floor = pooled(windows, horizon, STRUCTURE if structural else SENSORS)
        rows.append(
            {"horizon_s": horizon, "windows": count}
            | {NAMES[name]: float(np.nanmean(e)) for name, e in errors.items()}
            | {
                "noise_floor": {NAMES[n]: float(np.nanmean(e)) for n, e in floor.items()}
                | {"of": _of(structural)}
            }
        )
    return rows


def _of(structural: bool) -> str:
    return "sensors and structure" if structural else "sensors"


def channels(windows: Sequence[Windows], structural: bool) -> dict[str, dict[str, float]]:
    """By column: mean error over every lead up to the longest horizon, its floor, R2 and `skill`.

    r2 = 1 - SSE/SST about each voyage's mean of what was measured; skill = 1 - SSE/(SSE of going on as at the
        start, dead reckoning).
    """
    out = {}
    for i, (reading, column) in enumerate(MEASURED.items()):
        k = 180.0 / np.pi if reading in ANGLES else 1.0
        error = np.concatenate([w.off()[..., i].ravel() for w in windows]) * k
        if not np.isfinite(error).any():
            continue
        noise = (
            np.concatenate([w.off(STRUCTURE if structural else SENSORS)[..., i].ravel() for w in windows]) * k
        )
        told = np.concatenate(
            [_about_its_mean(np.where(w.valid, w.seen[w.step, i], np.nan)) for w in windows]
        )
        naive = np.concatenate([reckoned(w)[..., i].ravel() for w in windows]) * k
        out[column] = {
            "mae": float(np.nanmean(np.abs(error))),
            "noise": float(np.nanmean(np.abs(np.where(np.isfinite(error), noise, np.nan)))),
            "r2": _explained(error, told * k),
            "skill": _explained(error, naive),
        }
    return out


def _about_its_mean(told: np.ndarray) -> np.ndarray:
    """(N,) what was measured on a voyage, less its mean; NaN where it was not read."""
    read = np.isfinite(told)
    return np.asarray((told - told[read].mean() if read.any() else told).ravel())


def _explained(error: np.ndarray, against: np.ndarray) -> float:
    both = np.isfinite(error) & np.isfinite(against)
    total = float(np.sum(against[both] ** 2))
    return 1.0 - float(np.sum(error[both] ** 2)) / total if total > 0.0 else float("nan")


def reckoned(w: Windows) -> np.ndarray:
    """(K, W, 8) error of dead reckoning: u, v, r of the start held. In SI."""
    x, y, psi, u, v, r = w.track.state[w.start].T
    t = (w.lead * w.track.h)[:, None]
    turned = 0.5 * r * t
    chord = t * np.sinc(turned / np.pi)
    c, s = np.cos(psi + turned) * chord, np.sin(psi + turned) * chord
    log = w.seen[w.start, 6:].T
    held = [
        x + u * c - v * s,
        y + u * s + v * c,
        psi + r * t,
        *(np.broadcast_to(a, t.shape[:1] + u.shape) for a in (u, v, r, *log)),
    ]
    off = np.stack(held, -1) - w.seen[w.step]
    off[..., READINGS.index("psi")] = (off[..., 2] + np.pi) % (2.0 * np.pi) - np.pi
    return np.where(w.valid[..., None], off, np.nan)


def in_noise(row: dict[str, Any], name: str = "position_mae_m") -> float:
    """An error of a horizon in units of its floor."""
    return row[name] / max(row["noise_floor"][name], 1e-12)

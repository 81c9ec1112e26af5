"""What the page plots: measured, modelled and residual series, the heat strip and the track, as compact
arrays.

The model's line is open loop: it is started anew from the measured state every `longest` seconds, never
fitted to the voyage."""

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np

from twin.live.signals.channels import BY_NAME, of_actuators
from twin.physics.model import Model
from twin.recording.voyage import Voyage
from twin.study.prediction.openloop import predict
from twin.study.prediction.score import ANGLES
from twin.study.prediction.windows import MODEL, SENSORS, STRUCTURE, Windows
from twin.study.reference.sailed import fed
from twin.study.track.track import MEASURED, READINGS, Track

SHORTEST_S = 5.0  # a last stretch at least so long is drawn too
EVERY = 10**6  # leads: all of them
HEAT_S = 60.0  # the heat strip shows errors up to this far ahead
INPUTS = {  # what a track itself holds, when no voyage is given
    "delta": "rudder_angle_deg",
    "n": "propeller_rate_rpm",
    "wind_speed": "true_wind_speed_mps",
    "depth": "water_depth_m",
    "H_s": "wave_height_significant_m",
    "draught": "draught_mean_m",
    "phi": "roll_deg",
}


def packed(values: np.ndarray) -> str:
    """Values (N, ...) as float32, little-endian, base64, in whatever unit they have."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode()


def stitched(track: Track, model: Model, longest_s: float) -> tuple[np.ndarray, np.ndarray]:
    """(N, 8) open-loop readings in SI along the whole track, begun anew every `longest_s`, and the steps
    (W,) at which they begin; NaN where the controls are not known all the way from there, or the position was
    not read there. Where they end it need not have been."""
    w = predict(
        track, fed(model, track)[0], (min(SHORTEST_S, longest_s), longest_s), stride_s=longest_s, leads=EVERY
    )
    begins = np.isfinite(w.seen[w.start, :3]).all(1)
    line = np.full((len(track), len(READINGS)), np.nan)
    for j, (start, end) in enumerate(zip(w.start, [*w.start[1:], len(track) - 1], strict=True)):
        lead = w.lead[w.lead <= end - start]
        known = np.logical_and.accumulate(track.whole[start : end + 1])[lead] & begins[j]
        line[start + lead] = np.where(known[:, None], w.promised[MODEL, : lead.size, j], np.nan)
    return line, w.start


def drawn(
    track: Track,
    w: Windows,
    models: dict[str, Model],
    longest_s: float,
    structural: bool,
    voyage: Voyage | None,
) -> dict[str, Any]:
    """Everything the page shows of one voyage; `models`: by the name of their line."""
    lines = {name: stitched(track, model, longest_s) for name, model in models.items()}
    times, inputs = Times(), []
    grid = times.place(track.t)
    begun = next(iter(lines.values()))[1]
    channels = [
        c
        for i in range(len(READINGS))
        if (c := _reading(i, track, lines, w, structural, voyage, times, grid))
    ]
    inputs = _inputs(track, voyage, times, grid)
    return {
        "name": track.name,
        "start_s": float(track.t[0]),
        "end_s": float(track.t[-1]),
        "grid": grid,
        "restarts": track.t[begun].round(3).tolist(),
        "channels": channels,
        "inputs": inputs,
        "heat": _heat(w, structural),
        "track": _track(track, lines),
        "times": times.packed,
    }


class Times:
    """Time bases, each packed once and spoken of by number."""

    def __init__(self) -> None:
        self.packed: list[str] = []
        self._known: dict[bytes, int] = {}

    def place(self, t: np.ndarray) -> int:
        """The number of a time base (N,) [s]."""
        key = t.astype("<f4").tobytes()
        if key not in self._known:
            self._known[key] = len(self.packed)
            self.packed.append(base64.b64encode(key).decode())
        return self._known[key]

    def series(self, t: np.ndarray, y: np.ndarray) -> dict[str, Any]:
        """Only the samples that are there; t (N,) [s], y (N,) in whatever unit it has."""
        there = np.isfinite(y)
        return {"t": self.place(t[there]), "y": packed(y[there])}


def _reading(
    i: int,
    track: Track,
    lines: dict[str, tuple[np.ndarray, np.ndarray]],
    w: Windows,
    structural: bool,
    voyage: Voyage | None,
    times: Times,
    grid: int,
) -> dict[str, Any] | None:
    name, k = list(MEASURED.values())[i], 180.0 / np.pi if READINGS[i] in ANGLES else 1.0
    if not np.isfinite(track.measured[:, i]).any():
        return None
    measured = times.series(track.t, track.measured[:, i] * k)
    if voyage is not None and voyage.has(name):
        measured = times.series(*_raw(voyage, name, track))
    noise = (
        np.nanmean(np.abs(w.off(STRUCTURE if structural else SENSORS)[..., i])) if w.valid.any() else np.nan
    )
    out: dict[str, Any] = {
        "name": name,
        "measured": measured,
        "noise": float(noise) * k,
        "lines": {},
        "residuals": {},
    }
    for word, (line, _) in lines.items():
        out["lines"][word] = {"t": grid, "y": packed(line[:, i] * k)}
        out["residuals"][word] = {"t": grid, "y": packed((w.seen[:, i] - line[:, i]) * k)}
    return out


def _raw(voyage: Voyage, name: str, track: Track) -> tuple[np.ndarray, np.ndarray]:
    """A channel as it was recorded, on the track's clock; angles without jumps."""
    t = voyage.time_s - voyage.time_s[0]
    keep = (t >= track.t[0] - track.h) & (t <= track.t[-1] + track.h)
    return t[keep], (voyage.si(name) / BY_NAME[name].to_si)[keep]


def _inputs(track: Track, voyage: Voyage | None, times: Times, grid: int) -> list[dict[str, Any]]:
    """What was recorded beside the motion: controls and weather."""
    if voyage is not None:
        known = [*BY_NAME, *of_actuators(voyage.columns)]
        names = [n for n in known if n not in MEASURED.values() and voyage.has(n)]
        return [{"name": n, "measured": times.series(*_raw(voyage, n, track))} for n in names]
    values = {"delta": track.delta, "n": track.n} | dict(track.weather)
    held = [(INPUTS[n], v) for n, v in values.items() if n in INPUTS]
    return [{"name": n, "measured": {"t": grid, "y": packed(v / BY_NAME[n].to_si)}} for n, v in held]


def _heat(w: Windows, structural: bool) -> dict[str, Any]:
    """Channel x time: mean error of each window up to HEAT_S ahead, in units of its noise."""
    near = w.lead * w.track.h <= HEAT_S + 0.5 * w.track.h  # the horizon itself, on its step
    near = near if near.any() else np.ones_like(near)
    noise = np.abs(w.off(STRUCTURE if structural else SENSORS)[near])
    error = np.abs(w.off()[near])
    rows = []
    for i, name in enumerate(MEASURED.values()):
        there = np.isfinite(error[..., i])
        if there.any():
            count = np.maximum(there.sum(0), 1)
            mean = np.where(there.any(0), np.nansum(np.where(there, error[..., i], 0.0), 0) / count, np.nan)
            rows.append({"name": name, "y": packed(mean / max(float(np.nanmean(noise[..., i])), 1e-12))})
    return {"t": packed(w.track.t[w.start]), "ahead_s": HEAT_S, "rows": rows}


def _track(track: Track, lines: dict[str, tuple[np.ndarray, np.ndarray]], most: int = 6000) -> dict[str, Any]:
    """Positions, thinned."""
    every = max(1, len(track) // most)
    cut = slice(None, None, every)
    lines_xy = {
        name: {"x": packed(line[cut, 0]), "y": packed(line[cut, 1])} for name, (line, _) in lines.items()
    }
    return {
        "t": packed(track.t[cut]),
        "x": packed(track.state[cut, 0]),
        "y": packed(track.state[cut, 1]),
        "lines": lines_xy,
    }


def shown(
    tracks: Sequence[Track],
    windows: Sequence[Windows],
    models: dict[str, Model],
    longest_s: float,
    structural: bool,
    voyages: Sequence[Voyage | None],
) -> list[dict[str, Any]]:
    """All voyages."""
    return [
        drawn(t, w, models, longest_s, structural, v)
        for t, w, v in zip(tracks, windows, voyages, strict=True)
    ]

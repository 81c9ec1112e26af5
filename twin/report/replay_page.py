"""The page of `twin replay`: estimate against measurement, predictions with their tube, health over time."""

import hashlib
from array import array
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from twin.live.bridge.scene import MODES
from twin.live.log_replay import Summary
from twin.live.observer.estimate import STATES
from twin.live.replay_record import Kept, ReplayRecord
from twin.num import as_given, num
from twin.recording.jsonable import plain
from twin.report.page import PLOTS, html
from twin.report.series import Times, packed

CHANNELS = {  # state -> channel, and what its SI unit is divided by at the border
    "x": ("north_m", 1.0),
    "y": ("east_m", 1.0),
    "psi": ("heading_true_north_deg", np.pi / 180.0),
    "u": ("surge_velocity_mps", 1.0),
    "v": ("sway_velocity_mps", 1.0),
    "r": ("yaw_rate_degps", np.pi / 180.0),
}
DRAWN_S = 60.0  # the prediction whose course is drawn beside the measurement: the horizon nearest to this
Columns = Mapping[str, np.ndarray]


def replay_page(summary: Summary, record: ReplayRecord, command: str) -> str:
    """One self-contained HTML page; `command`: what was typed."""
    return html(content(summary, record, command), (*PLOTS, "replay.js"))


def content(summary: Summary, record: ReplayRecord, command: str) -> dict[str, Any]:
    """Everything the page shows, as JSON."""
    start_s = float(record.moments.columns["time_s"][0])
    now = _columns(record.moments, start_s)
    ahead = {h: _columns(kept, start_s) for h, kept in sorted(record.ahead.items())}
    measured = {name: _columns(kept, start_s) for name, kept in record.measured.items()}
    drawn = min(ahead, key=lambda h: abs(h - DRAWN_S), default=None)
    lines = [{"key": "estimate", "colour": "model", "word": "estimate"}]
    if drawn is not None:
        lines.append({"key": "ahead", "colour": "before", "word": f"predicted {as_given(drawn)} s before"})
    ship_file = record.provenance["ship_file"]
    result = summary.as_json() | {"command": command, "files": {"ship": ship_file}}
    return plain(
        {
            "kind": "replay",
            "title": f"{summary.ship}: replay of {Path(summary.log).name}",
            "verdict": sentence(summary),
            "plots": "Predicted, measured, estimated",
            "lines": lines,
            "longest_s": max(ahead, default=60.0),
            "result": result,
            "modes": [
                {"mode": word, "level": MODES[word][0], "spans": _from(s, start_s)}
                for word, s in record.modes.of.items()
            ],
            "reasons": [
                {"reason": word, "spans": _from(record.reasons.of[word], start_s)}
                for word in summary.reasons
                if word in record.reasons.of
            ],
            "voyages": [_voyage(summary, now, measured, ahead, drawn)],
            "provenance": record.provenance,
            "sha256": record.sha256,
            "log_sha256": _sha256(summary.log),
        }
    )


def sentence(summary: Summary) -> str:
    """How far ahead the twin saw."""
    if not summary.foresight:
        return f"{num(summary.duration_s, 3)} s: too short to judge a prediction."
    far = summary.foresight[-1]
    kept = next((c for c in reversed(summary.tube)), None)
    said = (
        f"{as_given(far.horizon_s)} s ahead the twin is off by {num(far.position_m, 3)} m and "
        f"{num(far.heading_deg, 2)} deg"
    )
    if kept is None:
        return f"{said}."
    return (
        f"{said}; {100.0 * kept.place_inside:.0f} % of places {as_given(kept.horizon_s)} s ahead were inside "
        f"the tube, {100.0 * kept.level:.0f} % were promised."
    )


def _columns(kept: Kept, start_s: float) -> dict[str, np.ndarray]:
    """{name: (N,)} as arrays, the time from the first tick [s]."""
    found = {name: _array(column) for name, column in kept.columns.items()}
    return found | {"time_s": found["time_s"] - start_s}


def _array(column: array) -> np.ndarray:  # type: ignore[type-arg]
    return np.array(column, dtype=float)


def _from(spans: list[list[float]], start_s: float) -> list[list[float]]:
    return [[round(a - start_s, 1), round(b - start_s, 1)] for a, b in spans]


def _sha256(path: str) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _voyage(
    summary: Summary,
    now: Columns,
    measured: Mapping[str, Columns],
    ahead: Mapping[float, Columns],
    drawn: float | None,
) -> dict[str, Any]:
    """What is plotted."""
    times = Times()
    grid = times.place(now["time_s"])
    foretold = ahead[drawn] if drawn is not None else None
    channels = [_channel(n, now, measured[n], foretold, times, grid) for n in STATES if _known(now, n)]
    return {
        "name": Path(summary.log).stem,
        "start_s": 0.0,
        "end_s": float(now["time_s"][-1]),
        "grid": grid,
        "restarts": [],
        "channels": channels,
        "inputs": _learned(now, times),
        "foretold": [row for h, p in ahead.items() for row in _tubes(h, p, times)],
        "track": _track(now, measured),
        "times": times.packed,
    }


def _known(now: Columns, name: str) -> bool:
    return bool(np.isfinite(now[f"estimate_{name}"]).any())


def _channel(
    name: str, now: Columns, measured: Columns, foretold: Columns | None, times: Times, grid: int
) -> dict[str, Any]:
    """A state: measured, estimated, and as it was predicted for that moment."""
    channel, unit = CHANNELS[name]
    t, estimate = now["time_s"], _smooth(now[f"estimate_{name}"], name)
    seen = _near(measured["value"], _at(measured["time_s"], t, estimate), name)
    off = (seen - _at(measured["time_s"], t, estimate)) / unit
    lines = {"estimate": {"t": grid, "y": packed(estimate / unit)}}
    residuals = {"estimate": times.series(measured["time_s"], off)}
    if foretold is not None:
        due = foretold["time_s"]
        said = _near(foretold[name], _at(due, t, estimate), name)
        lines["ahead"] = times.series(due, said / unit)
        residuals["ahead"] = times.series(due, (_at(due, measured["time_s"], seen) - said) / unit)
    sigma = now[f"sigma_{name}"]
    return {
        "name": channel,
        "measured": times.series(measured["time_s"], seen / unit),
        "noise": float(np.nanmean(sigma) / unit),
        "noise_word": "one sigma of the estimate",
        "lines": lines,
        "residuals": residuals,
    }


def _tubes(h: float, p: Columns, times: Times) -> list[dict[str, Any]]:
    """Place and heading of the predictions of one horizon: how far off, and the tube. What is promised
    holds while helm and engine are held; where they moved, the error stands apart."""
    t, held, promised = p["time_s"], p["held"] > 0.5, np.isfinite(p["level"])
    half, rows = np.degrees(p["half_turn"]), []
    for word, unit, off, low, high in (
        ("place", "m off", p["place"], np.zeros_like(half), p["radius"]),
        ("heading", "deg off", np.degrees(p["turn"]), -half, half),
    ):
        tube = {"t": times.place(t[promised]), "low": packed(low[promised]), "high": packed(high[promised])}
        apart = {"error": np.where(held, off, np.nan), "moved": np.where(held, np.nan, off)}
        lines = {key: times.series(t, y) for key, y in apart.items()}
        rows.append({"word": f"{word}, {as_given(h)} s ahead", "unit": unit, "tube": tube, **lines})
    return rows


def _learned(now: Columns, times: Times) -> list[dict[str, Any]]:
    """The weight of the learned force, its share, and the samples that were refused, over time."""
    rows = {"weight_of_the_learned_force": now["weight"], "share_of_the_learned_force": now["share"]}
    rows["samples_refused_so_far"] = now["rejected"]
    return [{"name": n, "measured": times.series(now["time_s"], y)} for n, y in rows.items()]


def _track(now: Columns, measured: Mapping[str, Columns]) -> dict[str, Any] | None:
    """Where the ship was, measured and estimated; None without a place."""
    if not measured["x"]["time_s"].size or not measured["y"]["time_s"].size:
        return None
    t = now["time_s"]
    x, y = (packed(_at(t, measured[n]["time_s"], measured[n]["value"])) for n in ("x", "y"))
    lines = {"estimate": {"x": packed(now["estimate_x"]), "y": packed(now["estimate_y"])}}
    return {"t": packed(t), "x": x, "y": y, "lines": lines}


def _smooth(values: np.ndarray, name: str) -> np.ndarray:
    """A heading [rad] without jumps; anything else as it is."""
    if name != "psi":
        return values
    out, there = values.copy(), np.isfinite(values)
    out[there] = np.unwrap(values[there])
    return out


def _near(values: np.ndarray, other: np.ndarray, name: str) -> np.ndarray:
    """A heading [rad] within half a turn of another; anything else as it is."""
    return other + np.angle(np.exp(1j * (values - other))) if name == "psi" else values


def _at(t: np.ndarray, times_s: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values (N,) at other moments (M,), on the line between two; NaN beyond their ends."""
    if times_s.size == 0:
        return np.full(t.shape, np.nan)
    return np.interp(t, times_s, values, left=np.nan, right=np.nan)

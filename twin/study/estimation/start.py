"""Where a prediction begins: the smooth motion without what waves swing, the instruments' known faults
undone, and how far off it may be."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from twin.num import num
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.estimation.respond import later, stretches
from twin.study.track.smooth_motion import smooth_motion
from twin.study.track.track import STATE, Track

ABOUT = 2.5  # periods of the waves
BRIDGE_S = 3.0  # instruments slower than the grid are joined by straight lines over no more than this
ROUNDS = 3  # of the fixed point: faults of place, heading and wind together


def true_motion(track: Track, model: Model) -> tuple[np.ndarray, np.ndarray | None]:
    """(N, 6) the smooth motion in SI as it would be without the model's sensor faults, and the wind's
    direction (N,) [rad] likewise.

    Late places are shown earlier; then place and heading are corrected until the faulty instruments would
    show what they showed; speeds follow from them. What a fault depends on beyond them is taken from the
    motion shown: differences of differences would blow up whatever is fast."""
    wind_to = track.weather.get("wind_to")
    if not _moved(track, model, wind_to):
        return track.state, wind_to
    late_s, model = model.prompt()
    shown = _earlier(track, late_s)
    place = shown[:, :3].copy()
    for _ in range(ROUNDS):
        read = _read(track, model, _turned(shown, place), wind_to)
        place += shown[:, :3] - np.column_stack([read.x, read.y, read.psi])
        if wind_to is not None:
            wind_to = wind_to + track.weather["wind_to"] - read.wind_to
    return kinematics(place, track.h), wind_to


def _earlier(track: Track, late_s: float) -> np.ndarray:
    """(N, 6) the smooth motion, whose places are shown so late, as it was at the time."""
    if not late_s:
        return track.state
    place = later(track, track.state[:, [0, 1, 2, 3, 4, 5, 3, 4]], -late_s)[:, :2]
    return kinematics(np.column_stack([place, track.state[:, 2]]), track.h)


def steadied(track: Track) -> Track:
    """The track with the motion that is slower than the waves, where a sea was seen to work (seaway.py): a
    heading that a wave turned by a degree would lead it astray. A parabola is fitted about each point, over
    so long that waves fall out of it (Savitzky & Golay 1964)."""
    steps = min(2 * round(0.5 * ABOUT * wave_period_s(track) / track.h) + 1, len(track) - 1 + len(track) % 2)
    if steps <= 3:
        return track
    from scipy.signal import savgol_filter  # heavy, and nothing asks for it in calm water

    return replace(track, state=savgol_filter(track.state, steps, 2, axis=0))


def wave_period_s(track: Track) -> float:
    """Of the waves that move the ship most of the time."""
    return 0.0 if track.swell is None else 2.0 * np.pi / float(np.median(track.swell[:, 1:3]))


def waves_on(tracks: Sequence[Track]) -> list[dict[str, Any]]:
    """On which voyages waves were seen to move the ship, and how often."""
    return [{"voyage": t.name, "period_s": wave_period_s(t)} for t in tracks if t.swell is not None]


def waves_in_words(waves: Sequence[dict[str, Any]]) -> list[str]:
    """The same in words."""
    said = "predictions begin from the motion without them, and no effect is made of what they do"
    return [
        f"On {w['voyage']} waves or its own roll move the ship about every {num(w['period_s'], 2)} s: {said}."
        for w in waves
    ]


def undone(track: Track, model: Model) -> Track:
    """The track with the model's sensor faults taken out of the motion and the wind, each stretch of
    consecutive steps by itself; its measurements stay what was shown."""
    if not _moved(track, model, track.weather.get("wind_to")):
        return track
    state, wind_to = zip(*(true_motion(track.part(a, b), model) for a, b in stretches(track)), strict=True)
    wind = {} if wind_to[0] is None else {"wind_to": np.concatenate(wind_to)}
    return replace(track, state=np.concatenate(state), weather=dict(track.weather) | wind)


def _moved(track: Track, model: Model, wind_to: np.ndarray | None) -> bool:
    """Whether any fault touches place, heading or wind direction (most only touch a log or a gyro)."""
    read = _read(track, model, track.state, wind_to)
    return read.wind_to is not wind_to or not np.array_equal(
        np.column_stack([read.x, read.y, read.psi]), track.state[:, :3]
    )


def _turned(shown: np.ndarray, place: np.ndarray) -> np.ndarray:
    """(N, 6) the motion shown, with this place and heading: the same speed over ground, in the axes of that
    heading."""
    c, s = np.cos(shown[:, 2] - place[:, 2]), np.sin(shown[:, 2] - place[:, 2])
    u, v = shown[:, 3], shown[:, 4]
    return np.column_stack([place, u * c - v * s, u * s + v * c, shown[:, 5]])


def kinematics(place: np.ndarray, h: float) -> np.ndarray:
    """(N, 6) the motion along a path of x, y, psi (N, 3). In SI, `h` in [s]."""
    north, east, r = np.gradient(place, h, axis=0).T
    c, s = np.cos(place[:, 2]), np.sin(place[:, 2])
    return np.column_stack([place, north * c + east * s, east * c - north * s, r])


def _read(track: Track, model: Model, state: np.ndarray, wind_to: np.ndarray | None) -> Situation:
    """What the faulty instruments show of a ship that moves so."""
    s = track.instruments(track.situation(**dict(zip(STATE, state.T, strict=True))))
    s.wind_to, s.u_r, s.v_r = wind_to, s.u, s.v
    s.u_dot, s.v_dot, s.r_dot = (np.gradient(x, track.h) for x in (s.u, s.v, s.r))
    for fault in model.faults:
        s = fault.read(replace(s), model.loaded)
    return s


def noisy(track: Track, model: Model, rng: np.random.Generator) -> np.ndarray:
    """(N, 6) one draw of how far the smooth motion is off, when the readings scatter as they do: smoothed
    like the readings. In SI."""
    exact = np.column_stack([track.state, track.measured[:, 6:]])
    shaken = np.where(
        np.isfinite(track.measured), exact + track.sd * rng.standard_normal(exact.shape), np.nan
    )
    return smooth_motion(shaken, track.h, model.ship)[0] - track.state


def seen(track: Track) -> np.ndarray:
    """(N, 8) the readings, each joined by straight lines over holes of at most BRIDGE_S, so that a slow
    one can be compared. In SI."""
    out = track.measured.copy()
    steps = np.arange(len(track))
    for column in out.T:
        there = np.flatnonzero(np.isfinite(column))
        if there.size > 1:
            after = np.searchsorted(there, steps).clip(1, there.size - 1)
            short = (there[after] - there[after - 1]) * track.h <= BRIDGE_S
            inside = (steps >= there[0]) & (steps <= there[-1]) & short
            column[inside] = np.interp(steps[inside], there, column[there])
    return out

"""The missing force over time and against what may cause it, with two tests of what is left."""

from math import erfc, sqrt
from typing import Any

import numpy as np
from scipy.special import chdtrc

from twin.physics.model import Model
from twin.report.series import packed
from twin.study.prediction.unexplained import Missing, missing_force
from twin.study.reference.sailed import fed
from twin.study.track.track import Track

AXES = ("X_N", "Y_N", "N_Nm")
LAGS = 10  # of the test for independence
LEAST_MEANS = 20  # independent means of half a ship length without which no test is made
MOST_POINTS = 3000  # drawn


def force_view(track: Track, model: Model) -> dict[str, Any]:
    """What Compare draws of one voyage: X, Y, N over time, causes beside them, and the tests."""
    m = missing_force(track, fed(model, track)[0])
    causes = {name: _means(x, m.width) for name, x in causes_of(track).items()}
    own = slice(None, None, m.width)  # means that share no sample
    known = m.whole[own]
    every = max(1, m.t.size // MOST_POINTS)
    thin = slice(None, None, every)
    force = np.where(m.whole[:, None], m.force, np.nan)
    return {
        "name": track.name,
        "t": packed(m.t[thin]),
        "force": {axis: packed(force[thin, i]) for i, axis in enumerate(AXES)},
        "noise": {axis: float(np.std(m.noise[:, i])) for i, axis in enumerate(AXES)},
        "mean": {
            axis: _finite(np.nanmean(force[:, i]) if m.whole.any() else np.nan) for i, axis in enumerate(AXES)
        },
        "causes": {name: packed(x[thin]) for name, x in causes.items()},
        "tests": [_test(m, i, axis, causes, own, known) for i, axis in enumerate(AXES)],
    }


def causes_of(track: Track) -> dict[str, np.ndarray]:
    """What a force may grow with, (N,), in the units of the bridge: its name says which."""
    u, v = track.state[:, 3], track.state[:, 4]
    out = {
        "speed squared [kn2]": np.square(np.hypot(u, v) / KNOT),
        "rudder [deg]": np.degrees(track.delta),
        "rate of turn [deg/s]": np.degrees(track.state[:, 5]),
        "drift angle [deg]": np.degrees(np.arctan2(-v, u)),
    }
    weather = track.weather
    if "wind_speed" in weather and "wind_to" in weather:
        blows = weather["wind_to"] - track.state[:, 2]
        out["wind from ahead [m/s]"] = -weather["wind_speed"] * np.cos(blows)
        out["wind from port [m/s]"] = weather["wind_speed"] * np.sin(blows)
    if "depth" in weather:
        out["water depth [m]"] = weather["depth"]
    if "H_s" in weather:
        out["wave height [m]"] = weather["H_s"]
    return {name: x for name, x in out.items() if np.isfinite(x).any()}


KNOT = 1852.0 / 3600.0


def _means(x: np.ndarray, width: int) -> np.ndarray:
    steps = np.concatenate([[0.0], np.cumsum(0.5 * (x[1:] + x[:-1]))])
    return (steps[width:] - steps[:-width]) / width


def _test(
    m: Missing, i: int, axis: str, causes: dict[str, np.ndarray], own: slice, known: np.ndarray
) -> dict[str, Any]:
    """Whether the means of one axis are independent of each other (Ljung-Box), and of each cause."""
    y = m.force[own, i][known]
    out: dict[str, Any] = {
        "axis": axis,
        "samples": int(y.size),
        "lags": LAGS,
        "independent_p": None,
        "causes": [],
    }
    if y.size < max(LEAST_MEANS, 2 * LAGS):
        return out
    r = autocorrelation(y)
    q = (
        y.size
        * (y.size + 2.0)
        * float(np.sum(np.square(r[1 : LAGS + 1]) / (y.size - np.arange(1, LAGS + 1))))
    )
    out["independent_p"] = _finite(float(chdtrc(LAGS, q)))
    for name, cause in causes.items():
        x = cause[own][known]
        if np.isfinite(x).all() and float(np.std(x)) > 0.0:
            out["causes"].append({"cause": name} | correlated(x, y))
    return out


def autocorrelation(y: np.ndarray) -> np.ndarray:
    """(LAGS + 1,) of the deviations from their mean."""
    d = y - y.mean()
    total = float(d @ d) or 1e-300
    return np.array([float(d[k:] @ d[: d.size - k]) / total for k in range(LAGS + 1)])


def correlated(x: np.ndarray, y: np.ndarray) -> dict[str, Any]:
    """Correlation and its p-value, with as many independent samples as both series' own persistence leaves
    (Bartlett: n / (1 + 2 sum r_x r_y))."""
    if float(np.std(x)) <= 0.0 or float(np.std(y)) <= 0.0:
        return {"correlation": None, "p": None}
    r = float(np.corrcoef(x, y)[0, 1])
    spread = 1.0 + 2.0 * float(np.sum((autocorrelation(x) * autocorrelation(y))[1:]))
    n = min(max(x.size / max(spread, 1e-9), 3.0), float(x.size))
    z = np.arctanh(min(max(r, -0.999999), 0.999999)) * sqrt(max(n - 3.0, 0.0))
    return {"correlation": r, "p": erfc(abs(float(z)) / sqrt(2.0)), "independent_samples": n}


def _finite(x: Any) -> float | None:
    return float(x) if np.isfinite(x) else None

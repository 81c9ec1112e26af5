"""The smooth motion under the measurements: the path of least jerk, in units of the ship's own time L/U_0."""

import numpy as np
from scipy.linalg import solveh_banded

from twin.physics.ship import Ship
from twin.recording.holes import lined, longest, pieces, slopes
from twin.study.track.motion_channels import READINGS

JERK = 0.15  # rad in (L/U_0)^3: how suddenly a ship turns; what is faster is the sea's doing


def smooth_motion(measured: np.ndarray, h: float, ship: Ship) -> tuple[np.ndarray, np.ndarray]:
    """The path of least jerk through the readings (N, 8), and the scatter of the readings about it (8,)."""
    x, y, psi, u, v, r, u_r, v_r = measured.T
    time, speed = float(ship.scale("time")), float(ship.scale("speed"))
    turn = (JERK / time**3) ** 2 * time * h**5  # what third differences of heading do by themselves: (rad)^2
    sd = {name: _scatter(column) for name, column in zip(READINGS, measured.T, strict=True)}
    floor = {"x": 1e-4 * ship.L_pp, "y": 1e-4 * ship.L_pp, "psi": 2e-4, "r": 1e-3 / time}
    floor |= dict.fromkeys(("u", "v", "u_r", "v_r"), 1e-3 * speed)
    sd = {name: max(value if np.isfinite(value) else 0.0, floor[name]) for name, value in sd.items()}
    psi_s, r_s = _least_jerk(psi, sd["psi"], r, sd["r"], turn, h, time)
    c, s = np.cos(psi_s), np.sin(psi_s)
    sd_uv = np.hypot(sd["u"], sd["v"]) / np.sqrt(2.0)
    x_s, north = _least_jerk(x, sd["x"], u * c - v * s, sd_uv, turn * ship.L_pp**2, h, time)
    y_s, east = _least_jerk(y, sd["y"], u * s + v * c, sd_uv, turn * ship.L_pp**2, h, time)
    u_s, v_s = north * c + east * s, east * c - north * s
    state = np.column_stack([x_s, y_s, psi_s, u_s, v_s, r_s])
    log = [(u_r - u_s) - running_mean(u_r - u_s, 41), (v_r - v_s) - running_mean(v_r - v_s, 41)]
    residuals = [*(measured[:, :6] - state).T, *log]
    found = [
        max(1.4826 * np.nanmedian(np.abs(e)) if np.isfinite(e).any() else np.nan, floor[name])
        for name, e in zip(READINGS, residuals, strict=True)
    ]
    return state, np.array(found)


def running_mean(values: np.ndarray, width: int) -> np.ndarray:
    """Mean over the `width` about each point, of those that are there; fewer at the ends. (N,), in its own
    unit."""
    ok = np.isfinite(values)
    kernel = np.ones(min(width, values.size))
    weight = np.convolve(ok, kernel, "same")
    return np.convolve(np.where(ok, values, 0.0), kernel, "same") / np.maximum(weight, 1.0)


def _scatter(values: np.ndarray) -> float:
    """White scatter of a series, from its third differences: what is smooth drops out."""
    d = np.diff(values[np.isfinite(values)], 3)
    return 1.4826 * float(np.median(np.abs(d))) / np.sqrt(20.0) if d.size else np.nan


def _least_jerk(
    y: np.ndarray, sd: float, rate: np.ndarray, sd_rate: float, jerk: float, h: float, time: float
) -> tuple[np.ndarray, np.ndarray]:
    """The path through each piece of the readings between long holes, with lines over these, and its
    slope."""
    there = np.isfinite(y) | np.isfinite(rate)
    found = pieces(there, longest(there, h, time))
    z = np.zeros(y.size)
    for a, b in found:
        z[a:b] = _least_jerk_of_piece(y[a:b], sd, rate[a:b], sd_rate, jerk, h)
    return lined(z, found), slopes(z, found, h)


def _least_jerk_of_piece(
    y: np.ndarray, sd: float, rate: np.ndarray, sd_rate: float, jerk: float, h: float
) -> np.ndarray:
    """argmin sum (z - y)^2/sd^2 + sum (z' - rate)^2/sd_rate^2 + sum (third difference of z)^2/jerk, a banded
    system.

    Samples far outside (6 sigma of the first pass) do not count in the second.
    """
    w, w_rate = np.isfinite(y) / sd**2, np.isfinite(rate) / sd_rate**2
    for _ in range(2):
        z = _solve(w, np.nan_to_num(y), w_rate, np.nan_to_num(rate), jerk, h)
        off = np.abs(y - z)
        limit = 6.0 * max(sd, 1.4826 * float(np.nanmedian(off)) if np.isfinite(off).any() else sd)
        w = w * ~(off > limit)
        off = np.abs(rate - np.gradient(z, h))
        limit = 6.0 * max(sd_rate, 1.4826 * float(np.nanmedian(off)) if np.isfinite(off).any() else sd_rate)
        w_rate = w_rate * ~(off > limit)
    return z


def _solve(
    w: np.ndarray, y: np.ndarray, w_rate: np.ndarray, rate: np.ndarray, jerk: float, h: float
) -> np.ndarray:
    size = y.size
    band = np.zeros((4, size))  # lower diagonals of the normal matrix
    band[0] += w + 1e-12
    right = w * y
    inner = w_rate[1:-1] / (4.0 * h * h)  # central differences
    band[0, 2:] += inner
    band[0, :-2] += inner
    band[2, :-2] -= inner
    right[2:] += inner * 2.0 * h * rate[1:-1]
    right[:-2] -= inner * 2.0 * h * rate[1:-1]
    d = np.array([-1.0, 3.0, -3.0, 1.0])
    for i in range(4):
        for j in range(i + 1):
            band[i - j, j : size - 3 + j] += d[i] * d[j] / jerk
    return solveh_banded(band, right, lower=True)

"""Faults of known size in the instruments of a voyage of the reference sea: what each reading would have
been, its noise kept."""

from collections.abc import Mapping
from typing import Any

import numpy as np

# fault -> number -> size; antennas in lengths, log bias in service speeds
SIZES: dict[str, dict[str, float]] = {
    "nothing": {},
    "gnss_delay": {"gnss_delay": 1.0},
    "smoothing": {"smoothing": 3.0},
    "heading_delay": {"heading_delay": 1.5},
    "heading_bias": {"A": 0.05},
    "deviation": {"B": 0.06, "C": -0.04, "D": 0.02},
    "gyro_bias": {"gyro_bias": 3e-4},
    "gyro_scale": {"gyro_scale": -0.05},
    "log_scale": {"log_scale": 0.08},
    "log_bias": {"log_bias": 0.05},
    "log_angle": {"log_angle": 0.04},
    "antenna": {"antenna_ahead": 0.2, "antenna_starboard": -0.05},
    "vane": {"vane": 0.08},
    "log_delay": {"log_delay": 2.0},
    "current": {"current_north": 0.04, "current_east": -0.03},
}
PAIRS = (
    ("heading_delay", "heading_bias"),
    ("log_scale", "current"),
    ("gnss_delay", "antenna"),
    ("deviation", "log_scale"),
)
OF = {
    "antenna_ahead": "L",
    "antenna_starboard": "L",
    "log_bias": "U0",
    "current_north": "U0",
    "current_east": "U0",
}
LATE = {"gnss": 0.1, "log": 0.2}  # of the healthy instruments of the sea
U, V, PSI = "surge_velocity_mps", "sway_velocity_mps", "heading_true_north_deg"
UW, VW = "surge_velocity_through_water_mps", "sway_velocity_through_water_mps"


def planted(
    columns: Mapping[str, np.ndarray],
    truth: Mapping[str, np.ndarray],
    hull: Any,
    faults: tuple[str, ...],
    turned: bool,
) -> Any:
    """(columns with these faults, number -> true size). `turned`: course and speed over ground by the earth
    come to the ship by this compass, as on a bridge."""
    size = {k: v * (getattr(hull, OF[k]) if k in OF else 1.0) for f in faults for k, v in SIZES[f].items()}
    out = {k: np.array(v) for k, v in columns.items()}
    t, get = out["time_s"], lambda name: size.get(name, 0.0)
    _satellites(out, truth, t, get)
    _compass(out, truth, t, get)
    _log(out, truth, t, get)
    out["apparent_wind_angle_deg"] = out["apparent_wind_angle_deg"] + np.degrees(get("vane"))
    if turned:
        _by_compass(out, np.interp(t - LATE["gnss"], t, truth["psi"]))
    return out, size | {
        "gnss_delay": get("gnss_delay") + LATE["gnss"],
        "log_delay": get("log_delay") + LATE["log"],
    }


def _at(truth: Mapping[str, np.ndarray], name: str, t: np.ndarray, late: float) -> np.ndarray:
    return np.interp(t - late, t, truth[name])


def _satellites(out: dict, truth: Any, t: np.ndarray, get: Any) -> None:
    late, ahead, aside = get("gnss_delay"), get("antenna_ahead"), get("antenna_starboard")
    north, east = get("current_north"), get("current_east")

    def shown(seconds: float) -> list[np.ndarray]:
        x, y, psi, u, v, r = (_at(truth, k, t, seconds) for k in ("north", "east", "psi", "u", "v", "r"))
        c, s = np.cos(psi), np.sin(psi)
        return [
            x + ahead * c - aside * s + north * t,
            y + ahead * s + aside * c + east * t,
            u - r * aside + north * c + east * s,
            v + r * ahead + east * c - north * s,
            psi,
        ]

    now, then = shown(LATE["gnss"] + late), shown(LATE["gnss"])
    ahead = aside = north = east = 0.0
    plain = shown(LATE["gnss"])
    T, (u, v, psi) = get("smoothing"), now[2:]
    if T:
        c, s = np.cos(psi), np.sin(psi)
        n, e = (_smoothed(w, T, t[1] - t[0]) for w in (u * c - v * s, u * s + v * c))
        u, v = n * c + e * s, e * c - n * s
    for name, new, old in zip(("north_m", "east_m", U, V), (*now[:2], u, v), plain, strict=False):
        out[name] = out[name] + new - old
    del then


def _smoothed(x: np.ndarray, T: float, h: float) -> np.ndarray:
    """dy/dt = (x - y)/T, exact for straight lines between samples."""
    y, keep = np.empty_like(x), np.exp(-h / T)
    y[0] = x[0]
    for k in range(1, x.size):
        slope = (x[k] - x[k - 1]) / h
        y[k] = x[k] - slope * T + (y[k - 1] - x[k - 1] + slope * T) * keep
    return y


def _compass(out: dict, truth: Any, t: np.ndarray, get: Any) -> None:
    psi = _at(truth, "psi", t, get("heading_delay"))
    e = get("A") + get("B") * np.sin(psi) + get("C") * np.cos(psi) + get("D") * np.sin(2 * psi)
    out[PSI] = np.mod(out[PSI] + np.degrees(psi + e - truth["psi"]), 360.0)
    more = get("gyro_bias") + get("gyro_scale") * truth["r"]
    out["yaw_rate_degps"] = out["yaw_rate_degps"] + np.degrees(more)


def _log(out: dict, truth: Any, t: np.ndarray, get: Any) -> None:
    old = [_at(truth, k, t, LATE["log"]) for k in ("u_r", "v_r")]
    u, v = (_at(truth, k, t, LATE["log"] + get("log_delay")) for k in ("u_r", "v_r"))
    k, c, s = 1.0 + get("log_scale"), np.cos(get("log_angle")), np.sin(get("log_angle"))
    out[UW] = out[UW] + k * (c * u + s * v) + get("log_bias") - old[0]
    out[VW] = out[VW] + k * (c * v - s * u) - old[1]


def _by_compass(out: dict, psi: np.ndarray) -> None:
    """The velocity by the earth, as the receiver has it, turned into the ship's axes by the shown heading."""
    turn = np.radians(out[PSI]) - psi
    c, s, u, v = np.cos(turn), np.sin(turn), out[U], out[V]
    out[U], out[V] = u * c + v * s, v * c - u * s

"""Recordings of the reference sea as a bridge or a boat would have written them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from twin.live.signals.geodesy import datum, from_chart
from twin.recording.map_file import parse_map
from twin.recording.raw import through
from twin.recording.table import Table
from twin.recording.timebase import TimeAxis
from twin.recording.voyage import Voyage

KNOT = 1852.0 / 3600.0
HEADING, RATE, RUDDER, TURNS = (
    "heading_true_north_deg",
    "yaw_rate_degps",
    "rudder_angle_deg",
    "propeller_rate_rpm",
)
AHEAD, ASIDE = "surge_velocity_mps", "sway_velocity_mps"
Export = dict[str, np.ndarray]
CONTROLS = {RUDDER: "rud", TURNS: "rpm", HEADING: "hdg"}
PLACE = {"north_m": "n", "east_m": "e"}
GEODETIC = {"latitude_deg": "lat", "longitude_deg": "lon"}
DATUM = datum(59.4, 10.6)  # where such a recording begins [deg]
COURSE = {
    AHEAD: {"column": "sog", "unit": "kn", "frame": "course"},
    ASIDE: {"column": "cog", "frame": "course"},
}
TURNING: dict[str, Any] = {RATE: {"column": "rot", "unit": "deg/min"}}
BRIDGE: dict[str, Any] = {**CONTROLS, **PLACE, **COURSE, **TURNING}
SATELLITE: dict[str, Any] = {**CONTROLS, **GEODETIC, **COURSE, **TURNING}
WINDS = {
    "apparent_wind_speed_mps": "aws",
    "apparent_wind_angle_deg": "awa",
    "true_wind_speed_mps": "tws",
    "true_wind_direction_deg": "twd",
}
BODY: dict[str, Any] = {
    **CONTROLS,
    **PLACE,
    AHEAD: "u",
    ASIDE: "v",
    RATE: "r",
    "surge_velocity_through_water_mps": "stw",
    **WINDS,
}
FORMS: dict[str, tuple[dict[str, Any], float]] = {
    "bridge, once a second": (BRIDGE, 1.0),
    "bridge, latitude and longitude": (SATELLITE, 1.0),
    "inertial unit, twice a second": (BODY, 2.0),
    "velocities by the earth, no rate of turn": (
        {
            **CONTROLS,
            **PLACE,
            AHEAD: {"column": "vn", "frame": "earth"},
            ASIDE: {"column": "ve", "frame": "earth"},
        },
        1.0,
    ),
    "position only": (
        {**CONTROLS, **PLACE, RATE: "r", "true_wind_speed_mps": "tws", "true_wind_direction_deg": "twd"},
        1.0,
    ),
    "course and speed, no position": (
        {**CONTROLS, **COURSE, RATE: {"column": "rot", "unit": "deg/min"}},
        1.0,
    ),
    "ROS frames, with the map that says so": (
        {
            **CONTROLS,
            **PLACE,
            AHEAD: "u",
            ASIDE: {"column": "port", "sign": -1},
            HEADING: {"column": "enu", "sign": -1, "offset": 90.0},
            RATE: {"column": "left", "sign": -1},
        },
        2.0,
    ),
    "radians, knots and seconds": (
        {
            **CONTROLS,
            **PLACE,
            AHEAD: {"column": "ukn", "unit": "kn"},
            ASIDE: {"column": "vkn", "unit": "kn"},
            HEADING: {"column": "hrad", "unit": "rad"},
            RATE: {"column": "rrad", "unit": "rad/s"},
            RUDDER: {"column": "drad", "unit": "rad"},
            TURNS: {"column": "rps", "unit": "1/s"},
        },
        2.0,
    ),
}


def held(t: np.ndarray, x: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The last sample at each of these times."""
    there = np.isfinite(x)
    if not there.any():
        return np.full(at.size, np.nan)
    return x[there][np.clip(np.searchsorted(t[there], at, side="right") - 1, 0, None)]


def export(
    columns: Mapping[str, np.ndarray], true_heading: np.ndarray, hz: float, north_up: bool = False
) -> Export:
    """A recording as the columns of an export; `north_up` turns everything so that the usual heading is
    north."""
    t = columns["time_s"]
    at = np.arange(t[0], t[-1], 1.0 / hz)
    c = {name: held(t, x, at) for name, x in columns.items()}
    psi = np.interp(at, t, np.unwrap(true_heading))
    by = float(np.angle(np.mean(np.exp(1j * psi)))) if north_up else 0.0
    place = (c["north_m"] + 1j * c["east_m"]) * np.exp(-1j * by)
    w = (c[AHEAD] + 1j * c[ASIDE]) * np.exp(1j * (psi - by))
    heading = np.round(np.mod(c[HEADING] - np.degrees(by), 360.0), 2)
    r = c[RATE]
    lat, lon = np.transpose([from_chart(DATUM, p.real, p.imag) for p in place - place[0]])
    return {
        "t": at,
        "n": place.real,
        "e": place.imag,
        "lat": lat,
        "lon": lon,
        "hdg": heading,
        "sog": np.round(np.abs(w) / KNOT, 2),
        "cog": np.round(np.mod(np.degrees(np.angle(w)), 360.0), 2),
        "rot": r * 60.0,
        "r": r,
        "rud": c[RUDDER],
        "rpm": c[TURNS],
        "u": c[AHEAD],
        "v": c[ASIDE],
        "vn": w.real,
        "ve": w.imag,
        "stw": c["surge_velocity_through_water_mps"],
        "aws": c["apparent_wind_speed_mps"],
        "awa": c["apparent_wind_angle_deg"],
        "tws": c["true_wind_speed_mps"],
        "twd": np.mod(c["true_wind_direction_deg"] - np.degrees(by), 360.0),
        "port": -c[ASIDE],
        "left": -r,
        "enu": np.mod(90.0 - heading + 180.0, 360.0) - 180.0,
        "ukn": c[AHEAD] / KNOT,
        "vkn": c[ASIDE] / KNOT,
        "hrad": np.radians(heading),
        "rrad": np.radians(r),
        "drad": np.radians(c[RUDDER]),
        "rps": c[TURNS] / 60.0,
    }


def voyage_of(table: Export, columns: Mapping[str, Any]) -> Voyage:
    """The export through a map, as `twin import` reads it."""
    by = parse_map({"columns": dict(columns)}, "bench")
    names = {c if isinstance(c, str) else c["column"] for c in columns.values()}
    rows = Table(
        Path("export.csv"),
        np.arange(2, table["t"].size + 2),
        {n: np.array(table[n], float) for n in names},
        {},
    )
    return Voyage.of(through(rows.path, rows, TimeAxis(np.array(table["t"], float)), by, [], {}))

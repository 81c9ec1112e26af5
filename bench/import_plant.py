"""Recordings of the reference sea as a bridge or a boat would have written them, and mistakes put into them.

A mistake is planted in the table as it is exported; its remedy is what a person would then write in the map.
After the remedy the voyage must be the healthy one again.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from twin.recording.map_file import parse_map
from twin.recording.read import finished, through
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
COURSE = {
    AHEAD: {"column": "sog", "unit": "kn", "frame": "course"},
    ASIDE: {"column": "cog", "frame": "course"},
}
BRIDGE: dict[str, Any] = {**CONTROLS, **PLACE, **COURSE, RATE: {"column": "rot", "unit": "deg/min"}}
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
    return {
        "t": at,
        "n": place.real,
        "e": place.imag,
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
    return finished(through(rows.path, rows, TimeAxis(np.array(table["t"], float)), by, [], {}))


@dataclass(frozen=True)
class Planted:
    """A mistake: `plant(export)` makes it, `words` name it, `remedy` is put into the map (None: the file must
    be exported again)."""

    name: str
    plant: Callable[[Export], Export]
    words: tuple[str, ...]
    remedy: dict[str, Any] | None = None
    form: dict[str, Any] = field(default_factory=lambda: BRIDGE)
    hz: float = 1.0
    north_up: bool = False
    shows: Callable[[Export], bool] = lambda table: True  # whether it can be seen in a voyage at all


def blows(table: Export) -> bool:
    """Where it comes from shows in a wind only."""
    return float(np.nanmedian(table["tws"])) > 2.0


def entry(column: str, **how: Any) -> dict[str, Any]:
    return {"column": column, **how}


def changed(**how: Callable[[Export], np.ndarray]) -> Callable[[Export], Export]:
    return lambda d: d | {name: f(d) for name, f in how.items()}


def compass_curve(d: Export) -> np.ndarray:
    x = np.radians(d["hdg"])
    return np.mod(d["hdg"] + 2.0 + 8.0 * np.sin(x) - 3.0 * np.cos(x), 360.0)


def averaged(d: Export) -> np.ndarray:
    """Means of five raw numbers, held: near north 359 and 1 make 180."""
    k = np.arange(d["hdg"].size) // 5
    return (np.bincount(k, d["hdg"]) / np.bincount(k))[k]


def late(x: np.ndarray, rows: int) -> np.ndarray:
    return np.r_[np.full(rows, x[0]), x[:-rows]]


def in_turn(d: Export) -> np.ndarray:
    return np.where(np.isin(np.arange(d["hdg"].size) % 7, (1, 2, 5)), d["hdg"] - 12.0, d["hdg"])


def later(d: Export, seconds: float) -> np.ndarray:
    half = d["t"].size // 2
    return np.r_[d["t"][:half], d["t"][half:] + seconds]


MISTAKES: tuple[Planted, ...] = (
    Planted(
        "heading 180 deg off",
        changed(hdg=lambda d: d["hdg"] + 180.0),
        ("180 deg off",),
        {HEADING: entry("hdg", offset=180.0)},
    ),
    Planted(
        "heading from east, anticlockwise, rate to port (ROS)",
        changed(hdg=lambda d: 90.0 - d["hdg"], rot=lambda d: -d["rot"]),
        ("from east, anticlockwise", "rate of turn is positive to port"),
        {HEADING: entry("hdg", sign=-1, offset=90.0), RATE: entry("rot", unit="deg/min", sign=-1)},
    ),
    Planted(
        "heading from east, anticlockwise",
        changed(hdg=lambda d: 90.0 - d["hdg"]),
        ("from east, anticlockwise",),
        {HEADING: entry("hdg", sign=-1, offset=90.0)},
    ),
    Planted(
        "heading in radians",
        changed(hdg=lambda d: np.radians(d["hdg"])),
        ("radians",),
        {HEADING: entry("hdg", unit="rad")},
    ),
    Planted(
        "heading 90 deg too large",
        changed(hdg=lambda d: d["hdg"] + 90.0),
        ("90 deg too large",),
        {HEADING: entry("hdg", offset=-90.0)},
    ),
    Planted("two headings in turn, 12 deg apart", changed(hdg=in_turn), ("two headings in turn, 12",)),
    Planted("heading averaged across north", changed(hdg=averaged), ("across north",), north_up=True),
    Planted("course used as heading", changed(hdg=lambda d: d["cog"]), ("the heading is the course",)),
    Planted(
        "heading 3 s late",
        changed(hdg=lambda d: late(d["hdg"], 3)),
        ("s late",),
        {HEADING: entry("hdg", late_s=3.0)},
    ),
    Planted(
        "magnetic heading, 14 deg",
        changed(hdg=lambda d: d["hdg"] - 14.0),
        ("off the course over ground",),
        {HEADING: entry("hdg", offset=14.0)},
    ),
    Planted(
        "compass with a deviation",
        changed(hdg=compass_curve),
        ("deviation",),
        {HEADING: entry("hdg", deviation=[2.0, 8.0, -3.0])},
    ),
    Planted(
        "heading that jumps by 25 deg",
        changed(hdg=lambda d: d["hdg"] + np.where(d["t"] > d["t"].mean(), 25.0, 0.0)),
        ("jumps by",),
    ),
    Planted(
        "speed in m/s, read as knots",
        changed(sog=lambda d: d["sog"] * KNOT),
        ("in m/s, read as knots",),
        {AHEAD: entry("sog", unit="m/s", frame="course"), ASIDE: entry("cog", frame="course")},
    ),
    Planted(
        "west without its sign",
        changed(e=lambda d: -d["e"]),
        ("east is positive to the west",),
        {"east_m": entry("e", sign=-1)},
    ),
    Planted(
        "north and east swapped",
        changed(n=lambda d: d["e"], e=lambda d: d["n"]),
        ("north and east are swapped",),
        {"north_m": "e", "east_m": "n"},
    ),
    Planted(
        "earth-fixed velocities called surge and sway",
        changed(u=lambda d: d["vn"], v=lambda d: d["ve"]),
        ("earth-fixed",),
        {AHEAD: entry("u", frame="earth"), ASIDE: entry("v", frame="earth")},
        BODY,
        2.0,
    ),
    Planted(
        "rate in deg/s, read as deg/min",
        changed(rot=lambda d: d["rot"] / 60.0),
        ("in deg/s",),
        {RATE: entry("rot", unit="deg/s")},
    ),
    Planted(
        "rudder positive to port",
        changed(rud=lambda d: -d["rud"]),
        ("positive to port",),
        {RUDDER: entry("rud", sign=-1)},
    ),
    Planted("clock set by an hour", changed(t=lambda d: later(d, 3600.0)), ("an hour",)),
    Planted(
        "log in knots",
        changed(stw=lambda d: d["stw"] / KNOT),
        ("in kn",),
        {"surge_velocity_through_water_mps": entry("stw", unit="kn")},
        BODY,
        2.0,
    ),
    Planted(
        "wind that blows to, for where it comes from",
        changed(twd=lambda d: d["twd"] + 180.0),
        ("blows to",),
        {"true_wind_direction_deg": entry("twd", direction="to")},
        BODY,
        2.0,
        shows=blows,
    ),
    Planted(
        "shaft in 1/s", changed(rpm=lambda d: d["rpm"] / 60.0), ("1/s",), {TURNS: entry("rpm", unit="1/s")}
    ),
)

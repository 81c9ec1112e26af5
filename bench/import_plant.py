"""Recordings of the reference sea as a bridge or a boat would have written them, and mistakes put into them.

A mistake is planted in the table as it is exported; its remedy is what a person would then write in the map.
After the remedy the voyage must be the healthy one again.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bench.import_forms import (
    AHEAD,
    ASIDE,
    BODY,
    BRIDGE,
    HEADING,
    KNOT,
    RATE,
    RUDDER,
    SATELLITE,
    TURNS,
    Export,
)


@dataclass(frozen=True)
class PlantedMistake:
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


MISTAKES: tuple[PlantedMistake, ...] = (
    PlantedMistake(
        "heading 180 deg off",
        changed(hdg=lambda d: d["hdg"] + 180.0),
        ("180 deg off",),
        {HEADING: entry("hdg", offset=180.0)},
    ),
    PlantedMistake(
        "heading from east, anticlockwise, rate to port (ROS)",
        changed(hdg=lambda d: 90.0 - d["hdg"], rot=lambda d: -d["rot"]),
        ("from east, anticlockwise", "rate of turn is positive to port"),
        {HEADING: entry("hdg", sign=-1, offset=90.0), RATE: entry("rot", unit="deg/min", sign=-1)},
    ),
    PlantedMistake(
        "heading from east, anticlockwise",
        changed(hdg=lambda d: 90.0 - d["hdg"]),
        ("from east, anticlockwise",),
        {HEADING: entry("hdg", sign=-1, offset=90.0)},
    ),
    PlantedMistake(
        "heading in radians",
        changed(hdg=lambda d: np.radians(d["hdg"])),
        ("radians",),
        {HEADING: entry("hdg", unit="rad")},
    ),
    PlantedMistake(
        "heading 90 deg too large",
        changed(hdg=lambda d: d["hdg"] + 90.0),
        ("90 deg too large",),
        {HEADING: entry("hdg", offset=-90.0)},
    ),
    PlantedMistake("two headings in turn, 12 deg apart", changed(hdg=in_turn), ("two headings in turn, 12",)),
    PlantedMistake("heading averaged across north", changed(hdg=averaged), ("across north",), north_up=True),
    PlantedMistake("course used as heading", changed(hdg=lambda d: d["cog"]), ("the heading is the course",)),
    PlantedMistake(
        "heading 3 s late",
        changed(hdg=lambda d: late(d["hdg"], 3)),
        ("s late",),
        {HEADING: entry("hdg", late_s=3.0)},
    ),
    PlantedMistake(
        "magnetic heading, 14 deg",
        changed(hdg=lambda d: d["hdg"] - 14.0),
        ("off the course over ground",),
        {HEADING: entry("hdg", offset=14.0)},
    ),
    PlantedMistake(
        "compass with a deviation",
        changed(hdg=compass_curve),
        ("deviation",),
        {HEADING: entry("hdg", deviation=[2.0, 8.0, -3.0])},
    ),
    PlantedMistake(
        "heading that jumps by 25 deg",
        changed(hdg=lambda d: d["hdg"] + np.where(d["t"] > d["t"].mean(), 25.0, 0.0)),
        ("jumps by",),
    ),
    PlantedMistake(
        "speed in m/s, read as knots",
        changed(sog=lambda d: d["sog"] * KNOT),
        ("in m/s, read as knots",),
        {AHEAD: entry("sog", unit="m/s", frame="course"), ASIDE: entry("cog", frame="course")},
    ),
    PlantedMistake(
        "west without its sign",
        changed(e=lambda d: -d["e"]),
        ("east is positive to the west",),
        {"east_m": entry("e", sign=-1)},
    ),
    PlantedMistake(
        "north and east swapped",
        changed(n=lambda d: d["e"], e=lambda d: d["n"]),
        ("north and east are swapped",),
        {"north_m": "e", "east_m": "n"},
    ),
    PlantedMistake(
        "latitude and longitude exchanged",
        changed(lat=lambda d: d["lon"], lon=lambda d: d["lat"]),
        ("latitude and longitude are exchanged",),
        {"latitude_deg": "lon", "longitude_deg": "lat"},
        SATELLITE,
    ),
    PlantedMistake(
        "earth-fixed velocities called surge and sway",
        changed(u=lambda d: d["vn"], v=lambda d: d["ve"]),
        ("earth-fixed",),
        {AHEAD: entry("u", frame="earth"), ASIDE: entry("v", frame="earth")},
        BODY,
        2.0,
    ),
    PlantedMistake(
        "rate in deg/s, read as deg/min",
        changed(rot=lambda d: d["rot"] / 60.0),
        ("in deg/s",),
        {RATE: entry("rot", unit="deg/s")},
    ),
    PlantedMistake(
        "rudder positive to port",
        changed(rud=lambda d: -d["rud"]),
        ("positive to port",),
        {RUDDER: entry("rud", sign=-1)},
    ),
    PlantedMistake("clock set by an hour", changed(t=lambda d: later(d, 3600.0)), ("an hour",)),
    PlantedMistake(
        "log in knots",
        changed(stw=lambda d: d["stw"] / KNOT),
        ("in kn",),
        {"surge_velocity_through_water_mps": entry("stw", unit="kn")},
        BODY,
        2.0,
    ),
    PlantedMistake(
        "wind that blows to, for where it comes from",
        changed(twd=lambda d: d["twd"] + 180.0),
        ("blows to",),
        {"true_wind_direction_deg": entry("twd", direction="to")},
        BODY,
        2.0,
        shows=blows,
    ),
    PlantedMistake(
        "shaft in 1/s", changed(rpm=lambda d: d["rpm"] / 60.0), ("1/s",), {TURNS: entry("rpm", unit="1/s")}
    ),
)

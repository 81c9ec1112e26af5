"""canboat's JSON of NMEA 2000: one decoded message a line, fields by name; angles in degrees or in
radians."""

import json
from collections.abc import Iterator
from math import inf, pi
from pathlib import Path
from typing import Any

from twin.physics.maths import RAD
from twin.recording.formats.lines import numbered
from twin.recording.formats.recorder_stamps import Stamp
from twin.recording.formats.signals import Signals

SAYS = "an NMEA 2000 log as canboat's JSON"
FULL_TURN_RAD = 2.0 * pi + 0.01  # directions never above this are in radians
# {group: {field: (quantity, whether it is an angle, factor to the quantity's unit if not)}}
FIELDS: dict[int, dict[str, tuple[str, bool, float]]] = {
    127245: {"Position": ("rudder_angle_deg", True, 1.0)},
    127250: {"Heading": ("heading", True, 1.0), "Variation": ("magnetic_variation_deg", True, 1.0)},
    127251: {"Rate": ("yaw_rate_degps", True, 1.0)},
    127257: {"Roll": ("roll_deg", True, 1.0)},
    127258: {"Variation": ("magnetic_variation_deg", True, 1.0)},
    127488: {"Speed": ("engine_rate_rpm", False, 1.0), "Engine Speed": ("engine_rate_rpm", False, 1.0)},
    128259: {"Speed Water Referenced": ("surge_velocity_through_water_mps", False, 1.0)},
    128267: {"Depth": ("water_depth_m", False, 1.0)},
    129025: {"Latitude": ("latitude_deg", False, 1.0), "Longitude": ("longitude_deg", False, 1.0)},
    129029: {"Latitude": ("latitude_deg", False, 1.0), "Longitude": ("longitude_deg", False, 1.0)},
    129026: {"COG": ("course_over_ground_deg", True, 1.0), "SOG": ("speed_over_ground_mps", False, 1.0)},
    130306: {"Wind Speed": ("wind_speed", False, 1.0), "Wind Angle": ("wind_angle", True, 1.0)},
}
KEYS = {name.replace(" ", "").lower(): name for group in FIELDS.values() for name in group}
WIND = {"apparent": "apparent_wind", "true (ground referenced to north)": "true_wind"}
OF_WIND = {
    "apparent_wind": ("apparent_wind_speed_mps", "apparent_wind_angle_deg"),
    "true_wind": ("true_wind_speed_mps", "true_wind_direction_deg"),
}
FIRST = (None, 0, 252, 253, 254, 255, "Single Engine or Dual Engine Port")  # or the only one
BESIDE = {"heading_magnetic_deg": ("deviation", -inf), "water_depth_m": ("offset", 0.0)}  # (field, at least)


def looks(lines: list[str], start: bytes) -> bool:
    """Whether a line of the head is an object with a parameter group and its fields."""
    return any(s.startswith("{") and '"pgn"' in s and '"fields"' in s for s in lines[:10])


def read(path: Path) -> Signals:
    """All messages of a file, angles in degrees whether it says so or not; what cannot be read is counted."""
    out, stamp, units = Signals(path, SAYS), Stamp(), ""
    largest: dict[str, float] = {}  # of each series of angles, as the instrument shows them
    for number, line in numbered(path):
        try:
            message = json.loads(line)
            if isinstance(message, dict) and "units" in message and "pgn" not in message:
                units = str(message["units"])
                continue
            pgn, fields = int(message["pgn"]), by_name(message["fields"])
            t = stamp(str(message.get("timestamp", "")))
            found = list(parts(pgn, fields)) if t is not None else []
        except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
            out.skipped["lines that are no such message"] += 1
            continue
        if t is None:
            out.skipped["messages without a time stamp"] += 1
            continue
        out.clock(t, number)
        for quantity, angle, value in found:
            name = f"{pgn}.{message.get('src', '')}.{quantity.rpartition('_')[0]}{instance_of(fields)}"
            more = beside(quantity, fields)
            out.put(
                name, str(message.get("src", "")), quantity, t, value + more, int(pgn in (129029, 127258))
            )
            if angle:
                largest[name] = max(value, largest.get(name, value))
    in_degrees(out, largest, units)
    return out.finish()


def by_name(fields: dict[str, Any]) -> dict[str, Any]:
    """Fields of which some were written with both their number and its name (`-nv`), each as its name, or as
    the number where it has none."""
    return {field: _name_of(raw) if isinstance(raw, dict) else raw for field, raw in fields.items()}


def _name_of(raw: dict[str, Any]) -> Any:
    return raw.get("value") if raw.get("name") is None else raw["name"]


def parts(pgn: int, fields: dict[str, Any]) -> Iterator[tuple[str, bool, float]]:
    """(quantity, whether it is an angle, value) of one message."""
    known = FIELDS.get(pgn, {})
    reference = str(fields.get("Reference", fields.get("reference", "")))
    for given, raw in fields.items():
        name = KEYS.get(given.replace(" ", "").lower(), given)
        if name not in known or isinstance(raw, bool) or not isinstance(raw, int | float):
            continue
        quantity, angle, scale = known[name]
        if quantity == "heading":
            quantity = (
                "heading_magnetic_deg"
                if reference.lower().startswith("magnetic")
                else "heading_true_north_deg"
            )
        if quantity.startswith("wind_"):
            kind = WIND.get(reference.lower())
            if kind is None:
                continue
            quantity = OF_WIND[kind][quantity == "wind_angle"]
        yield quantity, angle, raw * scale


def one_field(fields: dict[str, Any], *names: str) -> Any:
    """The first field of one of these names, however they are spaced and capitalised; None: there is none."""
    told = {given.replace(" ", "").lower(): raw for given, raw in fields.items()}
    return next((told[name] for name in names if name in told), None)


def instance_of(fields: dict[str, Any]) -> str:
    """What follows the name of a series of the second rudder or engine of a source; nothing of the first."""
    told = one_field(fields, "instance", "engineinstance")
    return "" if told in FIRST else f"_{str(told).lower().replace(' ', '_')}"


def beside(quantity: str, fields: dict[str, Any]) -> float:
    """What is to be added to a quantity, in its unit: to a magnetic heading the compass's deviation, to a
    depth how far the transducer is under the surface."""
    if quantity not in BESIDE:
        return 0.0
    name, least = BESIDE[quantity]
    told = one_field(fields, name)
    return max(float(told), least) if isinstance(told, int | float) else 0.0


def in_degrees(out: Signals, largest: dict[str, float], units: str) -> None:
    """Angles of a log in radians become degrees: as its first line says, else when no direction exceeds 2
    pi. `largest`: of each series of angles, in the log's own unit."""
    full = [x for n, x in largest.items() if "heading" in n or "course" in n or "angle" in n]
    if units != "si" and (units == "std" or not full or max(full) > FULL_TURN_RAD):
        return
    for name in largest:
        s = out.series[name]
        for i, x in enumerate(s.values):
            s.values[i] = x * RAD
    out.notes.append(
        "angles are in radians (no direction exceeds 2 pi)" if units != "si" else "angles are in radians"
    )

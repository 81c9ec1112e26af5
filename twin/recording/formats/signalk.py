"""Signal K: deltas, one JSON object a line, with or without a stamp and a name in front; the own vessel's
only."""

import json
from pathlib import Path
from typing import Any

from twin.physics.maths import RAD
from twin.recording.formats.lines import numbered
from twin.recording.formats.recorder_stamps import from_epoch, from_iso
from twin.recording.formats.signals import Signals

SAYS = "a Signal K delta log"
# Signal K's paths, in SI, and what they become (specification 1.7, keys by vessel)
PATHS: dict[str, tuple[str, float]] = {
    "navigation.headingTrue": ("heading_true_north_deg", RAD),
    "navigation.headingMagnetic": ("heading_magnetic_deg", RAD),
    "navigation.magneticVariation": ("magnetic_variation_deg", RAD),
    "navigation.courseOverGroundTrue": ("course_over_ground_deg", RAD),
    "navigation.speedOverGround": ("speed_over_ground_mps", 1.0),
    "navigation.speedThroughWater": ("surge_velocity_through_water_mps", 1.0),
    "navigation.speedThroughWaterTransverse": ("sway_velocity_through_water_mps", 1.0),
    "navigation.rateOfTurn": ("yaw_rate_degps", RAD),
    "navigation.attitude.roll": ("roll_deg", RAD),
    "navigation.position.latitude": ("latitude_deg", 1.0),
    "navigation.position.longitude": ("longitude_deg", 1.0),
    "steering.rudderAngle": ("rudder_angle_deg", RAD),
    "environment.wind.speedApparent": ("apparent_wind_speed_mps", 1.0),
    "environment.wind.angleApparent": ("apparent_wind_angle_deg", RAD),
    "environment.wind.speedOverGround": ("true_wind_speed_mps", 1.0),
    "environment.wind.directionTrue": ("true_wind_direction_deg", RAD),
    "environment.wind.angleTrueGround": ("true_wind_angle_deg", RAD),
    "environment.depth.belowSurface": ("water_depth_m", 1.0),
    "environment.depth.belowTransducer": ("water_depth_m", 1.0),
    "design.draft.current": ("draught_mean_m", 1.0),
}
LATER = frozenset(("environment.depth.belowTransducer",))
SELF = ("", "self", "vessels.self")


def looks(lines: list[str], start: bytes) -> bool:
    """Whether a line of the head is a delta."""
    return any('"updates"' in s and '"values"' in s and "{" in s for s in lines[:10])


def read(path: Path) -> Signals:
    """Series named path and source (`navigation.headingTrue.can0`)."""
    out, own = Signals(path, SAYS), set(SELF)
    for number, line in numbered(path):
        at = line.find(b"{")
        try:
            delta = json.loads(line[at:]) if at >= 0 else None
        except (ValueError, RecursionError):
            out.skipped["lines that are no JSON"] += 1
            continue
        if not isinstance(delta, dict):
            continue
        if isinstance(delta.get("self"), str):
            own |= {delta["self"], "vessels." + delta["self"].removeprefix("vessels.")}
        if delta.get("context", "") not in own:
            out.skipped["deltas of other vessels"] += 1
            continue
        received = from_epoch(line[:at].decode("latin-1")) if at else None
        updates = delta.get("updates", ())
        for update in updates if isinstance(updates, list) else ():
            if isinstance(update, dict):
                try:
                    take(out, update, received, number)
                except OverflowError:
                    out.skipped["updates with a number too long to be one"] += 1
    return out.finish()


def take(out: Signals, update: dict[str, Any], received: float | None, number: int) -> None:
    """The values of one update at its own stamp, or at the recorder's; without either it is counted."""
    t = from_iso(str(update.get("timestamp", "")))
    t = received if t is None else t
    values = update.get("values")
    if t is None or not isinstance(values, list):
        out.skipped["updates without a time stamp"] += t is None
        return
    out.clock(t, number)
    source = source_of(update)
    for entry in values:
        if isinstance(entry, dict) and isinstance(entry.get("path"), str):
            for path, value in flat(entry["path"], entry.get("value")):
                sample(out, path, source, t, value)


def source_of(update: dict[str, Any]) -> str:
    """`$source`, or label and address of `source`."""
    given = update.get("source")
    if isinstance(update.get("$source"), str) or not isinstance(given, dict):
        return str(update.get("$source", ""))
    return ".".join(str(given[k]) for k in ("label", "src", "talker") if given.get(k) not in (None, ""))


def flat(path: str, value: Any) -> list[tuple[str, float]]:
    """Numbers by their full path; an object (position, attitude) gives one for each of its members."""
    if isinstance(value, dict):
        return [
            (f"{path}.{k}", float(x))
            for k, x in value.items()
            if isinstance(x, int | float) and not isinstance(x, bool)
        ]
    return [(path, float(value))] if isinstance(value, int | float) and not isinstance(value, bool) else []


def sample(out: Signals, path: str, source: str, t: float, value: float) -> None:
    """One value of a path at `t` [s since 1970], in the quantity's unit; other paths are counted."""
    parts = path.split(".")
    if parts[0] == "propulsion" and parts[-1] == "revolutions":
        shaft = "drive" in parts or "shaft" in path.lower()
        quantity, scale = ("propeller_rate_rpm" if shaft else "engine_rate_rpm"), 60.0
    elif path in PATHS:
        quantity, scale = PATHS[path]
    else:
        out.skipped["values of other paths"] += 1
        return
    out.put(f"{path}.{source}" if source else path, source, quantity, t, value * scale, int(path in LATER))

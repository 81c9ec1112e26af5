"""What a check says is to be written into the map, as an edit that a button makes.

A check ends with "In the map: FIX." (twin/recording/checks), a fix being entries such as `sign = -1 for
rudder_angle_deg`, `unit = "rad" for it`, `swap their columns`, `[time] rebuild = true`.
"""

import re
import tomllib
from typing import Any

import tomlkit

from twin.recording.checks.check_result import Check
from twin.recording.checks.wind_triangle import WINDS
from twin.recording.map_toml import toml
from twin.recording.mapping import FRAMED, GROUND, NAMES

SURGE, SWAY, HEADING = "surge_velocity_mps", "sway_velocity_mps", "heading_true_north_deg"
SPEEDS = (SURGE, SWAY)
WATER = ("surge_velocity_through_water_mps", "sway_velocity_through_water_mps")
RATE, RUDDER, TURNS = "yaw_rate_degps", "rudder_angle_deg", "propeller_rate_rpm"
NORTH, EAST = ("north_m", "latitude_deg"), ("east_m", "longitude_deg")
ABOUT: dict[str, tuple[str, ...]] = {  # check -> the channels that it asks, the one that "it" is first
    "velocity_frame": (*SPEEDS, HEADING, "north_m", "east_m"),
    "yaw_rate": (RATE, HEADING),
    "compass": (HEADING, *SPEEDS),
    "heading_steps": (HEADING, RATE),
    "rudder_sign": (RUDDER, RATE),
    "rudder_unit": (RUDDER, HEADING),
    "propeller_rate": (TURNS, SURGE),
    "speed_log": (*WATER, SURGE),
    "wind": (
        "apparent_wind_angle_deg",
        "apparent_wind_speed_mps",
        "true_wind_direction_deg",
        "true_wind_speed_mps",
    ),
    "ship_size": (SURGE, RATE),
}
WORDS: dict[str, tuple[str, ...]] = {  # what a fix calls channels without their names
    "surge": (SURGE,),
    "sway": (SWAY,),
    "both": SPEEDS,
    "surge and sway": SPEEDS,
    f"{SURGE} and sway": SPEEDS,
    "the one to the east": (SWAY,),
    "the one to the north": (SURGE,),
    "them": ("north_m", "east_m"),
    "both speeds": tuple(speed for speed, _ in WINDS),
    "both directions": tuple(direction for _, direction in WINDS),
}
ASSIGNED = re.compile(
    r'(sign|unit|offset|frame|direction|despike|late_s|deviation) = ("[^"]*"|\[[^\]]*\]|true|-?[\d.]+)'
)
TIME = re.compile(r'\[time\] (rebuild|unit) = ("[^"]*"|true|[\d.]+)')
FOR = re.compile(r" for ([a-z_ ]+?)(?: \(|[.,;]|$)")
VERDICT = re.compile(
    r"^# cannot be imported by it yet: .*\n", re.MULTILINE
)  # no longer true of what is edited
SWAP = "swap their columns"
# channel ("time" for [time]) -> keys to write; "swap": pairs of channels that exchange their columns
Edit = dict[str, Any]


def channels_of(check: Check, columns: Any) -> list[str]:
    """The channels that a check is about, of those that the voyage has: named in its sentence, or usual."""
    there = [c for c in columns if c != "time_s"]
    named = [c for c in there if re.search(rf"(?<![a-z_]){re.escape(c)}(?![a-z_])", check.text)]
    usual = [c for c in ABOUT.get(check.name, ()) if c in there]
    return list(dict.fromkeys([*named, *usual]))[:4]


def remedies_of(check: Check, columns: Any) -> list[dict[str, Any]]:
    """[{"says": the fix, "edit": what it changes}], one a way out; empty where no entry would help."""
    if check.ok or "In the map: " not in check.text:
        return []
    fixes = check.text.partition("In the map: ")[2].removesuffix(".").split("; or: ")
    out = []
    for fix in fixes:
        edit = _edit(check, fix, list(columns))
        if edit:
            out.append({"says": fix.partition(" (")[0] if TIME.search(fix) else fix, "edit": edit})
    return out


def _edit(check: Check, fix: str, columns: list[str]) -> Edit:
    edit: Edit = {}
    for part in fix.split("; "):
        if found := TIME.search(part):
            edit["time"] = {found[1]: _value(found[2])}
            continue
        if SWAP in part and (pairs := _swapped(check, columns)):
            edit["swap"] = pairs
        said = {key: _value(text) for key, text in ASSIGNED.findall(part)}
        for channel in _meant(check, part, columns) if said else ():
            edit[channel] = {**edit.get(channel, {}), **said}
    return edit


def _swapped(check: Check, columns: list[str]) -> list[list[str]]:
    """The pairs of channels whose columns stand in each other's place; none where the check names none."""
    if check.name == "wind":
        return [list(pair) for pair in zip(*WINDS, strict=True)]
    if check.name != "velocity_frame":
        return []
    if "latitude and longitude are exchanged" in check.text:
        return [["latitude_deg", "longitude_deg"]]
    if "north and east are swapped" in check.text:
        return [["latitude_deg", "longitude_deg"] if "latitude_deg" in columns else ["north_m", "east_m"]]
    return [list(SPEEDS)]


def _meant(check: Check, part: str, columns: list[str]) -> tuple[str, ...]:
    """The channels that "for ..." names."""
    found = FOR.search(part)
    word = found[1].strip() if found else "it"
    if word in NAMES:
        return (word,)
    if word in WORDS:
        return WORDS[word]
    if check.name == "velocity_frame" and word == "it" and "course over ground" in check.text:
        return (SWAY,)
    named = [c for c in ABOUT.get(check.name, ()) if c in check.text and c in columns]
    usual = [c for c in ABOUT.get(check.name, ()) if c in columns]
    return tuple((named or usual)[:1])


def _value(text: str) -> Any:
    return tomllib.loads(f"x = {text.removesuffix('.')}")["x"]


def edited(text: str, edit: Edit) -> str:
    """The map with an edit made; what a check asks for counts from what the map says already. A channel that
    the map lacks is taken from the column that the edit names.

    ValueError where the map has no line for a channel, or says all of it already."""
    document = tomlkit.parse(VERDICT.sub("", text))
    columns = document.setdefault("columns", {})
    for pair in edit.get("swap", ()):
        one, other = (_line_of(channel, columns) for channel in pair)
        columns[one], columns[other] = (_item(columns[name].unwrap()) for name in (other, one))
    for channel, keys in edit.items():
        if channel == "time":
            document.setdefault("time", {}).update(keys)
        elif channel in NAMES and channel not in columns and "column" in keys:
            columns[channel] = _item(dict(keys))
        elif channel != "swap":
            name = _line_of(channel, columns)
            columns[name] = _item(_with(columns[name].unwrap(), keys))
    if document.unwrap() == tomllib.loads(text):
        raise ValueError("the map says this already")
    return tomlkit.dumps(document)


def _line_of(channel: str, columns: Any) -> str:
    """The line of [columns] that fills a channel; a velocity may stand there as one over ground, as the
    checks say in brackets."""
    names = (channel, *(pair[FRAMED.index(channel)] for pair in GROUND.values() if channel in FRAMED))
    found = next((name for name in names if name in columns), None)
    if found is None:
        raise ValueError(f"the map has no line for {channel}")
    return found


def _item(entry: Any) -> Any:
    """An entry of [columns] as tomlkit keeps it, on one line."""
    return tomlkit.value(toml(entry))


def _with(entry: Any, keys: dict[str, Any]) -> dict[str, Any]:
    """An entry of [columns] with more keys: sign and offset follow after those that it has."""
    out = dict(entry) if isinstance(entry, dict) else {"column": entry}
    sign = keys.get("sign", 1)
    offset = sign * out.get("offset", 0.0) + keys.get("offset", 0.0)
    out |= {k: v for k, v in keys.items() if k not in ("sign", "offset")}
    out["sign"], out["offset"] = sign * out.get("sign", 1), offset
    return {k: v for k, v in out.items() if not (k == "sign" and v == 1) and not (k == "offset" and v == 0.0)}

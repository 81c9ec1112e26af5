"""The entries of a proposed map: what each column may be, in what unit and frame, and why."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from twin.num import as_given
from twin.recording.columns_seen import SeenColumns
from twin.recording.formats.actuator_guess import ActuatorGuess
from twin.recording.formats.guess import Guess, guess
from twin.recording.formats.name_words import words_of
from twin.recording.formats.signalk import PATHS
from twin.recording.suggest_actuators import CONTROLS, entry_keys, several, shared_rudder, why_of
from twin.recording.suggest_axes import axes
from twin.recording.suggest_units import (
    WATER,
    WATER_ASIDE,
    place_format,
    speed_unit,
    turn_unit,
    unit_of_angle,
    unit_of_turns,
)
from twin.recording.suggest_wind import one_wind, whose_wind, wind_unit

FRAMES = {
    "course": ("speed_over_ground_mps", "course_over_ground_deg"),
    "earth": ("velocity_north_mps", "velocity_east_mps"),
}
BODY, HEADING = ("surge_velocity_mps", "sway_velocity_mps"), "heading_true_north_deg"
ENGINES = "the ENGINE's rate, not the shaft's: with a gear, factor = 1 / its ratio. CONFIRM"
AHEAD = frozenset(("ahead", "longitudinal", "forward", "surge", "x"))
ASIDE = frozenset(("starboard", "aside", "transverse", "athwart", "sway", "y"))
FROM_THE_LOG = (
    "positive to starboard; of a log that stands x m ahead of midship subtract r x (docs/import.md). CONFIRM"
)
BESIDE = ("magnetic_variation_deg", "plain_x", "plain_y")  # what other entries are made of


Taken = dict[str, tuple[SeenColumns, str, Guess]]
Parts = dict[str, tuple[tuple[SeenColumns, str], ActuatorGuess]]


@dataclass
class Entry:
    """One line of [columns]: the TOML value by key, and why."""

    keys: dict[str, Any]
    why: list[str] = field(default_factory=list)


def proposed(
    files: Sequence[SeenColumns], taken: Taken, parts: Parts, time: dict[str, Any], own: Collection[str] = ()
) -> dict[str, Entry]:
    """The entries of [columns]: what each column is, in what unit, in what frame, and why. `own`: channels
    whose unit the format states."""
    entries = {channel: Entry({"column": seen.key(name)}) for channel, (seen, name, _) in taken.items()}
    for channel, (seen, name, how) in taken.items():
        if channel in own:
            continue
        describe(entries[channel], channel, seen, name, how)
        entries[channel].keys |= in_file(files, seen, name)
    by_motion(entries, taken, time)
    columns = framed(entries)
    if several(parts) or not any(c in columns for c in CONTROLS[:2]):
        columns |= of_parts(files, parts, columns)
    return columns


def of_parts(files: Sequence[SeenColumns], parts: Parts, columns: dict[str, Entry]) -> dict[str, Entry]:
    """The entries of several actuators, in place of one rudder and one shaft."""
    out = {
        channel: Entry(
            entry_keys(where, found) | in_file(files, *where), why_of(found, where[0].numbers(where[1]))
        )
        for channel, (where, found) in parts.items()
    }
    rudder = columns.get(CONTROLS[0])
    if out and rudder and "." not in str(rudder.keys["column"]):
        out |= shared_rudder(out, rudder)
    for name in CONTROLS if out else ():
        columns.pop(name, None)
    return dict(sorted(out.items()))


def in_file(files: Sequence[SeenColumns], seen: SeenColumns, name: str) -> dict[str, str]:
    """Which of several files a column stands in, where more than one has its name: the shortest end of a path
    that says it."""
    if len(files) < 2 or sum(name in f.names for f in files) < 2:
        return {}
    parts = seen.path.parts
    ends = ("/".join(parts[-k:]) for k in range(1, len(parts) + 1))
    return {"file": next(e for e in ends if sum(f.path.as_posix().endswith(e) for f in files) == 1)}


def best_guesses(files: Sequence[SeenColumns]) -> Taken:
    """For each channel the column whose name says it most plainly; of two alike the one with more samples."""
    out: Taken = {}
    for seen in files:
        for name in seen.names:
            found = own_path(name) or guess(name, seen.units.get(name, ""), seen.group(name))
            if found is None or found.channel == "time" or not seen.has_numbers(name):
                continue
            values = seen.numbers(name)
            good = values[np.isfinite(values)]
            still = good.size > 0 and float(good.max()) == float(good.min())
            found = found._replace(score=found.score - 0.5 * still)
            if found.channel not in out or (found.score, seen.rows) > (
                out[found.channel][2].score,
                out[found.channel][0].rows,
            ):
                out[found.channel] = (seen, name, found)
    quaternion(files, out)
    at_home(out)
    one_wind(out)
    log_aside(out)
    return out


def at_home(out: Taken) -> None:
    """Of several files that hold velocities, the one in which the heading stands."""
    home = out[HEADING][0] if HEADING in out else None
    for name in home.names if home else ():
        found = guess(name, home.units.get(name, ""), home.group(name)) if home else None
        if not home or not found or found.channel not in out or not home.has_numbers(name):
            continue
        if found.channel in (*BODY, "yaw_rate_degps") and found.score >= out[found.channel][2].score:
            out[found.channel] = (home, name, found)


def log_aside(out: Taken) -> None:
    """Of a log with two axes, whose columns are called alike but for the axis, each by its own. One that says
    starboard without one that says ahead beside it may be the log of that side."""
    if WATER not in out:
        return
    seen, log, _ = out[WATER]
    rest = frozenset(words_of(seen.said(log))[0]) - AHEAD - ASIDE
    taken = {name for _, name, _ in out.values()} - {log}
    found: Taken = {}
    for name in filter(seen.has_numbers, seen.names):
        words, unit = words_of(seen.said(name))
        for channel, axis in ((WATER, AHEAD), (WATER_ASIDE, ASIDE)):
            if name not in taken and axis.intersection(words) and rest == frozenset(words) - axis:
                found[channel] = (seen, name, Guess(channel, unit or seen.units.get(name, ""), 1.0))
    if len(found) == 2:
        out |= found


def own_path(name: str) -> Guess | None:
    """A column called by a path of Signal K is in that path's unit."""
    quantity, scale = PATHS.get(name.strip(), ("", 1.0))
    if not quantity and name.startswith("propulsion.") and name.endswith(".revolutions"):
        return Guess("propeller_rate_rpm", "1/s", 5.0)
    return (
        Guess(quantity, SI_UNITS.get((quantity.rpartition("_")[2], scale != 1.0), ""), 5.0)
        if quantity
        else None
    )


SI_UNITS = {("deg", True): "rad", ("degps", True): "rad/s", ("mps", False): "m/s"}
QUATERNIONS = (
    ("_x", "_y", "_z", "_w"),
    (".x", ".y", ".z", ".w"),
    ("/x", "/y", "/z", "/w"),
    ("qx", "qy", "qz", "qw"),
    ("q1", "q2", "q3", "q0"),
    ("q[1]", "q[2]", "q[3]", "q[0]"),
    ("X", "Y", "Z", "W"),
)


def quaternion(files: Sequence[SeenColumns], out: Taken) -> None:
    """Without a heading by name: the four parts of an orientation."""
    if HEADING in out:
        return
    for seen in files:
        for ends in QUATERNIONS:
            for stem in [n.removesuffix(ends[3]) for n in seen.names if n.endswith(ends[3])]:
                four = [stem + e for e in ends]
                if all(n in seen.names for n in four) and "covariance" not in stem:
                    out[HEADING] = (seen, four[0], Guess(HEADING, "quaternion " + " ".join(ends), 1.0))
                    return


def describe(entry: Entry, channel: str, seen: SeenColumns, name: str, how: Guess) -> None:
    """Unit and why, from the name and the range."""
    values = seen.numbers(name)
    good = values[np.isfinite(values)]
    if good.size:
        entry.why.append(f"{as_given(float(good.min()), 6)} to {as_given(float(good.max()), 6)}")
    if how.unit.startswith("quaternion"):
        ends = how.unit.split()[1:]
        entry.keys |= {"column": [name.removesuffix(ends[0]) + e for e in ends], "unit": "quaternion"}
        entry.why[:] = []
    elif channel in ("latitude_deg", "longitude_deg"):
        place_format(entry.keys, entry.why, seen, name, values)
    elif channel.endswith("_deg"):
        unit_of_angle(entry.keys, entry.why, channel, how.unit, values)
    elif channel in CONTROLS and not how.unit:
        unit_of_turns(entry.keys, entry.why, how.unit, values)
    elif how.unit and how.unit not in ("s",):
        entry.keys["unit"] = how.unit
        entry.why.append("unit by its name")
    if channel == WATER_ASIDE:
        entry.why.append(FROM_THE_LOG)


def by_motion(entries: dict[str, Entry], taken: Taken, time: dict[str, Any]) -> None:
    """Units that the name does not state, from how position, speed, heading and turning go together."""
    axes(entries, taken, time)
    speed_unit(entries, taken, time)
    turn_unit(entries, taken, time)
    whose_wind(entries, taken)
    wind_unit(entries, taken, time)


def framed(entries: dict[str, Entry]) -> dict[str, Entry]:
    """The entries of [columns] by channel: velocities over ground in the frame they are in; a magnetic
    heading stands in for a true one."""
    out = {c: e for c, e in entries.items() if c not in sum(FRAMES.values(), ()) and c not in BODY}
    if all(name in entries for name in BODY):
        out |= {name: entries[name] for name in BODY}
    else:
        for frame, pair in FRAMES.items():
            if all(name in entries for name in pair):
                for own, name in zip(BODY, pair, strict=True):
                    entries[name].keys["frame"] = frame
                    out[own] = entries[name]
                break
    magnetic = out.pop("heading_magnetic_deg", None)
    if magnetic and HEADING not in out:
        made_true(magnetic, entries.get("magnetic_variation_deg"))
        out[HEADING] = magnetic
    engine = out.pop("engine_rate_rpm", None)
    if engine and CONTROLS[1] not in out:
        engine.why.append(ENGINES)
        out[CONTROLS[1]] = engine
    return {c: e for c, e in out.items() if c not in BESIDE}


def made_true(magnetic: Entry, variation: Entry | None) -> None:
    """A magnetic heading plus the variation beside it, or a note that the place's is needed."""
    if variation is None or {"unit", "file"} & {*magnetic.keys, *variation.keys}:
        magnetic.why.append("MAGNETIC: offset = the variation of the place")
        return
    magnetic.keys["column"] = [magnetic.keys["column"], variation.keys["column"]]
    magnetic.why.append("magnetic, with the variation beside it (east positive)")

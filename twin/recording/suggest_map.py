"""`twin import --suggest-map`: the map of an unknown table, from names, units, ranges and kinematics.

What it rests on stands beside each line; a person confirms it. What the checks then say of the voyage read by
it stands at its head.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError, TwinError
from twin.num import as_given
from twin.recording.columns_seen import SeenColumns, columns_seen
from twin.recording.formats import recognised
from twin.recording.formats.choose import Sources, chosen
from twin.recording.formats.guess import Guess, guess
from twin.recording.formats.signals import Signals
from twin.recording.map_file import parse_map
from twin.recording.several import files_in
from twin.recording.suggest_units import place_format, speed_unit, time_entry, turn_unit, unit_of_angle

FRAMES = {
    "course": ("speed_over_ground_mps", "course_over_ground_deg"),
    "earth": ("velocity_north_mps", "velocity_east_mps"),
}
BODY, HEADING = ("surge_velocity_mps", "sway_velocity_mps"), "heading_true_north_deg"
NEEDED = (HEADING, "rudder_angle_deg", "propeller_rate_rpm")
ANGLES = ("_deg",)


@dataclass
class Entry:
    """One line of [columns]: the TOML value by key, and why."""

    keys: dict[str, Any]
    why: list[str] = field(default_factory=list)


def suggestion(paths: Sequence[Path], sources: Sources) -> str:
    """The map as text. DataError: a path is not there."""
    for path in paths:
        if not path.exists():
            raise DataError(f"{path}: there is no such file. Give a table or a log.")
    kind = recognised(paths[0])
    if kind is not None and kind.series is not None:
        return of_signals(kind.series(paths[0]), sources)
    return of_tables([columns_seen(p) for p in files_in(paths)], paths)


def of_signals(signals: Signals, sources: Sources) -> str:
    """What the log's own map takes, and its unnamed series as they may be meant."""
    choice = chosen(signals, sources)
    lines = [
        f"# {signals.path.name}: {signals.says}. Everything below is taken without a map too; change what is "
        "wrong.",
        "",
    ]
    lines += [f"# {note}" for note in choice.notes]
    lines += ["", "[columns]", *(f"{channel} = {toml(c)}" for channel, c in choice.columns.items())]
    for name, series in signals.series.items():
        found = guess(name) if not series.quantity else None
        if found and found.channel not in choice.columns and found.channel != "time":
            values = np.frombuffer(series.values)
            lines.append(
                f"# {found.channel} = {toml({'column': name})}  # by its name; {as_given(values.min(), 4)} "
                f"to {as_given(values.max(), 4)}. Unit and sign?"
            )
    return "\n".join(lines + lacking(choice.columns)) + "\n"


def of_tables(files: Sequence[SeenColumns], paths: Sequence[Path]) -> str:
    """The map of one table, or of several that are joined."""
    taken = best_guesses(files)
    time = time_entry([f for f in files if any(f is g for g, _, _ in taken.values())] or files)
    entries = {channel: Entry({"column": name}) for channel, (_, name, _) in taken.items()}
    several = len(files) > 1
    for channel, (seen, name, how) in taken.items():
        describe(entries[channel], channel, seen, name, how)
        if several and sum(name in f.names for f in files) > 1:
            entries[channel].keys["file"] = (
                seen.path.name
                if len({f.path.name for f in files}) == len(files)
                else "/".join(seen.path.parts[-2:])
            )
    by_motion(entries, taken, time)
    columns = framed(entries)
    text = written(files, time, columns)
    return with_verdict(text, paths) + unused_columns(files, columns, time)


def best_guesses(files: Sequence[SeenColumns]) -> dict[str, tuple[SeenColumns, str, Guess]]:
    """For each channel the column whose name says it most plainly; of two alike the one with more samples."""
    out: dict[str, tuple[SeenColumns, str, Guess]] = {}
    for seen in files:
        for name in seen.names:
            found = guess(name)
            if found is None or found.channel == "time" or not seen.has_numbers(name):
                continue
            values = seen.numbers(name)
            still = bool(np.isfinite(values).any()) and float(np.nanmax(values)) == float(np.nanmin(values))
            found = found._replace(score=found.score - 0.5 * still)
            if found.channel not in out or (found.score, seen.rows) > (
                out[found.channel][2].score,
                out[found.channel][0].rows,
            ):
                out[found.channel] = (seen, name, found)
    quaternion(files, out)
    return out


def quaternion(files: Sequence[SeenColumns], out: dict[str, tuple[SeenColumns, str, Guess]]) -> None:
    """Without a heading by name: the four parts of an orientation."""
    if HEADING in out:
        return
    for seen in files:
        for stem in {n[:-2] for n in seen.names if n.endswith("_w")}:
            if all(f"{stem}_{k}" in seen.names for k in "xyzw"):
                out[HEADING] = (seen, f"{stem}_x", Guess(HEADING, "quaternion", 1.0))
                return


def describe(entry: Entry, channel: str, seen: SeenColumns, name: str, how: Guess) -> None:
    """Unit and why, from the name and the range."""
    values = seen.numbers(name)
    low, high = (
        (float(np.nanmin(values)), float(np.nanmax(values)))
        if np.isfinite(values).any()
        else (np.nan, np.nan)
    )
    entry.why.append(f"{as_given(low, 6)} to {as_given(high, 6)}")
    if how.unit == "quaternion":
        entry.keys |= {"column": [f"{name[:-2]}_{k}" for k in "xyzw"], "unit": "quaternion"}
        entry.why[:] = ['from north, clockwise? If it counts from east: unit = "quaternion_enu"']
    elif channel in ("latitude_deg", "longitude_deg"):
        place_format(entry.keys, entry.why, seen, name, values)
    elif channel.endswith("_deg"):
        unit_of_angle(entry.keys, entry.why, channel, how.unit, values)
    elif how.unit and how.unit not in ("s",):
        entry.keys["unit"] = how.unit
        entry.why.append("unit by its name")


def by_motion(
    entries: dict[str, Entry], taken: dict[str, tuple[SeenColumns, str, Guess]], time: dict[str, Any]
) -> None:
    """Units that the name does not state, from how position, speed, heading and turning go together."""
    speed_unit(entries, taken, time)
    turn_unit(entries, taken, time)


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
        magnetic.why.append("MAGNETIC: offset = the variation of the place")
        out[HEADING] = magnetic
    out.pop("engine_rate_rpm", None)
    return out


def written(files: Sequence[SeenColumns], time: dict[str, Any], columns: dict[str, Entry]) -> str:
    """The map as a file, each choice with its reason."""
    lines = [
        f"# proposed for {', '.join(f.path.name for f in files[:4])}: read every line, then import with it."
    ]
    layout = files[0].layout
    if layout:
        lines += ["", "[file]", *(f"{k} = {value(v)}" for k, v in layout.items())]
    lines += ["", "[time]", *(f"{k} = {value(v)}" for k, v in time.items() if k != "why")]
    if time.get("why"):
        lines[-1] += f"  # {time['why']}"
    lines += ["", "[columns]"]
    lines += [f"{channel} = {toml(e.keys)}  # {'; '.join(e.why)}" for channel, e in columns.items()]
    return "\n".join(lines + lacking(columns)) + "\n"


def lacking(columns: Any) -> list[str]:
    """A line that says what was not found and is needed; none when nothing is."""
    missing = [name for name in NEEDED if name not in columns]
    place = any(
        all(n in columns for n in pair)
        for pair in (("latitude_deg", "longitude_deg"), ("north_m", "east_m"), BODY)
    )
    missing += [] if place else ["a position or a velocity"]
    return ["", f"# NOT FOUND, and needed: {', '.join(missing)}"] if missing else []


def unused_columns(files: Sequence[SeenColumns], columns: dict[str, Entry], time: dict[str, Any]) -> str:
    """A line that names the columns that no channel took; "" when there are none."""
    used = {
        n
        for e in columns.values()
        for n in (e.keys["column"] if isinstance(e.keys["column"], list) else [e.keys["column"]])
    }
    used |= {e.keys["hemisphere"] for e in columns.values() if "hemisphere" in e.keys}
    used |= set(time["column"] if isinstance(time["column"], list) else [time["column"]])
    left = list(dict.fromkeys(n for f in files for n in f.names if n and n not in used))
    return f"\n# not used: {', '.join(left[:40])}{' ...' * (len(left) > 40)}\n" if left else ""


def with_verdict(text: str, paths: Sequence[Path]) -> str:
    """The map with what the checks say of the voyage read by it, when it can be read."""
    import tomllib

    from twin.recording.checks import run_checks
    from twin.recording.read import read_voyage

    try:
        voyage = read_voyage(list(paths), parse_map(tomllib.loads(text), "the proposed map"))
        said = [f"# {c.name}: {c.text}" for c in run_checks(voyage) if not c.ok]
    except TwinError as error:
        said = [f"# cannot be imported by it yet: {str(error).partition(': ')[2][:400]}"]
    return "\n".join([*said, text])


def toml(entry: Any) -> str:
    """An entry as TOML on one line: a name alone, or a table."""
    if not isinstance(entry, dict):
        return value(entry)
    if set(entry) == {"column"}:
        return value(entry["column"])
    return "{ " + ", ".join(f"{k} = {value(v)}" for k, v in entry.items()) + " }"


def value(v: Any) -> str:
    """A TOML value; JSON's strings are TOML's, but for the letters it escapes otherwise."""
    import json

    if isinstance(v, list | tuple):
        return "[" + ", ".join(value(x) for x in v) + "]"
    return json.dumps(v, ensure_ascii=False) if isinstance(v, str | bool) else repr(v)

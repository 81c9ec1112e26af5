"""`twin import --suggest-map`: the map of an unknown table, from names, units, ranges and kinematics.

What it rests on stands beside each line; a person confirms it. What the checks then say of the voyage read by
it stands at its head.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError, TwinError
from twin.num import as_given
from twin.recording.columns_seen import SeenColumns, columns_seen
from twin.recording.formats import recognised
from twin.recording.formats.actuator_guess import ActuatorGuess
from twin.recording.formats.choose import Sources, chosen
from twin.recording.formats.guess import Guess, guess
from twin.recording.formats.signalk import PATHS
from twin.recording.formats.signals import PLACE, Signals
from twin.recording.place import CHART
from twin.recording.map_file import parse_map
from twin.recording.several import files_in
from twin.recording.suggest_actuators import (
    CONTROLS,
    actuator_columns,
    entry_keys,
    several,
    shared_rudder,
    why_of,
)
from twin.recording.suggest_axes import axes
from twin.recording.suggest_clock import time_entry
from twin.recording.suggest_series import CLOCK, OWN, known_series, topics_seen
from twin.recording.suggest_units import (
    place_format,
    speed_unit,
    turn_unit,
    unit_of_angle,
    unit_of_turns,
    wind_unit,
)

FRAMES = {
    "course": ("speed_over_ground_mps", "course_over_ground_deg"),
    "earth": ("velocity_north_mps", "velocity_east_mps"),
}
BODY, HEADING = ("surge_velocity_mps", "sway_velocity_mps"), "heading_true_north_deg"
NEEDED = (HEADING, "rudder_angle_deg", "propeller_rate_rpm")
BESIDE = ("magnetic_variation_deg", "plain_x", "plain_y")  # what other entries are made of


Taken = dict[str, tuple[SeenColumns, str, Guess]]
Parts = dict[str, tuple[tuple[SeenColumns, str], ActuatorGuess]]


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
    if kind is not None and kind.series is not None and len(paths) == 1:
        return of_signals(kind.series(paths[0]), sources)
    return of_tables([columns_seen(p) for p in files_in(paths)], paths)


def of_signals(signals: Signals, sources: Sources) -> str:
    """What the log's own map takes, and its unnamed series as they may be meant."""
    choice = chosen(signals, sources)
    topics = topics_seen(signals)
    own = {
        c: (seen, name, Guess(c, "", OWN)) for c, seen, name in known_series(signals, choice.columns, topics)
    }
    taken = {
        c: w for c, w in best_guesses(topics).items() if c not in own and not signals.series[w[1]].quantity
    }
    parts = {
        c: w
        for c, w in actuator_columns(topics).items()
        if c not in choice.columns and not signals.series[w[0][1]].quantity
    }
    more = proposed(topics, own | taken, parts, {"column": CLOCK, "unit": "s"}, own)
    lines = [
        f"# {signals.path.name}: {signals.says}. What stands under [columns] first is taken without a map too; change what is wrong.",
        "",
    ]
    lines += [f"# {note}" for note in choice.notes]
    lines += ["", "[columns]", *(f"{quoted(channel)} = {toml(c)}" for channel, c in choice.columns.items())]
    added = {c: e for c, e in more.items() if c not in choice.columns and not clashes(c, choice.columns)}
    lines += ["# by their names; read these with care"] * bool(added)
    lines += [f"{quoted(channel)} = {toml(e.keys)}  # {'; '.join(e.why)}" for channel, e in added.items()]
    columns = choice.columns | added
    return with_verdict("\n".join(lines + lacking(columns)) + "\n", [signals.path])


def clashes(channel: str, columns: Any) -> bool:
    """Whether a position stands there already as another pair, or a velocity as one."""
    return (channel in CHART and PLACE[0] in columns) or (channel in PLACE and CHART[0] in columns)


def of_tables(files: Sequence[SeenColumns], paths: Sequence[Path]) -> str:
    """The map of one table, or of several that are joined."""
    taken = best_guesses(files)
    parts = actuator_columns(files)
    used = [
        f
        for f in files
        if any(f is g for g, _, _ in taken.values()) or any(f is w[0] for w, _ in parts.values())
    ]
    time = time_entry(used or files)
    columns = proposed(files, taken, parts, time)
    text = written(files, time, columns)
    return with_verdict(text, paths) + unused_columns(files, columns, time)


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
    return out


def at_home(out: Taken) -> None:
    """Of several files that hold velocities, the one in which the heading stands."""
    home = out[HEADING][0] if HEADING in out else None
    for name in home.names if home else ():
        found = guess(name, home.units.get(name, ""), home.group(name)) if home else None
        if home and found and found.channel in (*BODY, "yaw_rate_degps") and found.channel in out:
            if found.score >= out[found.channel][2].score and home.has_numbers(name):
                out[found.channel] = (home, name, found)


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
QUATERNIONS = (("_x", "_y", "_z", "_w"), (".x", ".y", ".z", ".w"), ("/x", "/y", "/z", "/w"), ("qx", "qy", "qz", "qw"),
               ("q1", "q2", "q3", "q0"), ("q[1]", "q[2]", "q[3]", "q[0]"), ("X", "Y", "Z", "W"))  # fmt: skip


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


def by_motion(entries: dict[str, Entry], taken: Taken, time: dict[str, Any]) -> None:
    """Units that the name does not state, from how position, speed, heading and turning go together."""
    axes(entries, taken, time)
    speed_unit(entries, taken, time)
    turn_unit(entries, taken, time)
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
        engine.why.append("the ENGINE's rate, not the shaft's: with a gear, factor = 1 / its ratio. CONFIRM")
        out[CONTROLS[1]] = engine
    return {c: e for c, e in out.items() if c not in BESIDE}


def made_true(magnetic: Entry, variation: Entry | None) -> None:
    """A magnetic heading plus the variation beside it, or a note that the place's is needed."""
    if variation is None or {"unit", "file"} & {*magnetic.keys, *variation.keys}:
        magnetic.why.append("MAGNETIC: offset = the variation of the place")
        return
    magnetic.keys["column"] = [magnetic.keys["column"], variation.keys["column"]]
    magnetic.why.append("magnetic, with the variation beside it (east positive)")


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
    lines += [f"{quoted(channel)} = {toml(e.keys)}  # {'; '.join(e.why)}" for channel, e in columns.items()]
    return "\n".join(lines + lacking(columns)) + "\n"


def quoted(channel: str) -> str:
    """A channel as a key of TOML: with its actuator's name it needs marks."""
    return f'"{channel}"' if "." in channel else channel


def lacking(columns: Any) -> list[str]:
    """A line that says what was not found and is needed; none when nothing is."""
    needed = NEEDED[:1] if any("." in name for name in columns) else NEEDED
    missing = [name for name in needed if name not in columns]
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
    left = list(dict.fromkeys(n for f in files for n in f.names if n and f.key(n) not in used))
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

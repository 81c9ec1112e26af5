"""`twin import --suggest-map`: the map of an unknown table, from names, units, ranges and kinematics.

What it rests on stands beside each line; a person confirms it. What the checks then say of the voyage read by
it stands at its head.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from twin.errors import DataError, TwinError
from twin.recording.columns_seen import SeenColumns, columns_seen
from twin.recording.formats import recognised
from twin.recording.formats.choose import Sources
from twin.recording.map_file import parse_map
from twin.recording.map_toml import lacking, quoted, toml, value
from twin.recording.mapping import FRAMED
from twin.recording.several import files_in
from twin.recording.suggest_actuators import actuator_columns, means_of_two
from twin.recording.suggest_clock import time_entry
from twin.recording.suggest_entries import Entry, best_guesses, proposed
from twin.recording.suggest_log import of_signals

CLOCK_PROVED = re.compile(r'In the map: \[time\] unit = "(\w+)"\.')
PROVED = re.compile(r'that is believed\. In the map: (frame|unit|sign) = "?([^" ]+)"? for (both|[a-z_]+)\.')
UNDER_KEEL = re.compile(r"(under|below|unter)[ _-]*(the[ _-]*)?(keel|kiel)|\bukc\b", re.IGNORECASE)
ONE_SCREW = (
    "With a ship file of one rudder and one propeller (twin init --propellers 2), in the place of the lines "
    "of each actuator their means:"
)


def suggestion(paths: Sequence[Path], sources: Sources) -> str:
    """The map as text. DataError: a path is not there."""
    for path in paths:
        if not path.exists():
            raise DataError(f"{path}: there is no such file. Give a table or a log.")
    kind = recognised(paths[0])
    if kind is not None and kind.series is not None and len(paths) == 1:
        return with_verdict(of_signals(kind.series(paths[0]), sources), paths)
    return of_tables([columns_seen(p) for p in files_in(paths)], paths)


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
    text = with_verdict(written(files, time, columns), paths)
    if proved(columns, time, text):
        text = with_verdict(written(files, time, columns), paths)
    return text + unused_columns(files, columns, time)


def proved(columns: dict[str, Entry], time: dict[str, Any], text: str) -> bool:
    """Writes a frame, a unit or a sign that a check proves into the entries; whether there was one."""
    said = "\n".join(line for line in text.splitlines() if line.startswith("# "))
    found, clock = PROVED.findall(said), CLOCK_PROVED.findall(said)
    if clock:
        time |= {"unit": clock[0], "why": "unit as position, heading and turning prove. CONFIRM"}
    for key, value_of_it, whose in found:
        for channel in FRAMED if whose == "both" else (whose,):
            if channel in columns:
                columns[channel].keys[key] = int(value_of_it) if key == "sign" else value_of_it
                columns[channel].why.append(f"{key} as position, heading and turning prove. CONFIRM")
    return bool(found or clock)


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
    means = means_of_two({channel: e.keys for channel, e in columns.items()})
    if means:
        lines += [f"# {ONE_SCREW}", *(f"# {quoted(c)} = {toml(keys)}" for c, keys in means.items())]
    return "\n".join(lines + lacking(columns)) + "\n"


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
    hint = "" if "water_depth_m" in columns else under_keel(left)
    return f"{hint}\n# not used: {', '.join(left[:40])}{' ...' * (len(left) > 40)}\n" if left else ""


def under_keel(left: Sequence[str]) -> str:
    """A line that makes the depth of the water of a column that tells what is under the keel; "" without
    one."""
    column = next((name for name in left if UNDER_KEEL.search(name)), None)
    depth = toml({"column": column, "offset": "DRAUGHT"})
    return f"\n# water_depth_m = {depth}  # from the surface; the draught in metres\n" if column else ""


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

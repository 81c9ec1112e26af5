"""A header's own words: the names of docs/import.md are taken, near misses refused, other columns named as
unused; with a map, what it leaves out is taken by those names."""

import difflib
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

from twin.errors import DataError
from twin.live.signals.channels import BY_NAME
from twin.recording.mapping import FRAMED, GROUND, NAMES, PLACES, Column, Layout, Map, TimeColumn, nearest
from twin.recording.place import CHART
from twin.recording.sheet import Sheet, open_text

TIMES = ("time_s", "time_utc")
ALLOWED = (*NAMES, *TIMES, *(name for pair in GROUND.values() for name in pair))
OVER_GROUND = ("sog", "cog", "course", "over_ground", "velocity_north", "velocity_east")
MISSPELT = 0.85  # a name this much alike is a slip of the pen, not another quantity


def own_names(path: Path, names: Sequence[str]) -> tuple[Map, tuple[str, ...]]:
    """(the map of the documented names, one sentence for each column that is not used). DataError: no
    column is a time, or one nearly has the name of a channel."""
    columns = named(names)
    used = {*TIMES, *(c.column for c in columns.values())}
    unused = tuple(unknown(path, name) for name in names if name and name not in used)
    times = [name for name in TIMES if name in names]
    if not times:
        raise DataError(
            f"{path}: has no column time_s or time_utc. {held(names)}. Rename what is the time, or read the "
            f"file by a map: twin import {path} --suggest-map -o map.toml proposes one."
        )
    return Map(time=own_time(times[0]), columns=columns), unused


def own_time(name: str) -> TimeColumn:
    """The clock in a column of one of the documented names."""
    return TimeColumn(name, "iso" if name == "time_utc" else "s")


def named(names: Collection[str]) -> dict[str, Column]:
    """The channels that columns have by the documented names."""
    return {n: Column(n) for n in names if n in NAMES or n in BY_NAME} | over_ground(names)


def overlaid(by: Map, names: Sequence[str]) -> Map:
    """A map laid over what the columns' own names say: it replaces the channels that it names, and leaves
    the others. A position is one pair, and velocities have one frame: where the map names one of them, only
    its own partner is left beside it."""
    taken = {*by.columns, *by.constant}
    read = {key for c in by.columns.values() for key in c.parts}
    for pair, other in ((PLACES, CHART), (CHART, PLACES)):
        taken |= {*other} if taken & {*pair} else set()
    once = [name for name in names if names.count(name) == 1]
    own = {n: c for n, c in named(once).items() if n not in taken and not read & {*c.parts}}
    if taken & {*FRAMED}:
        body = all(by.columns[n].frame == "body" for n in FRAMED if n in by.columns)
        own = {n: c for n, c in own.items() if n not in FRAMED or (body and c.frame == "body")}
    times = [name for name in TIMES if name in names]
    time = by.time or (own_time(times[0]) if times else None)
    return replace(by, columns={**own, **by.columns}, time=time)


def held(names: Sequence[str]) -> str:
    """The first columns of a header, by their names."""
    first = [repr(name) for name in names if name]
    more = f" and {len(first) - 8} more" * (len(first) > 8)
    return f"Its columns are {', '.join(first[:8])}{more}" if first else "Its header is blank"


def over_ground(names: Collection[str]) -> dict[str, Column]:
    """The velocities over ground by course or by the earth's axes, where they are not there by the ship's."""
    if not any(name in names for name in FRAMED):
        for frame, pair in GROUND.items():
            if all(name in names for name in pair):
                return {own: Column(name, frame=frame) for own, name in zip(FRAMED, pair, strict=True)}
    return {}


def names_by(path: Path, layout: Layout) -> list[str]:
    """The column names of a text table that a map lays out; none where it says that there is no header."""
    with open_text(path, layout.encoding) as stream:
        return Sheet(path, stream, layout).names


def column_names(path: Path) -> list[str]:
    """The cells of the first line; DataError when they are numbers."""
    names = names_by(path, Layout())
    if any(is_number(name) for name in names):
        raise DataError(
            f"{path}: line 1 has numbers where column names should be ({', '.join(names)[:60]}). Add a "
            "header line, or give a map with header = false and columns by number (--map)."
        )
    return names


def unknown(path: Path, name: str) -> str:
    """What to say of a column that docs/import.md does not have; DataError when it is a slip of the pen."""
    if any(word in name.lower() for word in OVER_GROUND):
        pairs = ", or else ".join(" and ".join(pair) for pair in (FRAMED, *GROUND.values()))
        return f"{name!r} is not used (what is read as velocity over ground: {pairs})"
    near = nearest(name, ALLOWED)
    if near and difflib.SequenceMatcher(None, name, near).ratio() >= MISSPELT:
        raise DataError(
            f"{path}: no column is called {name!r}. Did you mean {near!r}? Rename it, or use a map (--map)."
        )
    return f"{name!r} is not used" + (f" (did you mean {near!r}?)" if near else "")


def is_number(text: str) -> bool:
    """Whether a cell is a number, with a point or a decimal comma."""
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True

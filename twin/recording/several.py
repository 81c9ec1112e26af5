"""Several files as one voyage: one CSV a topic, joined on their own clocks; nothing is drawn between rows.

Each column of a map stands in the one file that has it, or in the one that its `file` names.
"""

from collections.abc import Sequence
from dataclasses import replace
from fnmatch import fnmatch
from pathlib import Path

import numpy as np

from twin.errors import DataError
from twin.recording.cells import converted, there
from twin.recording.formats import recognised
from twin.recording.formats.binary_tables import Packed
from twin.recording.formats.series_table import as_columns
from twin.recording.formats.signals import Signals
from twin.recording.headers import column_names, overlaid, own_names
from twin.recording.mapping import Column, Map, TimeColumn
from twin.recording.raw import Raw, opened_table, read_clock, stamps_of, table_of, through
from twin.recording.table import Table
from twin.recording.timebase import TimeAxis, clock_from_numbers, moment_of, rebuilt, refuse_backwards

ENDINGS = (".csv", ".txt", ".tsv", ".dat", ".gz", ".parquet", ".feather", ".arrow", ".xlsx")
SAYS = "several tables"
MOST_FILES = 200


def files_in(paths: Sequence[Path]) -> list[Path]:
    """The tables among files and folders. DataError: a path is not there, or there are none or too many."""
    out = []
    for path in paths:
        if path.is_dir():
            out += sorted(p for p in path.rglob("*") if p.suffix.lower() in ENDINGS and p.is_file())
        elif path.is_file():
            out.append(path)
        else:
            raise DataError(f"{path}: there is no such file. Give tables or a folder of them.")
    if not out or len(out) > MOST_FILES:
        raise DataError(
            f"{paths[0]}: is a folder and holds {len(out)} tables; 1 to {MOST_FILES} can be joined."
        )
    return out


class Part:
    """One file: its column names, and what reads it."""

    def __init__(self, path: Path):
        self.path = path
        self.packed: Packed | None = None
        kind = recognised(path)
        if kind is not None and kind.table is None:
            raise DataError(f"{path}: this is {kind.says}; it is imported by itself, not joined with others.")
        if kind is not None:
            self.packed = opened_table(kind, path)
        self.names = self.packed.names if self.packed else column_names(path)


def joined(paths: Sequence[Path], by: Map | None) -> Raw:
    """The samples of several tables on one clock."""
    parts = [Part(path) for path in files_in(paths)]
    signals, notes, lost = Signals(paths[0], SAYS), list[str](), list[str]()
    maps = placed_in(parts, by, paths[0]) if by else own_maps(parts, notes)
    for part, own in maps:
        add(signals, part, own, notes, lost)
    signals.finish()
    starts = min(float(s.times[0]) for s in signals.series.values())
    time_s, columns = as_columns(signals, list(signals.series))
    lines = np.arange(1, time_s.size + 1)
    table = Table(paths[0], lines, dict(columns.items()), {}, lost=tuple(lost))
    frames = {name: c for _, own in maps for name, c in own.columns.items()}
    whole = replace(by or Map(), columns={n: Column(n, frame=frames[n].frame) for n in columns}, time=None)
    clock = clock_from_numbers(paths[0], time_s, TimeColumn()) if starts > 1e8 else TimeAxis(time_s)
    units = {name: c.unit for name, c in frames.items() if c.unit}
    facts = {"files": [str(p.path) for p, _ in maps], "units": units}
    return through(paths[0], table, clock, whole, notes, facts)


def own_maps(parts: Sequence[Part], notes: list[str]) -> list[tuple[Part, Map]]:
    """The files that speak in the channels' own names."""
    out = []
    for part in parts:
        by, unused = own_names(part.path, part.names)
        notes += [f"{part.path.name}: {said}" for said in unused]
        if by.columns:
            out.append((part, by))
    return out


def placed_in(parts: Sequence[Part], by: Map, where: Path) -> list[tuple[Part, Map]]:
    """Each file with the part of the map that stands in it, laid over what its columns' own names say: of a
    channel that several files name, the first one's."""
    held: dict[int, dict[str, Column]] = {}
    for name, c in by.columns.items():
        place = file_of(parts, name, c, where)
        if place is not None:
            held.setdefault(place, {})[name] = c
    times, taken = dict.fromkeys(held, by.time), {*by.columns}
    for i, part in enumerate(parts):
        own = overlaid(by, part.names)
        if own.time and {*stamps_of(own)} <= {*part.names}:
            left = {n: c for n, c in own.columns.items() if n not in taken}
            times[i], taken = own.time, taken | {*left}
            held |= {i: held.get(i, {}) | left} if left else {}
    return [
        (parts[i], replace(by, columns=columns, constant={}, time=times.get(i, by.time)))
        for i, columns in held.items()
    ]


def file_of(parts: Sequence[Part], name: str, c: Column, where: Path) -> int | None:
    """Which file holds an entry's columns; DataError when none does, or more than one."""
    possible = [i for i, p in enumerate(parts) if not c.file or fnmatch(p.path.as_posix(), f"*{c.file}")]
    holds = [i for i in possible if all(isinstance(k, int) or k in parts[i].names for k in c.parts)]
    if len(holds) == 1:
        return holds[0]
    if not holds and c.optional:
        return None
    said = ", ".join(str(k) for k in c.parts)
    if not holds:
        raise DataError(
            f"{where}: {name}: no file has the column {said}{f' (file = {c.file!r})' * bool(c.file)}."
        )
    some = ", ".join(parts[i].path.name for i in holds[:4])
    raise DataError(
        f'{where}: {name}: the column {said} stands in {len(holds)} files ({some}). Say which: file = "..." '
        "in the map. Files that are voyages of their own are imported one at a time."
    )


def add(signals: Signals, part: Part, by: Map, notes: list[str], lost: list[str]) -> None:
    """The channels of one file, each on its own clock, what was assumed of it and what was damaged."""
    spec = by.time or TimeColumn()
    table = table_of(part.path, by, part.packed)
    clock = read_clock(part.path, table, stamps_of(by), spec)
    own, known = clock.time_s.copy(), np.isfinite(clock.time_s)
    said = [*table.notes, *clock.notes]
    if spec.rebuild is not False and known.any():
        own[known], how = rebuilt(part.path, own[known], spec.rebuild)
        said.append(how)
    refuse_backwards(part.path, table.lines[known], own[known])
    time_s = own + moment_of(clock.start_time_utc)
    notes += [f"{part.path.name}: {one}" for one in said]
    lost += [f"{part.path.name}: {one}" for one in table.lost]
    for name, c in by.columns.items():
        if there(table, c):
            values = converted(name, table, c, time_s, by.name, notes)
            series = signals.of(name, part.path.name, "")
            series.times.frombytes(np.ascontiguousarray(time_s, float).tobytes())
            series.values.frombytes(np.ascontiguousarray(values, float).tobytes())

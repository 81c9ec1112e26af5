"""A file's samples before anything is judged, and a table through a map."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.recording.cells import converted, number_keys, optional_keys, sum_of, text_keys, there
from twin.recording.formats import Format
from twin.recording.formats.binary_tables import Packed
from twin.recording.mapping import Key, Map, TimeColumn
from twin.recording.place import FRAMED, no_latitude, placed, scaled
from twin.recording.table import Table, read_packed, read_table
from twin.recording.timebase import EPOCH_S, TimeAxis, clock_from_numbers, clock_from_text, day
from twin.recording.units import froude

ABOUT = "shiptwin.voyage"  # the table of words in a voyage's own log; values are JSON


@dataclass
class Raw:
    """A file's samples in border units, before anything is judged; `lines`: where each row stands in it."""

    path: Path
    lines: np.ndarray
    time_s: np.ndarray
    columns: dict[str, np.ndarray]
    meta: dict[str, Any]
    notes: list[str] = field(default_factory=list)
    rebuild: bool | float = False  # see TimeColumn
    lost: list[str] = field(default_factory=list)  # what of the file was damaged


def through(
    path: Path, table: Table, clock: TimeAxis, by: Map, notes: list[str], facts: dict[str, Any]
) -> Raw:
    """A table through a map: every channel in its unit, then places and velocities in their frames.
    DataError: its latitudes are beyond 90 deg."""
    columns = {
        name: converted(name, table, c, clock.time_s, by.name, notes)
        for name, c in by.columns.items()
        if there(table, c)
    }
    notes = [*notes, *clock.notes]
    columns |= {name: np.full(table.lines.shape, x) for name, x in by.constant.items()}
    given = sorted(columns)
    if why := no_latitude(columns):
        raise DataError(f"{path}: {why}")
    columns, known, said = placed(clock.time_s, columns, by)
    columns = scaled(columns, by)
    slower = froude("time_s", by.froude_scale)
    step = by.time.rebuild if by.time else False
    step = step if isinstance(step, bool) else step * slower
    frame = by.columns[FRAMED[0]].frame if FRAMED[0] in by.columns else ""
    meta = about(path, clock) | {
        "map": by.name,
        "given": given,
        "constant": sorted(by.constant),
        "velocity_frame": frame,
    }
    meta |= {"units": {name: c.unit for name, c in by.columns.items() if c.unit}} | facts | known
    return Raw(path, table.lines, clock.time_s * slower, columns, meta, notes + said, step, list(table.lost))


def about(path: Path, clock: TimeAxis) -> dict[str, Any]:
    """Where the samples come from, and when they begin."""
    return {"source": str(path), "start_time_utc": clock.start_time_utc}


def read_clock(path: Path, table: Table, stamps: tuple[Key, ...], spec: TimeColumn) -> TimeAxis:
    """The clock of a table: numbers (several are added up by `factors`, or are parts of a date by `format`),
    moments that a packed table keeps, or text. DataError: a number and a text among them do not fit."""
    if all(s in table.numbers for s in stamps) and not parts_of_a_date(table, stamps, spec):
        if spec.is_text:
            spec = TimeColumn(spec.column)
        return clock_from_numbers(path, sum_of([table.numbers[s] for s in stamps], spec.factors), spec)
    joint = " " if spec.format else "T"
    words = [
        joint.join(parts) if all(parts) else ""
        for parts in zip(*stamps_as_text(path, table, stamps, spec.format), strict=True)
    ]
    return clock_from_text(path, table.lines, words, spec)


def stamps_as_text(path: Path, table: Table, stamps: tuple[Key, ...], form: str) -> list[list[str]]:
    """The columns of a time as text: numbers that are parts of a date as they are; of moments that a packed
    table keeps the day, for the time of day stands beside it as text. DataError: they are no moments, or
    `form` has not a part for each column."""
    if all(s in table.numbers for s in stamps):
        return [list(map(_as_written, table.numbers[s])) for s in stamps]
    forms = form.split(" ") if form else ["%Y-%m-%d"] * len(stamps)
    kept = {s: table.numbers[s] for s in stamps if s in table.numbers}
    if kept and (len(forms) != len(stamps) or any(np.any(x < EPOCH_S) for x in kept.values())):
        numbers, texts = (", ".join(repr(s) for s in stamps if (s in kept) == here) for here in (True, False))
        raise DataError(
            f"{path}: of the time {numbers} holds numbers and {texts} text, and together they are none. "
            "Write all as text, or the day as a moment and the format with a part for each column, a blank "
            'between: [time] format = "%d.%m.%Y %H:%M:%S".'
        )
    days = {s: [day(x, forms[stamps.index(s)]) for x in moments] for s, moments in kept.items()}
    return [(days if s in kept else table.texts)[s] for s in stamps]


def _as_written(x: float) -> str:
    """A part of a date as text; "" of an empty cell."""
    return "" if np.isnan(x) else f"{x:.0f}" if x == np.rint(x) else repr(float(x))


def parts_of_a_date(table: Table, stamps: tuple[Key, ...], spec: TimeColumn) -> bool:
    """Whether columns of numbers are year, month, day and so on, which the format of a text tells apart."""
    numbers = [table.numbers[s] for s in stamps]
    return bool(spec.format) and len(stamps) > 1 and not any(np.any(x >= EPOCH_S) for x in numbers)


def opened_table(kind: Format, path: Path) -> Packed:
    """A table of this format, opened: its column names, and what reads it."""
    assert kind.table is not None
    return kind.table(path, kind.says)


def stamps_of(by: Map) -> tuple[Key, ...]:
    """The columns of a map's time."""
    return (by.time or TimeColumn()).parts


def table_of(path: Path, by: Map, packed: Packed | None) -> Table:
    """The columns of a table that a map needs."""
    is_text, entries = (by.time or TimeColumn()).is_text, list(by.columns.values())
    words = list(dict.fromkeys([*(stamps_of(by) if is_text else ()), *text_keys(entries)]))
    numbers = list(dict.fromkeys([*(() if is_text else stamps_of(by)), *number_keys(entries)]))
    if by.layout.long:
        words, numbers = (
            [*dict.fromkeys([*words, by.layout.long[0]])],
            [by.layout.long[1], *(() if is_text else stamps_of(by))],
        )
        entries = []
    if packed:
        return read_packed(packed, numbers, words, optional_keys(entries))
    return read_table(path, by.layout, numbers, words, optional_keys(entries))

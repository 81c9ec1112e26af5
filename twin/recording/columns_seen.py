"""A table as it is looked at before there is a map: its names, and some thousands of its rows."""

from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.recording.formats import recognised
from twin.recording.formats.header_rows import HeaderRows, header_rows, own_labels
from twin.recording.formats.name_words import unit_in
from twin.recording.headers import is_number
from twin.recording.long_table import long_columns
from twin.recording.mapping import Key, Layout
from twin.recording.sheet import Sheet, cells, find_separator, open_text
from twin.recording.table import EMPTY

ROWS = 6000  # rows that are looked at
HEAD_LINES = 200  # lines in which the header is looked for
SAY_NOTHING = frozenset(("data", "value", "values", "x", "y", "z", "angle", "position", "val", "field.data"))


@dataclass
class SeenColumns:
    """`cells` by column name, as text or as numbers; `layout`: the [file] table that reads it, where it needs
    one. `keys`: what a map calls a column, where its name stands twice; `groups` and `units`: what stands
    above and under its name."""

    path: Path
    names: list[str]
    cells: dict[str, Any]
    layout: dict[str, Any] = field(default_factory=dict)
    keys: dict[str, Key] = field(default_factory=dict)
    groups: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    labels: dict[str, str] = field(default_factory=dict)  # what to read in place of a name that says little

    def key(self, name: str) -> Key:
        """What a map calls a column."""
        return self.keys.get(name, name)

    def group(self, name: str) -> str:
        """What stands above a column's name, or its file's name where its own says nothing."""
        group = self.groups.get(name, "")
        if not group and name.strip().lower() in SAY_NOTHING:
            group = " ".join(self.path.with_suffix("").parts[-2:])
        return group

    def said(self, name: str) -> str:
        """What there is to read about a column: its name behind its group's."""
        return f"{self.group(name)} {self.labels.get(name, name)}".strip()

    @cached_property
    def rows(self) -> int:
        """How many rows were read."""
        return max((len(c) for c in self.cells.values()), default=0)

    def texts(self, name: str) -> list[str]:
        """A column as text."""
        return [str(c) for c in self.cells[name]]

    def numbers(self, name: str) -> np.ndarray:
        """(N,) the column as numbers, NaN where a cell is none. In the file's unit."""
        cells = self.cells[name]
        if isinstance(cells, np.ndarray):
            return cells
        return np.array([float(c.replace(",", ".")) if c and is_number(c) else np.nan for c in cells])

    def has_numbers(self, name: str) -> bool:
        """Whether a column holds numbers, or degrees as text."""
        cells = self.cells[name]
        if isinstance(cells, np.ndarray):
            return bool(np.isfinite(cells).any())
        filled = [c for c in cells[:200] if c.lower() not in EMPTY]
        return bool(filled) and sum(
            is_number(c) or any(ch.isdigit() for ch in c[:3]) for c in filled
        ) > 0.5 * len(filled)


def columns_seen(path: Path) -> SeenColumns:
    """The first rows of a table of any kind. DataError: a log of messages, or a table without rows."""
    kind = recognised(path)
    if kind is not None and kind.table is not None:
        packed = kind.table(path, kind.says)
        names = [n for n in packed.names if n]
        rows = first_pieces(packed.pieces(names), names)
        return SeenColumns(path, names, rows, units={n: u for n, u in packed.units.items() if n in names})
    if kind is not None:
        raise DataError(f"{path}: this is {kind.says}; give it by itself.")
    return of_text(path)


def first_pieces(pieces: Any, names: list[str]) -> dict[str, Any]:
    """The first rows of every column. DataError: there is none."""
    first = next(iter(pieces), None)
    if first is None:
        raise DataError("a table without rows. Export it again, with the measurements.")
    return {n: first[n][:ROWS] for n in names}


def of_text(path: Path) -> SeenColumns:
    """A text table: lines above the column names are skipped, a line of units under them too. DataError: it
    has numbers where its columns' names should be."""
    header = header_of(path)
    skip = header.names_at if header else 0
    under = header.rows_at - header.names_at - 1 if header else 0
    with open_text(path, None) as stream:
        sheet = Sheet(path, stream, Layout(skip_lines=skip, skip_after_header=under))
        names = sheet.names
        rows = [row for _, row in islice(sheet.rows(), ROWS)]
    if header is None and names and not all_words(names):
        raise DataError(
            f"{path}: line {skip + 1} has numbers where the names of the {len(names)} columns should be "
            f"({', '.join(names)[:60]}). Write a line of names above it, in the same order and with the same "
            "separator, such as time_s, heading_deg, rudder_deg, rpm; or give a map with header = false and "
            "columns by number (--map)."
        )
    layout: dict[str, Any] = {"skip_lines": skip} if skip else {}
    layout |= {"skip_after_header": under} if under else {}
    labels = own_labels(names, header.groups if header else [])
    shown = {label: [row[i].strip() for row in rows] for i, label in enumerate(labels) if label}
    keys: dict[str, Key] = {
        label: i + 1
        for i, label in enumerate(labels)
        if label and (label != names[i] or names.count(label) > 1)
    }
    seen = SeenColumns(path, [n for n in labels if n], shown, layout, keys)
    for i, label in enumerate(labels if header else []):
        seen.groups[label] = header.groups[i] if header and i < len(header.groups) else ""
        seen.units[label] = unit_in(header.units[i].strip("[]()")) if header and i < len(header.units) else ""
    return as_wide(seen)


def as_wide(seen: SeenColumns) -> SeenColumns:
    """A long table with a column for each name of a reading; another as it is."""
    numbers = [n for n in seen.names if seen.has_numbers(n)]
    found = long_columns(seen.names, seen.cells, numbers)
    if found is None:
        return seen
    told, values = np.array(seen.cells[found[0]]), seen.numbers(found[1])
    names = [n for n in dict.fromkeys(seen.cells[found[0]]) if n]
    kept = {n: c for n, c in seen.cells.items() if n not in found}
    cells_of = {n: np.where(told == n, values, np.nan) for n in names}
    return SeenColumns(seen.path, [*kept, *names], kept | cells_of, seen.layout | {"long": list(found)})


def all_words(names: list[str]) -> bool:
    """Whether no name is a number."""
    return not any(is_number(name) for name in names if name)


def header_of(path: Path) -> HeaderRows | None:
    """The header of a text table, by its first lines that are not blank; None: its first line is a row, or
    no line is one."""
    with open_text(path, None) as stream:
        lines = list(islice(stream, HEAD_LINES))
    at = [i for i, line in enumerate(lines) if line.strip()]
    rows_like = [find_separator(lines[i]) for i in at[len(at) // 2 :]]
    if not rows_like:
        return None
    layout = Layout(separator=max(set(rows_like), key=rows_like.count))
    found = header_rows([cells(lines[i], layout) for i in at])
    if found is None or found.rows_at >= len(at):
        return None
    # blank lines count where a map skips lines, and do not between the names and the rows
    return found._replace(names_at=at[found.names_at], rows_at=at[found.rows_at])

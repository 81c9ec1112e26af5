"""A table as it is looked at before there is a map: its names, and some thousands of its rows."""

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.recording.formats import recognised
from twin.recording.headers import is_number
from twin.recording.mapping import Layout
from twin.recording.sheet import Sheet, find_separator, open_text
from twin.recording.table import EMPTY

ROWS = 6000  # rows that are looked at
HEAD_LINES = 30  # lines above the column names at most


@dataclass
class SeenColumns:
    """`cells` by column name, as text or as numbers; `layout`: the [file] table that reads it, where it needs
    one."""

    path: Path
    names: list[str]
    cells: dict[str, Any]
    layout: dict[str, Any] = field(default_factory=dict)

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
        return SeenColumns(path, names, first_pieces(packed.pieces(names), names))
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
    skip = lines_above(path)
    with open_text(path, None) as stream:
        sheet = Sheet(path, stream, Layout(skip_lines=skip))
        names = sheet.names
        rows = [row for _, row in islice(sheet.rows(), ROWS)]
    if names and all(is_number(name) for name in names if name):
        raise DataError(
            f"{path}: line {skip + 1} has numbers where the names of the {len(names)} columns should be "
            f"({', '.join(names)[:60]}). Write a line of names above it, in the same order and with the same "
            "separator, such as time_s, heading_deg, rudder_deg, rpm; or give a map with header = false and "
            "columns by number (--map)."
        )
    layout: dict[str, Any] = {"skip_lines": skip} if skip else {}
    if rows and not any(is_number(c) for c in rows[0]):
        layout["skip_after_header"] = 1
        del rows[0]
    cells = {name: [row[i].strip() for row in rows] for i, name in enumerate(names) if name}
    return SeenColumns(path, [n for n in names if n], cells, layout)


def lines_above(path: Path) -> int:
    """How many lines stand above the column names: up to the first that has as many cells as most and no
    number."""
    with open_text(path, None) as stream:
        lines = list(islice(stream, 200))
    found = Counter(find_separator(line) for line in lines[len(lines) // 2 :] if line.strip())
    separator = found.most_common(1)[0][0] if found else " "
    counts = [line.count(separator) if separator != " " else 0 for line in lines]
    usual = int(np.median(counts[len(counts) // 2 :])) if counts else 0
    if usual == 0:
        return 0
    return next((i for i, n in enumerate(counts[:HEAD_LINES]) if n >= usual), 0)

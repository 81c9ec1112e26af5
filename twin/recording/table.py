"""A text file as columns of numbers, read in pieces so that a large file does not fill the memory.

Whatever is wrong is said with file, line, column and value.
"""

import re
from array import array
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

import numpy as np

from twin.errors import DataError
from twin.recording.mapping import Key, Layout
from twin.recording.sheet import Row, Sheet, open_text

ROWS_AT_ONCE = 20_000
EMPTY = frozenset(("", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---"))
COMMA_NUMBER = re.compile(r"\s*[-+]?\d+,\d+([eE][-+]?\d+)?\s*")


@dataclass(frozen=True)
class Table:
    """Columns of one file: `numbers` as float arrays, `texts` as lists; `lines`: each row's line in it."""

    path: Path
    lines: np.ndarray
    numbers: dict[Key, np.ndarray]
    texts: dict[Key, list[str]]
    notes: tuple[str, ...] = ()
    lost: tuple[str, ...] = ()  # what was damaged


def read_table(
    path: Path,
    layout: Layout,
    numbers: Sequence[Key],
    texts: Sequence[Key] = (),
    optional: Collection[Key] = (),
) -> Table:
    """The named columns of a file; `numbers` become floats with NaN for empty cells, `texts` stay text. Only
    an optional column may be absent."""
    with open_text(path, layout.encoding) as stream:
        sheet = Sheet(path, stream, layout)
        absent = [key for key in optional if not sheet.has(key)]
        sheet.notes += [f"the optional column {key!r} is not there" for key in absent]
        return collect(sheet, [key for key in numbers if key not in absent], texts)


def collect(sheet: Sheet, numbers: Sequence[Key], texts: Sequence[Key]) -> Table:
    at = {key: sheet.index(key) for key in (*numbers, *texts)}
    # each grows in its place: pieces that are joined at the end would lie there twice
    parts = {key: array("d") for key in numbers}
    words: dict[Key, list[str]] = {key: [] for key in texts}
    lines = array("q")
    rows = sheet.rows()
    layout = sheet.layout
    while piece := list(islice(rows, ROWS_AT_ONCE)):
        check_width(sheet, piece)
        layout = with_decimal(layout, piece, sheet.notes)
        for key in numbers:
            parts[key].frombytes(
                floats(sheet.path, key, [(n, r[at[key]]) for n, r in piece], layout).tobytes()
            )
        for key in texts:
            words[key] += [r[at[key]].strip() for _, r in piece]
        lines.extend(n for n, _ in piece)
    if not lines:
        raise DataError(f"{sheet.path}: has a header but no rows. Export it again, with the measurements.")
    columns = {key: np.frombuffer(part) for key, part in parts.items()}
    return Table(
        sheet.path, np.frombuffer(lines, np.int64), columns, words, tuple(sheet.notes), tuple(sheet.lost)
    )


def check_width(sheet: Sheet, piece: list[Row]) -> None:
    """No row is wider than the header: with commas between columns that means decimal commas."""
    for line, row in piece:
        if len(row) > sheet.width and any(map(str.strip, row[sheet.width :])):
            hint = "Decimal commas? Export with points, or with ';' between the columns."
            raise DataError(
                f"{sheet.path}: line {line} has {len(row)} cells, the first line has {sheet.width}. {hint}"
            )


def with_decimal(layout: Layout, piece: list[Row], notes: list[str]) -> Layout:
    """The layout with its decimal mark: as stated, or a comma when the first row is written so."""
    if layout.decimal is None:
        comma = any(COMMA_NUMBER.fullmatch(c) for c in piece[0][1])
        if comma:
            notes.append("numbers have decimal commas")
        return replace(layout, decimal="," if comma else ".")
    return layout


def floats(path: Path, key: Key, numbered: list[tuple[int, str]], layout: Layout) -> np.ndarray:
    """The cells of one column as float64: quickly when all are numbers, else cell by cell."""
    if layout.decimal != "," and not layout.missing:
        try:
            return np.fromiter((float(c) for _, c in numbered), float, len(numbered))
        except ValueError:
            pass
    return np.array([one(path, key, line, cell.strip(), layout) for line, cell in numbered])


def one(path: Path, key: Key, line: int, cell: str, layout: Layout) -> float:
    """One cell as a number, NaN when it is empty, DataError when it is neither."""
    if cell.lower() in EMPTY or cell in layout.missing:
        return np.nan
    try:
        return float(cell.replace(",", ".") if layout.decimal == "," else cell)
    except ValueError:
        raise DataError(
            f"{path}: line {line}, column {key!r}: {cell[:40]!r} is not a number. Correct it or leave the "
            "cell empty; in a map, [file] missing = [...] lists cells that mean 'no sample', "
            "skip_after_header skips a line of units."
        ) from None

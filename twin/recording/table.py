"""A text file as columns of numbers, read in pieces so that a large file does not fill the memory.

Whatever is wrong is said with file, line, column and value.
"""

import re
from array import array
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.recording.formats.binary_tables import Packed
from twin.recording.formats.fast_csv import LEAST_BYTES, collected
from twin.recording.mapping import Key, Layout
from twin.recording.sheet import LACKING, Row, Sheet, find_encoding, head_of, open_text

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
        numbers, texts = ([key for key in keys if key not in absent] for keys in (numbers, texts))
        quick = quickly(sheet, numbers, texts, find_encoding(head_of(path)))
        if quick is not None:
            return quick
        return collect(sheet, numbers, texts)


def quickly(sheet: Sheet, numbers: Sequence[Key], texts: Sequence[Key], encoding: str) -> Table | None:
    """A large plain table by the quick reader; None when it is not for it, or stumbles."""
    layout = sheet.layout
    plain = (
        layout.header
        and layout.decimal in (None, ".")
        and not layout.missing
        and layout.encoding is None
        and not layout.skip_after_header
    )
    if (
        not plain
        or texts
        or not numbers
        or sheet.path.suffix.lower() == ".gz"
        or sheet.path.stat().st_size < LEAST_BYTES
    ):
        return None
    names = {key: sheet.names[sheet.index(key)] for key in numbers}
    found = collected(
        sheet.path,
        sheet.names,
        list(dict.fromkeys(names.values())),
        layout.separator or ",",
        sheet.head_lines,
        encoding,
        sheet.notes,
    )
    if found is None:
        return None
    rows = len(next(iter(found.values())))
    lines = np.arange(sheet.head_lines + 1, sheet.head_lines + 1 + rows)
    return Table(sheet.path, lines, {key: found[n] for key, n in names.items()}, {}, tuple(sheet.notes))


def read_packed(
    packed: Packed, numbers: Sequence[Key], texts: Sequence[Key] = (), optional: Collection[Key] = ()
) -> Table:
    """The same of a packed table (Parquet, Feather, Excel); a moment among `texts` comes as a number, as
    it is kept. DataError: it has no rows, or not such a column."""
    wanted = dict.fromkeys((*numbers, *texts))
    found = {key: packed_name(packed, key) for key in wanted if key not in optional or has(packed, key)}
    held: dict[Key, list[Any]] = {key: [] for key in found}
    for piece in packed.pieces(list(dict.fromkeys(found.values()))):
        for key, name in found.items():
            held[key].append(piece[name])
    table = Table(packed.path, np.zeros(0, int), {}, {}, (f"read as {packed.says}",))
    for key, parts in held.items():
        if any(isinstance(p, np.ndarray) for p in parts):
            table.numbers[key] = np.concatenate(parts)
        else:
            words = [str(w) for p in parts for w in p]
            if key in texts:
                table.texts[key] = words
            else:
                table.numbers[key] = floats(packed.path, key, list(enumerate(words, 2)), Layout(decimal="."))
    rows = max((*map(len, table.numbers.values()), *map(len, table.texts.values())), default=0)
    if not rows:
        raise DataError(f"{packed.path}: has a header but no rows. Export it again, with the measurements.")
    return replace(table, lines=np.arange(2, rows + 2))


def has(packed: Packed, key: Key) -> bool:
    """Whether a packed table has a column of this name or number."""
    return 1 <= key <= len(packed.names) if isinstance(key, int) else key in packed.names


def packed_name(packed: Packed, key: Key) -> str:
    """A column's name, by name or by number from 1. DataError: there is none."""
    if not has(packed, key):
        raise DataError(
            f"{packed.path}: has no column {key!r}. Columns: {', '.join(packed.names) or 'unnamed'}. "
            + LACKING
        )
    return packed.names[key - 1] if isinstance(key, int) else key


def collect(sheet: Sheet, numbers: Sequence[Key], texts: Sequence[Key]) -> Table:
    """All rows of the columns that are wanted, read in pieces. DataError: there is none."""
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
    """No row is wider than the header: with commas between columns that means decimal commas. DataError:
    one is."""
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
    """The cells of one column as float64 (N,), in the unit of the file: quickly when all are numbers, else
    cell by cell."""
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

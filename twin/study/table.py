"""A text file as columns of numbers, read in pieces so that a large file does not fill the memory.

Whatever is wrong is said with file, line, column and value.
"""

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

import numpy as np

from twin.errors import DataError, SettingsError
from twin.study.mapping import Key, Layout

ROWS_AT_ONCE = 20_000
EMPTY = frozenset(("", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---"))
SEPARATORS = {"tab": "\t", "whitespace": " ", ",": ",", ";": ";", "\t": "\t", " ": " ", "|": "|"}
COMMA_NUMBER = re.compile(r"\s*[-+]?\d+,\d+([eE][-+]?\d+)?\s*")
Row = tuple[int, list[str]]


@dataclass(frozen=True)
class Table:
    """Columns of one file: `numbers` as float arrays, `texts` as lists; `lines` is each row's line in the file."""

    path: Path
    lines: np.ndarray
    numbers: dict[Key, np.ndarray]
    texts: dict[Key, list[str]]
    notes: tuple[str, ...] = ()


class Sheet:
    """An open file: its column names, then its rows."""

    def __init__(self, path: Path, stream: TextIO, layout: Layout) -> None:
        self.path, self.notes = path, []  # type: Path, list[str]
        lines = enumerate(stream, 1)
        skipped = list(islice(lines, layout.skip_lines))
        first = next(((n, s) for n, s in lines if s.strip() and not s.lower().startswith("sep=")), None)
        if first is None:
            said = f"ends within the {len(skipped)} lines that the map skips" if skipped else "is empty"
            raise DataError(f"{path}: {said}. Export it again, with a header line and rows.")
        self.layout = replace(layout, separator=separator(path, layout.separator, first[1]))
        head = cells(first[1], self.layout)
        self.names = [c.strip() for c in head] if layout.header else []
        self.width = len(head)
        self._lines = lines
        self._again = [] if layout.header else [first]  # without a header the first line is a row
        list(islice(lines, layout.skip_after_header))

    def index(self, key: Key) -> int:
        """Where a column stands (from 0); DataError when it is not there or twice there."""
        if isinstance(key, int):
            if not 1 <= key <= self.width:
                raise DataError(f"{self.path}: has {self.width} columns, so there is no column {key}.")
            return key - 1
        if self.names.count(key) > 1:
            places = [i + 1 for i, name in enumerate(self.names) if name == key]
            raise DataError(
                f"{self.path}: the header names {key!r} {len(places)} times (columns {places}). Rename all but "
                "one, or choose by number in a map."
            )
        if key not in self.names:
            raise DataError(f"{self.path}: has no column {key!r}. Columns: {', '.join(self.names) or 'unnamed'}.")
        return self.names.index(key)

    def rows(self) -> Iterator[Row]:
        """(line, cells) of every row that is not blank; a line cut off at the end of the file is left out."""
        for line, text in chain(self._again, self._lines):
            row = cells(text, self.layout)
            if not any(map(str.strip, row)):
                continue
            if len(row) >= self.width:
                yield line, row
            else:
                self._short(line, text, row)

    def _short(self, line: int, text: str, row: list[str]) -> None:
        if text.endswith("\n"):
            raise DataError(
                f"{self.path}: line {line} has {len(row)} cells, the first line has {self.width}: "
                f"{text.strip()[:60]!r}. Complete or remove it."
            )
        self.notes.append(f"line {line} is cut off at the end of the file and was left out")


def read_table(path: Path, layout: Layout, numbers: Sequence[Key], texts: Sequence[Key] = ()) -> Table:
    """The named columns of a file; `numbers` become floats with NaN for empty cells, `texts` stay text."""
    with open_text(path, layout.encoding) as stream:
        sheet = Sheet(path, stream, layout)
        return collect(sheet, numbers, texts)


def collect(sheet: Sheet, numbers: Sequence[Key], texts: Sequence[Key]) -> Table:
    at = {key: sheet.index(key) for key in (*numbers, *texts)}
    parts: dict[Key, list[np.ndarray]] = {key: [] for key in numbers}
    words: dict[Key, list[str]] = {key: [] for key in texts}
    lines: list[np.ndarray] = []
    rows = sheet.rows()
    layout = sheet.layout
    while piece := list(islice(rows, ROWS_AT_ONCE)):
        check_width(sheet, piece)
        layout = with_decimal(layout, piece, sheet.notes)
        for key in numbers:
            parts[key].append(floats(sheet.path, key, [(n, r[at[key]]) for n, r in piece], layout))
        for key in texts:
            words[key] += [r[at[key]].strip() for _, r in piece]
        lines.append(np.array([n for n, _ in piece]))
    if not lines:
        raise DataError(f"{sheet.path}: has a header but no rows. Export it again, with the measurements.")
    joined = {key: np.concatenate(p) for key, p in parts.items()}
    return Table(sheet.path, np.concatenate(lines), joined, words, tuple(sheet.notes))


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
            f"{path}: line {line}, column {key!r}: {cell[:40]!r} is not a number. Correct it or leave the cell "
            "empty; in a map, [file] missing = [...] lists cells that mean 'no sample', skip_after_header skips "
            "a line of units."
        ) from None


def cells(line: str, layout: Layout) -> list[str]:
    if layout.separator == " ":
        return line.split()
    return next(csv.reader((line,), delimiter=layout.separator or ","), [])


def separator(path: Path, name: str | None, line: str) -> str:
    """The separator by the map's name for it, or the one found in the first line."""
    if name is None:
        return find_separator(line)
    if name not in SEPARATORS:
        raise SettingsError(f"{path}: separator {name!r} is not known: use , ; | tab or whitespace.")
    return SEPARATORS[name]


def find_separator(line: str) -> str:
    """The separator that occurs most in the first line; white space when there is none."""
    counts = {s: line.count(s) for s in (";", "\t", ",", "|")}
    best = max(counts, key=lambda s: counts[s])
    return best if counts[best] else " "


def open_text(path: Path, encoding: str | None) -> TextIO:
    """The file as text: UTF-8, UTF-16 with its mark, or Latin-1 when it is neither; never binary."""
    try:
        with open(path, "rb") as f:
            head = f.read(1 << 16)
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}.") from None
    encoding = encoding or find_encoding(head)
    if b"\0" in head and not encoding.startswith("utf-16"):
        raise DataError(f"{path}: is not text (byte 0 at {head.index(0)}). Give a CSV or an MCAP file.")
    try:
        return open(path, encoding=encoding, errors="replace", newline="")
    except LookupError:
        raise SettingsError(f"{path}: encoding {encoding!r} is not known; try 'utf-8' or 'latin-1'.") from None


def find_encoding(head: bytes) -> str:
    """From the first bytes; Latin-1 reads anything, and the numbers come out the same."""
    if head.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    try:
        head[: len(head) - 4 if len(head) == 1 << 16 else None].decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return "utf-8-sig" if error.reason == "unexpected end of data" else "latin-1"
    return "utf-8-sig"

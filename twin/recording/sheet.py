"""An open text file: its encoding and separator found, its column names, and its rows as cells."""

import csv
import re
from collections.abc import Iterator
from dataclasses import replace
from io import TextIOWrapper
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

from twin.errors import DataError, SettingsError
from twin.recording.formats.lines import Unpacked, opened
from twin.recording.mapping import SEPARATORS, Key, Layout

DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d*(?:[eE][-+]?\d+)?")
LACKING = "In the map: its name in this file, or optional = true in its entry where some files lack it."
COMMENT = ("#", "%", "//")  # what may stand in front of a line of names
Row = tuple[int, list[str]]  # line in the file, cells


class Sheet:
    """An open file: its column names, then its rows."""

    def __init__(self, path: Path, stream: TextIO, layout: Layout) -> None:
        self.path = path
        self.notes: list[str] = []
        self.lost: list[str] = []
        lines = enumerate(stream, 1)
        skipped = list(islice(lines, layout.skip_lines))
        first = next(((n, s) for n, s in lines if s.strip() and not s.lower().startswith("sep=")), None)
        if first is None:
            said = f"ends within the {len(skipped)} lines that the map skips" if skipped else "is empty"
            raise DataError(f"{path}: {said}. Export it again, with a header line and rows.")
        self.head_lines = first[0]  # lines up to the one with the names
        self.layout = replace(layout, separator=SEPARATORS.get(layout.separator or find_separator(first[1])))
        head = cells(first[1], self.layout)
        head = head[1:] if head[0] in COMMENT and self.layout.separator == " " else head  # "# t x y"
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
                f"{self.path}: the header names {key!r} {len(places)} times (columns {places}). Rename all "
                "but one, or choose by number in a map."
            )
        if key not in self.names:
            raise DataError(
                f"{self.path}: has no column {key!r}. Columns: {', '.join(self.names) or 'unnamed'}. "
                + LACKING
            )
        return self.names.index(key)

    def has(self, key: Key) -> bool:
        """Whether there is such a column."""
        return 1 <= key <= self.width if isinstance(key, int) else key in self.names

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
        self.lost.append(f"line {line} is cut off at the end of the file and was left out")


def cells(line: str, layout: Layout) -> list[str]:
    """The cells of one line."""
    if layout.separator == " ":
        return line.split()
    if '"' not in line:
        return line.rstrip("\r\n").split(layout.separator or ",")
    return next(csv.reader((line,), delimiter=layout.separator or ","), [])


def find_separator(line: str) -> str:
    """The separator that occurs most in the first line, where commas are not those of decimals; white space
    when there is none."""
    counts = {s: line.count(s) for s in (";", "\t", ",", "|")}
    best = max(counts, key=lambda s: counts[s])
    if best == ",":
        others = (s for s in (";", "\t", "|") if counts[s])
        best = next((s for s in others if all(map(_one_cell, line.split(s)))), best)
    return best if counts[best] else " "


def _one_cell(text: str) -> bool:
    """Whether a comma in it is at most that of a decimal."""
    return "," not in text or DECIMAL_COMMA.fullmatch(text.strip()) is not None


def head_of(path: Path) -> bytes:
    """The first bytes of a file, unpacked when it ends in .gz. DataError: it cannot be read."""
    try:
        with opened(path) as f:
            return f.read(1 << 16)
    except (OSError, EOFError) as error:
        raise DataError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}.") from None


def open_text(path: Path, encoding: str | None) -> TextIO:
    """The file as text: UTF-8, UTF-16 with its mark, or Latin-1 when it is neither; never binary. What
    ends in .gz is unpacked. DataError: it is binary. SettingsError: nobody knows that encoding."""
    head = head_of(path)
    encoding = encoding or find_encoding(head)
    if b"\0" in head and not encoding.startswith("utf-16"):
        raise DataError(f"{path}: is not text (byte 0 at {head.index(0)}). Give a CSV or an MCAP file.")
    try:
        if path.suffix.lower() == ".gz":
            return TextIOWrapper(Unpacked(path, "rb"), encoding, errors="replace", newline="")  # type: ignore[arg-type]
        return open(path, encoding=encoding, errors="replace", newline="")
    except LookupError:
        raise SettingsError(
            f"{path}: encoding {encoding!r} is not known; try 'utf-8' or 'latin-1'."
        ) from None


def find_encoding(head: bytes) -> str:
    """From the first bytes; Latin-1 reads anything, and the numbers come out the same."""
    if head.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    try:
        head[: len(head) - 4 if len(head) == 1 << 16 else None].decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return "utf-8-sig" if error.reason == "unexpected end of data" else "latin-1"
    return "utf-8-sig"

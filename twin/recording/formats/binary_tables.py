"""Tables that are not plain text: Parquet, Feather, Arrow, Excel; columns by name, a piece at a time.

Numbers come as floats, moments as seconds since 1970, words as text.
"""

from collections.abc import Iterator, Sequence
from datetime import UTC, date, datetime, time
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError, TwinError
from twin.recording.formats.extra import library, one_line
from twin.recording.formats.header_rows import HeaderRows, header_rows, own_labels
from twin.recording.formats.lines import head
from twin.recording.formats.name_words import unit_in

PARQUET, FEATHER, EXCEL = "a Parquet table", "a Feather (Arrow) table", "an Excel workbook"
Piece = dict[str, Any]  # column: float array, or a list of words

LOOKED_AT = 200  # rows of a sheet in which its header is looked for


def looks_parquet(lines: list[str], start: bytes) -> bool:
    """Whether a file starts as Parquet does."""
    return start.startswith(b"PAR1")


def looks_feather(lines: list[str], start: bytes) -> bool:
    """Whether a file starts as Arrow or Feather does."""
    return start.startswith((b"ARROW1", b"FEA1"))


def looks_excel(lines: list[str], start: bytes) -> bool:
    """Whether a file starts as an Excel workbook does."""
    return start.startswith(b"PK") and (
        b"[Content_Types].xml" in start or b"xl/" in start or b"_rels/" in start
    )


class Packed:
    """A table of one of these formats: its column names, and pieces of the columns asked for."""

    def __init__(self, path: Path, says: str):
        self.path, self.says = path, says
        self.units: dict[str, str] = {}  # by column, where a line under the names states them
        try:
            self.names: list[str] = self._open()
        except (TwinError, MemoryError):
            raise
        except Exception as error:
            raise self._damaged(error) from None

    def _open(self) -> list[str]:
        raise NotImplementedError

    def _damaged(self, error: Exception) -> DataError:
        return DataError(f"{self.path}: this is {self.says}, and it cannot be read: {one_line(error)}.")

    def pieces(self, names: Sequence[str]) -> Iterator[Piece]:
        """The named columns, rows in order."""
        try:
            yield from self._pieces(names)
        except (DataError, MemoryError):
            raise
        except Exception as error:
            raise self._damaged(error) from None

    def _pieces(self, names: Sequence[str]) -> Iterator[Piece]:
        raise NotImplementedError


class Parquet(Packed):
    def _open(self) -> list[str]:
        self._file = library("pyarrow.parquet", self.path, self.says).ParquetFile(self.path)
        return list(self._file.schema_arrow.names)

    def _pieces(self, names: Sequence[str]) -> Iterator[Piece]:
        for batch in self._file.iter_batches(batch_size=100_000, columns=list(names)):
            yield {
                name: arrow_cells(self.path, name, batch.column(batch.schema.get_field_index(name)))
                for name in names
            }


class Feather(Packed):
    def _open(self) -> list[str]:
        if head(self.path).startswith(b"FEA1"):
            raise DataError(
                f"{self.path}: this is Feather of version 1. Write it again as version 2, Parquet or CSV."
            )
        self._file = library("pyarrow.ipc", self.path, self.says).open_file(str(self.path))
        return list(self._file.schema.names)

    def _pieces(self, names: Sequence[str]) -> Iterator[Piece]:
        for i in range(self._file.num_record_batches):
            batch = self._file.get_batch(i)
            yield {
                name: arrow_cells(self.path, name, batch.column(batch.schema.get_field_index(name)))
                for name in names
            }


class Excel(Packed):
    """The sheet with most rows of numbers; lines above its names are left out, one of units is read as such,
    one of groups tells columns of one name apart."""

    def _open(self) -> list[str]:
        book = library("openpyxl", self.path, self.says).load_workbook(
            self.path, read_only=True, data_only=True
        )
        best: tuple[int, list[Any], HeaderRows] | None = None
        for sheet in book.worksheets:
            rows = [row for row in sheet.iter_rows(values_only=True) if any(c is not None for c in row)]
            found = header_rows([[as_text(c) for c in row] for row in rows[:LOOKED_AT]])
            if found and (best is None or len(rows) - found.rows_at > best[0]):
                best = len(rows) - found.rows_at, rows, found
        if best is None:
            raise DataError(f"{self.path}: no sheet has a line of column names with rows under it.")
        _, rows, header = best
        self._rows = rows[header.rows_at :]
        names = own_labels([as_text(c) for c in rows[header.names_at]], header.groups)
        self.units = {
            n: unit_in(u.strip("[]()")) for n, u in zip(names, header.units, strict=False) if n and u
        }
        return names

    def _pieces(self, names: Sequence[str]) -> Iterator[Piece]:
        at = {name: self.names.index(name) for name in names}
        held: dict[str, list[Any]] = {
            name: [row[i] if i < len(row) else None for row in self._rows] for name, i in at.items()
        }
        if self._rows:
            yield {name: cells(values) for name, values in held.items()}


def arrow_cells(path: Path, name: str, column: Any) -> Any:
    """An Arrow column as floats (moments as seconds since 1970), or as words. DataError: its cells are of
    a kind that no reading has."""
    import pyarrow as pa

    kind = column.type
    if pa.types.is_dictionary(kind):
        column = column.dictionary_decode()
        kind = column.type
    if pa.types.is_timestamp(kind):
        scale = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[kind.unit]
        return column.cast(pa.int64()).to_numpy(zero_copy_only=False).astype(float) * scale
    if pa.types.is_decimal(kind) or pa.types.is_boolean(kind):
        column, kind = column.cast(pa.float64()), pa.float64()
    if pa.types.is_integer(kind) or pa.types.is_floating(kind):
        return np.asarray(column.to_numpy(zero_copy_only=False), float)
    if pa.types.is_string(kind) or pa.types.is_large_string(kind):
        return ["" if x is None else x for x in column.to_pylist()]
    raise DataError(f"{path}: column {name!r} holds {kind}, which is neither numbers, nor moments, nor text.")


def cells(values: list[Any]) -> Any:
    """Cells of a sheet as floats when all of them are numbers, moments or empty; else as words (days without
    a time of day too: a column of clock times may stand beside them)."""
    filled = [c for c in values if c is not None]
    days = bool(filled) and all(is_day(c) for c in filled)
    if not days and all(isinstance(c, int | float | datetime | date) for c in filled):
        return np.array([number(c) for c in values])
    return [as_text(c) for c in values]


def is_day(cell: Any) -> bool:
    """Whether a cell is a day, without a time of it."""
    if isinstance(cell, datetime):
        return (cell.hour, cell.minute, cell.second, cell.microsecond) == (0, 0, 0, 0)
    return isinstance(cell, date)


def as_text(cell: Any) -> str:
    """A cell as text: a day and a moment as ISO 8601, an empty cell as nothing."""
    if cell is None:
        return ""
    if is_day(cell):
        return str(cell.isoformat()[:10])
    return cell.isoformat() if isinstance(cell, datetime | time) else str(cell).strip()


def number(cell: Any) -> float:
    """A cell as a number: a date or a moment as seconds since 1970, an empty cell as NaN."""
    if cell is None:
        return float("nan")
    if isinstance(cell, datetime):
        return cell.replace(tzinfo=cell.tzinfo or UTC).timestamp()
    if isinstance(cell, date):
        return datetime(cell.year, cell.month, cell.day, tzinfo=UTC).timestamp()
    return float(cell)

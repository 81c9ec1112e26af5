"""The rows of a fleet on disk: FOLDER/rows.parquet, one row a cause and a voyage.

Parquet cannot be written on: each voyage's rows are a small file of their own in FOLDER/parts until a run
ends, and the next run gathers what an interrupted one left there.
"""

import fcntl
import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from twin.errors import DataError, TwinError
from twin.study.fleet.ask import Key, Row, key_of

ROWS, PARTS, LOCK = "rows.parquet", "parts", ".lock"
LASTING_FAILURES = (None, "DataError", "SettingsError")  # the others are asked again

TEXT, NUMBER, YES, COUNT = pa.string(), pa.float64(), pa.bool_(), pa.int64()
SIZE = pa.struct(
    [("name", TEXT), ("value", NUMBER), ("low95", NUMBER), ("high95", NUMBER), ("unit", TEXT),
     ("at_box_end", YES), ("in_ship_file", NUMBER)]
)  # fmt: skip
KINDS: Mapping[pa.DataType, str] = {
    TEXT: "ship ship_file ship_sha256 voyage voyage_file voyage_sha256 map_file map_sha256 version asked_utc "
    "start_time_utc failed failed_as verdict reason sentence facts rivals weather moments next_manoeuvre "
    "compare_verdict effect belongs_to says",
    NUMBER: "seconds duration_s horizon_s position_mae_m position_expected_m heading_mae_deg "
    "heading_expected_deg p_value p_value_at_best score probability posterior error_horizon_s "
    "error_without_m error_with_m error_expected_m X_N Y_N N_Nm",
    COUNT: "references",
    YES: "more named lasting",
    pa.list_(TEXT): "one_of data_checks cannot_be_told_from",
    pa.list_(SIZE): "parameters",
}
SCHEMA = pa.schema([(name, kind) for kind, names in KINDS.items() for name in names.split()])


class Store:
    """A folder of answers; one program at a time may add to it."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self.path = self.folder / ROWS
        try:
            (self.folder / PARTS).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _cannot(folder, error) from None

    @contextmanager
    def alone(self) -> Iterator[None]:
        """While rows are added; what an interrupted run left is gathered first, and all at the end.
        TwinError: another process is at work on it."""
        with open(self.folder / LOCK, "w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise TwinError(
                    f"{self.folder}: another `twin fleet` is at work on it. Wait for it, or choose another "
                    "folder with -o."
                ) from None
            self.gather()
            try:
                yield
            finally:
                self.gather()

    def rows(self) -> dict[Key, list[Row]]:
        """All rows, by their question; of one that was asked again, those of the last time."""
        found: dict[Key, list[Row]] = {}
        for path in [*([self.path] if self.path.exists() else []), *self._parts()]:
            fresh: dict[Key, list[Row]] = {}
            for row in _read(path):
                fresh.setdefault(key_of(row), []).append(row)
            found |= fresh
        return found

    def add(self, rows: Sequence[Row]) -> None:
        """The rows of one voyage, whole or not at all."""
        name = hashlib.sha256(repr(key_of(rows[0])).encode()).hexdigest()
        _write(self.folder / PARTS / f"{name}.parquet", rows)

    def gather(self) -> None:
        """Put the parts with the rest; a stop in between loses nothing and doubles nothing."""
        if parts := self._parts():
            _write(self.path, [row for rows in self.rows().values() for row in rows])
            for path in parts:
                path.unlink()

    def _parts(self) -> list[Path]:
        return sorted((self.folder / PARTS).glob("*.parquet"))


def lasting(rows: Sequence[Row]) -> bool:
    """Whether an answer holds until something changes: a diagnosis, or a voyage that cannot be used."""
    return bool(rows) and rows[0]["voyage_sha256"] is not None and rows[0]["failed_as"] in LASTING_FAILURES


def _read(path: Path) -> list[Row]:
    try:
        return [dict.fromkeys(SCHEMA.names) | row for row in pq.read_table(path).to_pylist()]
    except (pa.ArrowException, OSError) as error:
        raise DataError(
            f"{path}: cannot be read as Parquet ({' '.join(str(error).split())[:120]}). Move it away, and "
            "the voyages are asked again."
        ) from None


def _write(path: Path, rows: Sequence[Row]) -> None:
    aside = path.with_name(f".{path.name}")
    try:
        pq.write_table(pa.Table.from_pylist(list(rows), SCHEMA), aside)
        with open(aside, "rb") as file:
            os.fsync(file.fileno())
        os.replace(aside, path)
    except OSError as error:
        with suppress(OSError):
            aside.unlink()
        raise _cannot(path, error) from None


def _cannot(path: object, error: OSError) -> TwinError:
    return TwinError(f"{path}: cannot be written ({error.strerror or error}). Choose another folder with -o.")

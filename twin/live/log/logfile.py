"""A log written or read in one go: what import and replay write, and what everybody reads."""

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from twin.errors import TwinError
from twin.live.keelson.messages import schema_bytes
from twin.live.keelson.schema import descriptor_set
from twin.live.log.mcap_read import McapReader, Message
from twin.live.log.mcap_write import McapWriter

if TYPE_CHECKING:
    import numpy as np


class LogFile:
    """A log written in one go: aside first, renamed when whole, gone when something fails.

    The same messages and the same words about them give the same bytes: no clock and no random number is in
    it.
    """

    def __init__(self, path: str | Path, classes: dict[str, Any] | None = None):
        """`classes`: by type name those that are not the usual ones (a row with the ship's actuators)."""
        self.path, self._classes = Path(path), {} if classes is None else classes
        self._aside = self.path.with_name(f".{self.path.name}.{os.getpid()}.part")

    def __enter__(self) -> "LogFile":
        if self.path.exists() and not self.path.is_file():  # a device or a pipe: the rename would replace it
            raise TwinError(f"{self.path}: is no file that a log could stand in. Give the name of a file.")
        try:
            self._stream = open(self._aside, "wb")
        except OSError as failure:
            raise self._error(failure) from None
        self._writer = McapWriter(self._stream.write)
        self._writer.start()
        return self

    def add(
        self, topic: str, type_name: str, payload: bytes, log_ns: int, publish_ns: int | None = None
    ) -> None:
        """One message without its envelope; times are nanoseconds since 1970."""
        channel = self._writer.channel(topic, type_name, self._schema)
        try:
            self._writer.add(channel, payload, log_ns, log_ns if publish_ns is None else publish_ns)
        except OSError as failure:
            raise self._error(failure) from None

    def _schema(self, type_name: str) -> bytes:
        own = self._classes.get(type_name)
        return schema_bytes(type_name) if own is None else descriptor_set(own)

    def describe(self, name: str, values: dict[str, str]) -> None:
        """A named table of words about the file (MCAP metadata)."""
        try:
            self._writer.metadata(name, values)
        except OSError as failure:
            raise self._error(failure) from None

    def __exit__(self, kind: Any, *_: object) -> None:
        try:
            if kind is None:
                self._writer.finish()
                self._stream.flush()
                os.fsync(self._stream.fileno())
                os.replace(self._aside, self.path)
        except OSError as failure:
            raise self._error(failure) from None
        finally:
            self._stream.close()
            with suppress(OSError):
                self._aside.unlink()

    def _error(self, failure: OSError) -> TwinError:
        return TwinError(f"{self.path}: cannot be written ({failure.strerror}). Nothing was left behind.")


def read(path: str | Path, notes: list[str] | None = None) -> Iterator[Message]:
    """The messages of a log in file order; what is damaged is left out and said in `notes`."""
    reader = McapReader(path)
    yield from reader.messages()
    if notes is not None:
        notes += reader.problems


def read_rows(path: str | Path, notes: list[str] | None = None) -> "tuple[np.ndarray, dict[str, np.ndarray]]":
    """(time_s (N,), {channel: (N,)}) of a log, NaN where nothing was measured; see `log_rows.read_rows`. Time
    in [s], channels in the unit in their name."""
    from twin.live.log.log_rows import read_rows as rows

    return rows(path, notes)

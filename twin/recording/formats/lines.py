"""The lines of a log that may be large, packed or damaged: bytes, with their numbers, never an endless
one."""

import gzip
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Any, TypeVar

from twin.errors import DataError

LONGEST = 1 << 20  # bytes of one line; what is longer is no line of a log
HEAD = 1 << 14
T = TypeVar("T")


class Unpacked(gzip.GzipFile):
    """What a .gz holds; where it is damaged or cut off, a DataError says so."""

    def read(self, size: int | None = -1) -> bytes:
        """Up to so many bytes, unpacked."""
        return self._whole(super().read, size)

    def read1(self, size: int = -1) -> bytes:
        """Up to so many bytes of one reading, unpacked."""
        return self._whole(super().read1, size)

    def readline(self, size: int | None = -1) -> bytes:  # type: ignore[override]
        """The next line, or so many bytes of it, unpacked."""
        return self._whole(super().readline, size)

    def _whole(self, read: Callable[[Any], T], size: int | None) -> T:
        try:
            return read(size)
        except (OSError, EOFError, zlib.error) as error:
            raise DataError(f"{self.name}: is damaged: {error}. Copy it again.") from None


def opened(path: Path) -> IO[bytes]:
    """The file for reading, unpacked when it ends in .gz. DataError: it cannot be opened."""
    try:
        return Unpacked(path, "rb") if path.suffix.lower() == ".gz" else open(path, "rb")  # type: ignore[return-value]
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}.") from None


def numbered(path: Path) -> Iterator[tuple[int, bytes]]:
    """(number from 1, line) of a file; a line longer than LONGEST comes in pieces. DataError: what is
    packed is damaged."""
    with opened(path) as stream:
        try:
            yield from enumerate(iter(lambda: stream.readline(LONGEST), b""), 1)
        except (OSError, EOFError) as error:
            raise DataError(f"{path}: is damaged: {error}. Copy it again.") from None


def head(path: Path) -> bytes:
    """The first bytes, unpacked."""
    with opened(path) as stream:
        try:
            return stream.read(HEAD)
        except (OSError, EOFError):
            return b""


def head_lines(start: bytes) -> list[str]:
    """The whole lines among the first bytes."""
    lines = start.decode("latin-1").splitlines()
    return [s.strip() for s in (lines[:-1] if len(start) >= HEAD else lines) if s.strip()]

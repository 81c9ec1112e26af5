"""The lines of a log that may be large, packed or damaged: bytes, with their numbers, never an endless
one."""

import gzip
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from twin.errors import DataError

LONGEST = 1 << 20  # bytes of one line; what is longer is no line of a log
HEAD = 1 << 14


def opened(path: Path) -> IO[bytes]:
    """The file for reading, unpacked when it ends in .gz."""
    try:
        return gzip.open(path, "rb") if path.suffix.lower() == ".gz" else open(path, "rb")  # type: ignore[return-value]
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}.") from None


def numbered(path: Path) -> Iterator[tuple[int, bytes]]:
    """(number from 1, line) of a file; a line longer than LONGEST comes in pieces."""
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

"""A number that two processes share: up to which time the feed has spoken. The loop's clock reads it."""

import mmap
import struct
from pathlib import Path

NUMBER = struct.Struct("d")  # [s since 1970]


class Mark:
    """Mapped from a file that `new` made."""

    def __init__(self, path: str | Path):
        with open(path, "r+b") as file:
            self._map = mmap.mmap(file.fileno(), NUMBER.size)

    def write(self, wall_s: float) -> None:
        NUMBER.pack_into(self._map, 0, wall_s)

    def read(self) -> float:
        return float(NUMBER.unpack_from(self._map)[0])


def new(rows: Path) -> Path:
    """The file of the mark beside a voyage's rows, set back to nothing."""
    path = rows.with_suffix(".mark")
    path.write_bytes(bytes(NUMBER.size))
    return path

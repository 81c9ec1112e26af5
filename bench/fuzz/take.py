"""Bytes as decisions: the same bytes are the same run, with the fuzzer and without it."""

import struct
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class Take:
    """Bytes taken from the front; when there are none left everything is 0."""

    def __init__(self, data: bytes):
        self._data, self._at = data, 0

    def __bool__(self) -> bool:
        return self._at < len(self._data)

    def bytes(self, count: int) -> bytes:
        taken = self._data[self._at : self._at + count]
        self._at += count
        return taken

    def rest(self) -> bytes:
        return self.bytes(len(self._data))

    def byte(self) -> int:
        return (self.bytes(1) or b"\0")[0]

    def short(self) -> int:
        return int.from_bytes(self.bytes(2), "little")

    def number(self) -> float:
        """Any double: infinities and NaN, too."""
        return float(struct.unpack("<d", self.bytes(8).ljust(8, b"\0"))[0])

    def share(self) -> float:
        """0 to 1 in steps of 1/65535."""
        return self.short() / 65535.0

    def one_of(self, choices: Sequence[T]) -> T:
        return choices[self.byte() % len(choices)]

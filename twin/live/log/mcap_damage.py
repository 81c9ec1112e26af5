"""What a damaged log lost: which place of the file, and between which of its moments."""

from struct import Struct
from typing import NamedTuple

from twin.num import as_given

EXTENT = "shiptwin.extent"  # table of words: how far a log reached when it was written in one go
# table of words: a crash cut the log off, and what was whole of it was finished
REPAIRED = "shiptwin.repaired"
# messages, schemas, channels, attachments, metadata, chunks, first and last log time
_STATISTICS = Struct("<QHIIIIQQ")


class Damage(NamedTuple):
    """One place that cannot be read; times are log times [ns], None where the file does not tell."""

    what: str
    after_ns: int | None  # the last message before it
    before_ns: int | None = None  # the first one behind it; nothing is behind it when None

    def text(self, first_ns: int | None, last_ns: int | None) -> str:
        """In words, in seconds since the log's first message; `last_ns`: where the log ended before it was
        damaged, if that is known."""
        start = (self.after_ns if self.after_ns is not None else first_ns) or 0
        first = first_ns if first_ns is not None else start
        begin_s = (start - first) * 1e-9
        if self.before_ns is not None:
            end_s = (self.before_ns - first) * 1e-9
            return (
                f"{self.what}: {as_given(end_s - begin_s, 4)} s are lost, from {as_given(begin_s, 6)} to "
                f"{as_given(end_s, 6)} s"
            )
        if last_ns is None:
            return f"{self.what}: what followed after {as_given(begin_s, 6)} s is lost"
        if last_ns <= start:
            return f"{self.what}: its last message, at {as_given(begin_s, 6)} s, is there"
        return (
            f"{self.what}: {as_given((last_ns - start) * 1e-9, 4)} s are lost, from {as_given(begin_s, 6)} s "
            f"to the end at {as_given((last_ns - first) * 1e-9, 6)} s"
        )


def extent(first_ns: int, last_ns: int) -> dict[str, str]:
    """The table for `EXTENT`."""
    return {"first_ns": str(first_ns), "last_ns": str(last_ns)}


def last_of(table: dict[str, str]) -> int | None:
    """`last_ns` of that table, if it holds one."""
    word = table.get("last_ns", "")
    return int(word) if word.isdecimal() and len(word) < 20 else None


def last_of_statistics(content: bytes) -> int | None:
    """The last log time [ns] that an MCAP statistics record tells of."""
    return _STATISTICS.unpack_from(content)[7] or None if len(content) >= _STATISTICS.size else None


def repaired(lost_bytes: int) -> dict[str, str]:
    """The table for `REPAIRED`."""
    return {"lost_bytes": str(lost_bytes)}

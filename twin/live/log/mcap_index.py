"""The MCAP format: its records, and the index at the end of a file by which a reader finds its way.

Specification: https://mcap.dev/spec.
"""

from struct import Struct, pack
from typing import NamedTuple
from zlib import crc32

from twin.physics.maths import total

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
ATTACHMENT, ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = range(9, 16)
HEAD = Struct("<BQ")  # opcode, length
PROVENANCE = "shiptwin.provenance"  # the table of words that says who wrote a file, and with what


def record(opcode: int, *parts: bytes) -> bytes:
    """A record: its opcode, its length and its parts."""
    content = b"".join(parts)
    return HEAD.pack(opcode, len(content)) + content


def text(value: str) -> bytes:
    """A text with its length in front."""
    data = value.encode()
    return pack("<I", len(data)) + data


def text_map(values: dict[str, str]) -> bytes:
    """A table of texts, with its length in bytes in front."""
    data = b"".join(text(k) + text(v) for k, v in values.items())
    return pack("<I", len(data)) + data


def number_map(values: dict[int, int]) -> bytes:
    """A table of numbers, with its length in bytes in front."""
    data = b"".join(pack("<HQ", k, v) for k, v in values.items())
    return pack("<I", len(data)) + data


class ChunkInfo(NamedTuple):
    """What the index at the end says of one chunk."""

    start_ns: int
    end_ns: int
    offset: int
    length: int
    index_offsets: dict[int, int]
    index_length: int
    compressed: int
    uncompressed: int


class IndexSummary:
    """What a finished file says at its end; built while writing, or when a crashed file is repaired."""

    def __init__(self) -> None:
        self.schemas: dict[int, bytes] = {}  # id -> whole record
        self.channels: dict[int, bytes] = {}
        self.chunks = 0
        self.first_ns = self.last_ns = 0
        # records as they will be written: four chunks a second must not fill the memory
        self._chunk_index = bytearray()
        self.counts: dict[int, int] = {}
        self.metadata: list[tuple[int, int, str]] = []  # offset, length, name

    def add(self, chunk: ChunkInfo) -> None:
        """One more chunk is in the file."""
        self._chunk_index += _chunk_index(chunk)
        self.first_ns = min(self.first_ns, chunk.start_ns) if self.chunks else chunk.start_ns
        self.last_ns = max(self.last_ns, chunk.end_ns)
        self.chunks += 1

    def tail(self, offset: int) -> bytes:
        """DataEnd, summary, footer and magic, for a data section that ends at `offset`."""
        end = record(DATA_END, pack("<I", 0))
        start = offset + len(end)
        body, offsets = b"", b""
        for opcode, group in self._groups():
            if group:
                offsets += record(SUMMARY_OFFSET, pack("<BQQ", opcode, start + len(body), len(group)))
                body += group
        summary_start = start if body else 0
        footer = HEAD.pack(FOOTER, 20) + pack("<QQ", summary_start, start + len(body))
        checksum = crc32(footer, crc32(body + offsets))
        return end + body + offsets + footer + pack("<I", checksum) + MAGIC

    def _groups(self) -> list[tuple[int, bytes]]:
        return [
            (SCHEMA, b"".join(self.schemas.values())),
            (CHANNEL, b"".join(self.channels.values())),
            (STATISTICS, self._statistics()),
            (CHUNK_INDEX, bytes(self._chunk_index)),
            (METADATA_INDEX, b"".join(_metadata_index(*entry) for entry in self.metadata)),
        ]

    def _statistics(self) -> bytes:
        sizes = (len(self.schemas), len(self.channels), 0, len(self.metadata), self.chunks)
        messages = total(self.counts.values())
        return record(
            STATISTICS,
            pack("<QHIIIIQQ", messages, *sizes, self.first_ns, self.last_ns),
            number_map(self.counts),
        )


def message_indexes(entries: dict[int, list[tuple[int, int]]], offset: int) -> tuple[bytes, dict[int, int]]:
    """The index records behind a chunk, {channel: [(log time, place in chunk)]}, and where each starts."""
    data, offsets = b"", {}
    for channel, rows in entries.items():
        offsets[channel] = offset + len(data)
        body = b"".join(pack("<QQ", *row) for row in rows)
        data += record(MESSAGE_INDEX, pack("<HI", channel, len(body)), body)
    return data, offsets


def _chunk_index(chunk: ChunkInfo) -> bytes:
    return record(
        CHUNK_INDEX,
        pack("<QQQQ", chunk.start_ns, chunk.end_ns, chunk.offset, chunk.length),
        number_map(chunk.index_offsets),
        pack("<Q", chunk.index_length),
        text("zstd"),
        pack("<QQ", chunk.compressed, chunk.uncompressed),
    )


def _metadata_index(offset: int, length: int, name: str) -> bytes:
    return record(METADATA_INDEX, pack("<QQ", offset, length), text(name))

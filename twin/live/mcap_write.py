"""The MCAP format, the writing half: messages in chunks, each chunk one write, and an index at the end.

Written here and not taken from the `mcap` package because the log must survive a full disk (a chunk is
written whole or not at all, and may be tried again), give the same bytes for the same messages, and cost 2 MB
and not 9 (that package loads `importlib.metadata`, lz4 and dataclasses). Specification:
https://mcap.dev/spec. The tests read every file back with the `mcap` package.
"""

from collections.abc import Callable
from struct import Struct, pack
from typing import NamedTuple
from zlib import crc32

MAGIC = b"\x89MCAP0\r\n"
LIBRARY = "shiptwin"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
ATTACHMENT, ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = range(9, 16)
HEAD = Struct("<BQ")  # opcode, length
MESSAGE_HEAD = Struct("<BQHIQQ")  # opcode, length, channel, sequence, log time, publish time
CHUNK_BYTES = 256 * 1024
Compress = Callable[[bytes], bytes]


def record(opcode: int, *parts: bytes) -> bytes:
    content = b"".join(parts)
    return HEAD.pack(opcode, len(content)) + content


def text(value: str) -> bytes:
    data = value.encode()
    return pack("<I", len(data)) + data


def text_map(values: dict[str, str]) -> bytes:
    data = b"".join(text(k) + text(v) for k, v in values.items())
    return pack("<I", len(data)) + data


def number_map(values: dict[int, int]) -> bytes:
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


class Summary:
    """What a finished file says at its end; built while writing, or when a crashed file is repaired."""

    def __init__(self) -> None:
        self.schemas: dict[int, bytes] = {}  # id -> whole record
        self.channels: dict[int, bytes] = {}
        self.chunks: list[ChunkInfo] = []
        self.counts: dict[int, int] = {}
        self.metadata: list[tuple[int, int, str]] = []  # offset, length, name

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
            (CHUNK_INDEX, b"".join(_chunk_index(chunk) for chunk in self.chunks)),
            (METADATA_INDEX, b"".join(_metadata_index(*entry) for entry in self.metadata)),
        ]

    def _statistics(self) -> bytes:
        first = min((chunk.start_ns for chunk in self.chunks), default=0)
        last = max((chunk.end_ns for chunk in self.chunks), default=0)
        sizes = (len(self.schemas), len(self.channels), 0, len(self.metadata), len(self.chunks))
        total = sum(self.counts.values())
        return record(STATISTICS, pack("<QHIIIIQQ", total, *sizes, first, last), number_map(self.counts))


def message_indexes(entries: dict[int, list[tuple[int, int]]], offset: int) -> tuple[bytes, dict[int, int]]:
    """The index records behind a chunk, {channel: [(log time, place in chunk)]}, and where each starts."""
    data, offsets = b"", {}
    for channel, rows in entries.items():
        offsets[channel] = offset + len(data)
        body = b"".join(pack("<QQ", *row) for row in rows)
        data += record(MESSAGE_INDEX, pack("<HI", channel, len(body)), body)
    return data, offsets


class OpenChunk:
    """Records not yet written, `index` {channel: [(log time, place in chunk)]}, and the schemas new in it."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.index: dict[int, list[tuple[int, int]]] = {}
        self.schemas: dict[int, bytes] = {}
        self.size = self.messages = 0
        self.start_ns, self.end_ns = 2**63, 0

    def append(self, *data: bytes) -> None:
        self.parts += data
        self.size += sum(map(len, data))

    def message(self, channel: int, data: bytes, log_ns: int, publish_ns: int) -> None:
        self.index[channel].append((log_ns, self.size))
        self.append(MESSAGE_HEAD.pack(MESSAGE, 22 + len(data), channel, 0, log_ns, publish_ns), data)
        self.start_ns, self.end_ns = min(self.start_ns, log_ns), max(self.end_ns, log_ns)
        self.messages += 1


class McapWriter:
    """Messages in, whole chunks out through `sink(bytes)`; when that fails, the chunk stays pending."""

    def __init__(self, sink: Callable[[bytes], object], compress: Compress | None = None):
        self._sink = sink
        self._compress = compress or zstd()
        self.offset = 0
        self.summary = Summary()
        self._chunk = OpenChunk()
        self._channel_ids: dict[tuple[str, str], int] = {}
        self._schema_ids: dict[str, int] = {}
        self._channels: dict[int, tuple[int, bytes]] = {}  # id -> schema id, record
        self._schemas: dict[int, bytes] = {}

    @property
    def pending(self) -> int:
        """Messages of the chunk in progress."""
        return self._chunk.messages

    def start(self) -> None:
        """Writes what every MCAP file begins with."""
        self._emit(MAGIC + record(HEADER, text(""), text(LIBRARY)))

    def channel(self, topic: str, type_name: str, schema: Callable[[str], bytes]) -> int:
        """The id of a topic's channel; `schema(type_name)` gives the FileDescriptorSet when it is new."""
        found = self._channel_ids.get((topic, type_name))
        if found is not None:
            return found
        schema_id = self._schema_ids.get(type_name)
        if schema_id is None:
            schema_id = self._schema_ids[type_name] = len(self._schema_ids) + 1
            self._schemas[schema_id] = _schema(schema_id, type_name, schema(type_name))
        channel = self._channel_ids[(topic, type_name)] = len(self._channel_ids) + 1
        ids = pack("<HH", channel, schema_id)
        self._channels[channel] = (
            schema_id,
            record(CHANNEL, ids, text(topic), text("protobuf"), text_map({})),
        )
        return channel

    def add(self, channel: int, data: bytes, log_ns: int, publish_ns: int) -> None:
        """One message; times are nanoseconds since 1970. Writes the chunk when it is full."""
        if channel not in self._chunk.index:
            self._introduce(channel)
        self._chunk.message(channel, data, log_ns, publish_ns)
        if self._chunk.size >= CHUNK_BYTES:
            self.flush()

    def flush(self) -> None:
        """Writes the chunk in progress, whole; on OSError it stays pending."""
        chunk = self._chunk
        if not chunk.messages:
            return
        raw = b"".join(chunk.parts)
        data = self._compress(raw)
        head = pack("<QQQI", chunk.start_ns, chunk.end_ns, len(raw), crc32(raw)) + text("zstd")
        whole = record(CHUNK, head, pack("<Q", len(data)), data)
        indexes, places = message_indexes(chunk.index, self.offset + len(whole))
        times = (chunk.start_ns, chunk.end_ns)
        info = ChunkInfo(*times, self.offset, len(whole), places, len(indexes), len(data), len(raw))
        self._emit(whole + indexes)
        self._commit(info)

    def discard(self) -> int:
        """Forgets the chunk in progress (the disk is full); returns how many messages were in it."""
        lost, self._chunk = self._chunk.messages, OpenChunk()
        return lost

    def metadata(self, name: str, values: dict[str, str]) -> None:
        """A named table of words about the file."""
        self.flush()
        data = record(METADATA, text(name), text_map(values))
        entry = (self.offset, len(data), name)
        self._emit(data)
        self.summary.metadata.append(entry)

    def finish(self) -> None:
        """Writes the last chunk and the index."""
        self.flush()
        self._emit(self.summary.tail(self.offset))

    def _introduce(self, channel: int) -> None:
        """Puts a channel's record, and its schema's, into the chunk unless a written chunk has them."""
        chunk = self._chunk
        chunk.index[channel] = []
        if channel in self.summary.channels:
            return
        schema_id, channel_record = self._channels[channel]
        if schema_id not in self.summary.schemas and schema_id not in chunk.schemas:
            chunk.schemas[schema_id] = self._schemas[schema_id]
            chunk.append(self._schemas[schema_id])
        chunk.append(channel_record)

    def _commit(self, info: ChunkInfo) -> None:
        chunk, summary = self._chunk, self.summary
        summary.chunks.append(info)
        summary.schemas.update(chunk.schemas)
        for channel, rows in chunk.index.items():
            summary.channels.setdefault(channel, self._channels[channel][1])
            summary.counts[channel] = summary.counts.get(channel, 0) + len(rows)
        self._chunk = OpenChunk()

    def _emit(self, data: bytes) -> None:
        self._sink(data)
        self.offset += len(data)


def _schema(schema_id: int, name: str, data: bytes) -> bytes:
    return record(SCHEMA, pack("<H", schema_id), text(name), text("protobuf"), pack("<I", len(data)), data)


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


def zstd() -> Compress:
    """The compressor; its library is loaded here and not before (2 MB)."""
    import zstandard

    return zstandard.ZstdCompressor(level=1, threads=0).compress

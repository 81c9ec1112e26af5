"""The MCAP format, the writing half: messages in chunks, each chunk one write, and an index at the end.

Written here and not taken from the `mcap` package because the log must survive a full disk (a chunk is
written whole or not at all, and may be tried again), give the same bytes for the same messages, and cost 2 MB
and not 9 (that package loads `importlib.metadata`, lz4 and dataclasses). Specification:
https://mcap.dev/spec. The tests read every file back with the `mcap` package.
"""

from collections.abc import Callable
from struct import Struct, pack
from zlib import crc32

from twin.live.log.mcap_index import (
    CHANNEL,
    CHUNK,
    HEADER,
    MAGIC,
    MESSAGE,
    METADATA,
    SCHEMA,
    ChunkInfo,
    IndexSummary,
    message_indexes,
    record,
    text,
    text_map,
)
from twin.physics.maths import total

LIBRARY = "shiptwin"
MESSAGE_HEAD = Struct("<BQHIQQ")  # opcode, length, channel, sequence, log time, publish time
CHUNK_BYTES = 64 * 1024
Compress = Callable[[bytes], bytes]


class OpenChunk:
    """Records not yet written, `index` {channel: [(log time, place in chunk)]}, and the schemas new in it."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.index: dict[int, list[tuple[int, int]]] = {}
        self.schemas: dict[int, bytes] = {}
        self.size = self.messages = 0
        self.start_ns, self.end_ns = 2**63, 0

    def append(self, *data: bytes) -> None:
        """More bytes."""
        self.parts += data
        self.size += total(map(len, data))

    def message(self, channel: int, data: bytes, log_ns: int, publish_ns: int) -> None:
        """One message, entered in the index of its channel."""
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
        self.summary = IndexSummary()
        self._chunk = OpenChunk()
        self._channel_ids: dict[tuple[str, str], int] = {}
        self._schema_ids: dict[str, int] = {}
        self._channels: dict[int, tuple[int, bytes]] = {}  # id -> schema id, record
        self._schemas: dict[int, bytes] = {}

    @property
    def channels(self) -> int:
        """Topics met so far."""
        return len(self._channel_ids)

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
        summary.add(info)
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


def zstd() -> Compress:
    """The compressor; its library is loaded here and not before (2 MB)."""
    import zstandard

    parameters = zstandard.ZstdCompressionParameters.from_level(1, source_size=CHUNK_BYTES)
    return zstandard.ZstdCompressor(compression_params=parameters).compress

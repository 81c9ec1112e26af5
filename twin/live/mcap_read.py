"""The MCAP format, the reading half: messages in file order, checksums checked, damage named and left out.

A file that a crash cut short gives all its whole chunks; a chunk that rotted is left out. `problems` says so
in words. Nothing a file claims is believed before it is bounded: a length never exceeds what is left of the
file, a chunk never unpacks to more than MAX_CHUNK.
"""

from collections.abc import Iterator
from contextlib import suppress
from os import SEEK_END
from pathlib import Path
from struct import Struct, error, unpack_from
from typing import IO, NamedTuple
from zlib import crc32

from twin.errors import DataError
from twin.live.mcap_write import CHANNEL, CHUNK, DATA_END, HEAD, MAGIC, MESSAGE, METADATA, SCHEMA

MAX_CHUNK = MAX_RECORD = 256 * 1024 * 1024  # bytes, unpacked and packed
_MESSAGE = Struct("<HIQQ")


class Broken(DataError):
    """A place in a file that cannot be read."""


class Message(NamedTuple):
    """One logged message; the times are nanoseconds since 1970."""

    topic: str
    type_name: str
    data: bytes
    log_ns: int
    publish_ns: int


class McapReader:
    """A log file opened for one pass; `schemas` {type name: FileDescriptorSet} fills while reading."""

    def __init__(self, path: str | Path):
        self.path = Path(path)
        self.problems: list[str] = []
        self.schemas: dict[str, bytes] = {}
        self.metadata: dict[str, dict[str, str]] = {}
        self._schema_names: dict[int, str] = {}
        self._channels: dict[int, tuple[str, str]] = {}

    def messages(self) -> Iterator[Message]:
        """All messages that can be read, in file order; a DataError when a damaged file gives none."""
        found = False
        with open_log(self.path) as stream:
            self._summary(stream)
            for message in self._all(stream):
                found = True
                yield message
        if self.problems and not found:
            raise DataError(f"{self.path}: nothing in it can be read: {self.problems[0]}.")

    def _all(self, stream: IO[bytes]) -> Iterator[Message]:
        finished = False
        try:
            for opcode, offset, content in records(stream):
                finished = opcode == DATA_END
                if finished:
                    break
                yield from self._record(opcode, offset, content)
        except Broken as damage:
            self.problems.append(str(damage))
            return
        if not (finished and ends_well(stream)):
            self.problems.append(
                "it ends without its index: the recorder was cut off, the last half second may be missing"
            )

    def _summary(self, stream: IO[bytes]) -> None:
        """Schemas and channels as the index at the end repeats them, should the first chunk be damaged."""
        here = stream.tell()
        if ends_well(stream):
            stream.seek(-28, SEEK_END)
            start = unpack_from("<Q", stream.read(8))[0]
            stream.seek(start or here)
            with suppress(Broken, error, UnicodeDecodeError):
                for opcode, _, content in records(stream) if start else ():
                    if opcode in (SCHEMA, CHANNEL):
                        self._describe(opcode, content)
        stream.seek(here)

    def _record(self, opcode: int, offset: int, content: bytes) -> Iterator[Message]:
        try:
            if opcode == CHUNK:
                yield from self._chunk(unpacked(content))
            elif opcode == METADATA:
                name, at = string(content, 0)
                self.metadata[name] = string_map(content, at)[0]
            else:
                yield from self._chunk(HEAD.pack(opcode, len(content)) + content)
        except (Broken, error, UnicodeDecodeError) as damage:
            self.problems.append(f"the chunk at byte {offset} is damaged and left out ({damage})")

    def _chunk(self, data: bytes) -> list[Message]:
        """The messages among a chunk's records; schemas and channels are remembered."""
        messages: list[Message] = []
        at, size = 0, len(data)
        while at < size:
            opcode, length = HEAD.unpack_from(data, at)
            at += 9
            end = at + length
            if end > size:
                raise Broken(f"a record of {length} bytes, {size - at} are left")
            if opcode == MESSAGE:
                channel, _, log_ns, publish_ns = _MESSAGE.unpack_from(data, at)
                if channel not in self._channels:
                    raise Broken(f"a message of channel {channel}, which nothing describes")
                topic, name = self._channels[channel]
                messages.append(Message(topic, name, data[at + 22 : end], log_ns, publish_ns))
            elif opcode in (SCHEMA, CHANNEL):
                self._describe(opcode, data[at:end])
            at = end
        return messages

    def _describe(self, opcode: int, content: bytes) -> None:
        if opcode == SCHEMA:
            name, at = string(content, 2)
            _, at = string(content, at)
            self._schema_names[unpack_from("<H", content)[0]] = name
            self.schemas[name] = content[at + 4 :]
        else:
            channel, schema = unpack_from("<HH", content)
            self._channels[channel] = (string(content, 4)[0], self._schema_names.get(schema, ""))


def open_log(path: Path) -> IO[bytes]:
    """The file, placed behind its first eight bytes, which must be MCAP's."""
    try:
        stream = open(path, "rb")  # noqa: SIM115 (the caller closes it)
    except OSError as failure:
        raise DataError(f"{path}: cannot be opened ({failure.strerror}).") from None
    try:
        start = stream.read(8)
    except OSError as failure:
        stream.close()
        raise DataError(f"{path}: cannot be read ({failure.strerror}).") from None
    if start != MAGIC:
        stream.close()
        what = "it is empty" if not start else f"it begins with {start!r}"
        raise DataError(
            f"{path}: not an MCAP log ({what}). Give a .mcap file, or use 'twin import' for a table."
        )
    return stream


def records(stream: IO[bytes]) -> Iterator[tuple[int, int, bytes]]:
    """(opcode, offset, content) of each top-level record from here on; Broken where the file breaks off."""
    here = stream.tell()
    size = stream.seek(0, SEEK_END)
    stream.seek(here)
    while here < size:
        head = stream.read(9)
        if len(head) < 9:
            raise Broken(f"it breaks off at byte {here}")
        opcode, length = HEAD.unpack(head)
        if length > min(size - here - 9, MAX_RECORD):
            raise Broken(
                f"it breaks off at byte {here}: a record of {length} bytes, {size - here - 9} are left"
            )
        if not 1 <= opcode <= DATA_END:
            raise Broken(f"no MCAP record begins at byte {here} (opcode {opcode})")
        yield opcode, here, stream.read(length)
        here += 9 + length


def unpacked(content: bytes) -> bytes:
    """The records inside a chunk; Broken when it does not unpack to what it says."""
    size, checksum = unpack_from("<QI", content, 16)
    compression, at = string(content, 28)
    length = unpack_from("<Q", content, at)[0]
    data = content[at + 8 :]
    if length != len(data) or size > MAX_CHUNK:
        raise Broken(f"it claims {length} bytes packed and {size} unpacked")
    raw = _decompress(compression, data, size)
    if len(raw) != size or (checksum and crc32(raw) != checksum):
        raise Broken("its checksum does not fit")
    return raw


def _decompress(compression: str, data: bytes, size: int) -> bytes:
    if not compression:
        return data
    try:
        if compression == "zstd":
            import zstandard

            with zstandard.ZstdDecompressor().stream_reader(data) as reader:
                return reader.read(size + 1) if size else b""
        if compression == "lz4":
            import lz4.frame

            return lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size + 1)
    except ImportError:
        raise Broken(f"its compression {compression!r} needs a package that is not installed") from None
    except Exception as failure:  # the libraries raise their own kinds, one even RuntimeError
        raise Broken(f"{compression}: {failure}") from None
    raise Broken(f"its compression {compression!r} is not known")


def ends_well(stream: IO[bytes]) -> bool:
    """Whether the file ends with a footer and MCAP's last eight bytes."""
    size = stream.seek(0, SEEK_END)
    if size < 45:
        return False
    stream.seek(size - 37)
    tail = stream.read(37)
    return tail[-8:] == MAGIC and tail[:9] == HEAD.pack(2, 20)


def string(data: bytes, at: int) -> tuple[str, int]:
    """A length-prefixed text and the place behind it."""
    length = unpack_from("<I", data, at)[0]
    end = at + 4 + length
    if end > len(data):
        raise Broken(f"a text of {length} bytes, {len(data) - at - 4} are left")
    return data[at + 4 : end].decode(), end


def string_map(data: bytes, at: int) -> tuple[dict[str, str], int]:
    """A table of texts and the place behind it."""
    end = at + 4 + unpack_from("<I", data, at)[0]
    at += 4
    values: dict[str, str] = {}
    while at < min(end, len(data)):
        key, at = string(data, at)
        values[key], at = string(data, at)
    return values, end

"""An MCAP log read from end to end: messages in file order, checksums checked, damage named and left out.

A file that a crash cut short gives all its whole chunks; a chunk that rotted is left out.
`problems` says so in words.
"""

from collections.abc import Iterator
from contextlib import suppress
from os import SEEK_END
from pathlib import Path
from struct import Struct, error, unpack_from
from typing import IO, NamedTuple

from twin.errors import DataError
from twin.live.log.mcap_index import CHANNEL, CHUNK, DATA_END, HEAD, MESSAGE, METADATA, SCHEMA
from twin.live.log.mcap_parse import Broken, ends_well, open_log, records, string, string_map, unpacked

_MESSAGE = Struct("<HIQQ")  # channel, sequence, log time, publish time


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

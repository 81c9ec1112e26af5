"""An MCAP log read from end to end: messages in file order, checksums checked, damage named and left out.

A file that a crash cut short gives all its whole chunks; a chunk that rotted is left out.
`problems` says so in words, with the seconds that are lost.
"""

from collections.abc import Iterator
from contextlib import suppress
from os import SEEK_END
from pathlib import Path
from struct import Struct, error, unpack_from
from typing import IO, NamedTuple

from twin.errors import DataError
from twin.live.log.mcap_damage import EXTENT, REPAIRED, Damage, last_of, last_of_statistics
from twin.live.log.mcap_index import CHANNEL, CHUNK, DATA_END, HEAD, MESSAGE, METADATA, SCHEMA, STATISTICS
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
        self._damage: list[Damage] = []
        # log time of the first message, of the last one, and of the last one that the index tells of
        self._first_ns: int | None = None
        self._last_ns: int | None = None
        self._end_ns: int | None = None
        self.schemas: dict[str, bytes] = {}
        self.metadata: dict[str, dict[str, str]] = {}
        self._schema_names: dict[int, str] = {}
        self._channels: dict[int, tuple[str, str]] = {}

    @property
    def problems(self) -> list[str]:
        """What is damaged and lost, a sentence each."""
        end_ns = last_of(self.metadata.get(EXTENT, {})) or (
            None if REPAIRED in self.metadata else self._end_ns
        )
        return [d.text(self._first_ns, end_ns) for d in self._damage]

    def messages(self) -> Iterator[Message]:
        """All messages that can be read, in file order; a DataError when a damaged file gives none."""
        with open_log(self.path) as stream:
            self._summary(stream)
            for message in self._all(stream):
                self._met(message.log_ns)
                yield message
        if REPAIRED in self.metadata:
            lost = self.metadata[REPAIRED].get("lost_bytes", "?")
            self._damaged(
                f"its recorder was cut off, and the log was repaired without the {lost} bytes at its end"
            )
        if self.problems and self._last_ns is None:
            raise DataError(f"{self.path}: nothing in it can be read: {self.problems[0]}.")

    def _met(self, log_ns: int) -> None:
        """One more message: what was damaged just before it ended here."""
        if self._first_ns is None:
            self._first_ns = log_ns
        for i in range(len(self._damage) - 1, -1, -1):
            if self._damage[i].before_ns is not None:
                break
            self._damage[i] = self._damage[i]._replace(before_ns=log_ns)
        self._last_ns = log_ns

    def _damaged(self, what: str) -> None:
        self._damage.append(Damage(what, self._last_ns))

    def _all(self, stream: IO[bytes]) -> Iterator[Message]:
        finished = False
        try:
            for opcode, offset, content in records(stream):
                finished = opcode == DATA_END
                if finished:
                    break
                yield from self._record(opcode, offset, content)
        except Broken as damage:
            self._damaged(str(damage))
            return
        if not (finished and ends_well(stream)):
            self._damaged(
                "it ends without its index, the recorder was cut off, and the last half second may be missing"
            )

    def _summary(self, stream: IO[bytes]) -> None:
        """Schemas and channels as the index at the end repeats them, should the first chunk be damaged."""
        here = stream.tell()
        if ends_well(stream):
            stream.seek(-28, SEEK_END)
            start = unpack_from("<Q", stream.read(8))[0]
            inside = here <= start < stream.seek(0, SEEK_END)
            stream.seek(start if inside else here)
            with suppress(Broken, error, UnicodeDecodeError):
                for opcode, _, content in records(stream) if inside else ():
                    if opcode in (SCHEMA, CHANNEL):
                        self._describe(opcode, content)
                    elif opcode == STATISTICS:
                        self._end_ns = last_of_statistics(content)
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
            self._damaged(f"the chunk at byte {offset} is damaged and left out ({damage})")

    def _chunk(self, data: bytes) -> Iterator[Message]:
        """The messages among a chunk's records, once all of them have proved whole; one at a time, for a
        chunk of a few kB may hold millions."""
        for opcode, at, end in _parts(data):
            if opcode == MESSAGE:
                channel = _MESSAGE.unpack_from(data, at)[0]
                if end - at < _MESSAGE.size or channel not in self._channels:
                    raise Broken(f"a message of channel {channel}, which nothing describes")
            elif opcode in (SCHEMA, CHANNEL):
                self._describe(opcode, data[at:end])
        for opcode, at, end in _parts(data):
            if opcode == MESSAGE:
                channel, _, log_ns, publish_ns = _MESSAGE.unpack_from(data, at)
                topic, name = self._channels[channel]
                yield Message(topic, name, data[at + _MESSAGE.size : end], log_ns, publish_ns)

    def _describe(self, opcode: int, content: bytes) -> None:
        if opcode == SCHEMA:
            name, at = string(content, 2)
            _, at = string(content, at)
            self._schema_names[unpack_from("<H", content)[0]] = name
            self.schemas[name] = content[at + 4 :]
        else:
            channel, schema = unpack_from("<HH", content)
            self._channels[channel] = (string(content, 4)[0], self._schema_names.get(schema, ""))


def _parts(data: bytes) -> Iterator[tuple[int, int, int]]:
    """(opcode, begin, end) of each record inside a chunk; Broken when they do not fill it."""
    at, size = 0, len(data)
    while at < size:
        opcode, length = HEAD.unpack_from(data, at)
        at += HEAD.size
        if at + length > size:
            raise Broken(f"a record of {length} bytes, {size - at} are left")
        yield opcode, at, at + length
        at += length

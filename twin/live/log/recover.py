"""A log that a crash left unfinished is finished: cut behind its last whole chunk, its index rebuilt.

Runs on the log folder when the recorder starts. The good part is never touched, so a repair that is itself
cut off is simply done again. A file that another process is writing is left alone (it holds a lock), and so
is one whose name is not this log's (a voyage that is being copied there), and one that no twin wrote: our
chunks hold 64 kB, and what claims far more would fill the memory of the service that starts."""

import fcntl
import os
from pathlib import Path
from struct import error, unpack_from
from typing import IO, NamedTuple

from twin.errors import DataError
from twin.live.log.mcap_damage import REPAIRED, repaired
from twin.live.log.mcap_index import (
    CHANNEL,
    CHUNK,
    DATA_END,
    HEAD,
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
from twin.live.log.mcap_parse import Broken, TooLarge, ends_well, open_log, records, string, unpacked
from twin.live.log.quota import own_files
from twin.physics.maths import total

MAX_BYTES = 1 << 20  # of a record, and of a chunk unpacked: sixteen times what the recorder writes
MAX_CHUNKS = 500_000  # in one file: more than a day's


class Scan(NamedTuple):
    """The good part of a file: where to cut, what to write there before the index, and the index."""

    cut: int
    missing: bytes
    summary: IndexSummary
    ended: bool = False  # whether all data is there, and only the index was cut


def recover_folder(folder: str | Path, name: str = "twin") -> list[str]:
    """Finishes every unfinished file of the log of this name; one sentence for each, of what was kept and
    lost."""
    try:
        files = [file.path for file in own_files(Path(folder), name) if file.path.endswith(".mcap")]
    except OSError:
        return []
    return [said for file in files if (said := recover(file))]


def recover(path: str | Path) -> str:
    """Finishes one log file if it is not; returns what happened in one sentence, or "" when it was whole."""
    path = Path(path)
    try:
        with open(path, "r+b") as stream:
            return _recover(path, stream)
    except OSError as failure:
        return f"{path.name}: not repaired, it cannot be written ({failure.strerror})"


def _recover(path: Path, stream: IO[bytes]) -> str:
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return ""  # somebody is writing it
    if ends_well(stream):
        return ""
    size = stream.seek(0, os.SEEK_END)
    try:
        found = scan(path)
    except TooLarge as failure:
        return f"{path.name}: unfinished and left as it is, no log of the twin's: {failure}"
    except DataError:
        return _set_aside(path, size)
    kept, lost = total(found.summary.counts.values()), size - found.cut
    _finish(stream, found, lost)
    return f"{path.name}: unfinished log repaired, {kept} messages kept, {lost} bytes at the end lost"


def scan(path: Path) -> Scan:
    """Walks a file chunk by chunk as far as it is good; TooLarge when it was not written by a twin.
    DataError: it cannot be read."""
    summary, ended = IndexSummary(), False
    with open_log(path) as stream:
        cut = stream.tell()
        try:
            for opcode, offset, content in records(stream, MAX_BYTES):
                if opcode == DATA_END:
                    ended = True
                    break
                missing = b""
                if opcode == CHUNK:
                    missing = _chunk(summary, offset, content)
                elif opcode == METADATA:
                    summary.metadata.append((offset, 9 + len(content), string(content, 0)[0]))
                elif opcode in (SCHEMA, CHANNEL):
                    _describe(summary, opcode, HEAD.pack(opcode, len(content)) + content)
                cut = offset + 9 + len(content)
                if missing:
                    here = stream.tell()
                    if stream.read(len(missing)) != missing:
                        return Scan(cut, missing, summary)
                    stream.seek(here)
                if summary.chunks > MAX_CHUNKS:
                    raise TooLarge(f"more than {MAX_CHUNKS} chunks")
        except TooLarge:
            raise
        except (Broken, error, UnicodeDecodeError):
            pass
    if cut == 8:
        raise DataError(f"{path}: nothing in it can be read.")
    return Scan(cut, b"", summary, ended)


def _chunk(summary: IndexSummary, offset: int, content: bytes) -> bytes:
    """Adds a verified chunk to the summary; returns the index records that belong behind it."""
    raw = unpacked(content, MAX_BYTES)
    rows: dict[int, list[tuple[int, int]]] = {}
    at = 0
    while at < len(raw):
        opcode, length = HEAD.unpack_from(raw, at)
        if opcode == MESSAGE:
            channel, _, log_ns = unpack_from("<HIQ", raw, at + 9)
            rows.setdefault(channel, []).append((log_ns, at))
        elif opcode in (SCHEMA, CHANNEL):
            _describe(summary, opcode, raw[at : at + 9 + length])
        at += 9 + length
    start_ns, end_ns = unpack_from("<QQ", content)
    length = 9 + len(content)
    indexes, places = message_indexes(rows, offset + length)
    packed = len(content) - 40 - len(string(content, 28)[0])
    summary.add(ChunkInfo(start_ns, end_ns, offset, length, places, len(indexes), packed, len(raw)))
    for channel, entries in rows.items():
        summary.counts[channel] = summary.counts.get(channel, 0) + len(entries)
    return indexes


def _describe(summary: IndexSummary, opcode: int, whole: bytes) -> None:
    group = summary.schemas if opcode == SCHEMA else summary.channels
    group[unpack_from("<H", whole, 9)[0]] = whole


def _finish(stream: IO[bytes], found: Scan, lost: int) -> None:
    """Cuts, writes down that data was lost, and the index; when that fails (disk full) the cut stays and the
    next start tries again."""
    stream.truncate(found.cut)
    stream.seek(found.cut)
    offset = found.cut + len(found.missing)
    said = b"" if found.ended else record(METADATA, text(REPAIRED), text_map(repaired(lost)))
    if said:
        found.summary.metadata.append((offset, len(said), REPAIRED))
    try:
        stream.write(found.missing + said + found.summary.tail(offset + len(said)))
        stream.flush()
        os.fdatasync(stream.fileno())
    except OSError:
        stream.truncate(found.cut)
        raise


def _set_aside(path: Path, size: int) -> str:
    """A file without one readable record is renamed, never deleted."""
    path.rename(path.with_suffix(".unreadable"))
    return f"{path.name}: {size} bytes without one readable record, renamed to {path.stem}.unreadable"

"""The MCAP format taken apart, believing nothing a file claims before it is bounded.

A length never exceeds what is left of the file, and neither a record nor an unpacked chunk more than the
reader
allows: MAX_BYTES ashore, far less on board (`recover.py`).
"""

from collections.abc import Iterator
from os import SEEK_END
from pathlib import Path
from struct import unpack_from
from typing import IO
from zlib import crc32

from twin.errors import DataError
from twin.live.log.mcap_index import DATA_END, HEAD, MAGIC

MAX_BYTES = 64 * 1024 * 1024  # of a record, and of a chunk unpacked; recorders write chunks of 1 to 4 MB
LEAST_WINDOW = 1 << 20  # bytes that a decompressor may always hold


class Broken(DataError):
    """A place in a file that cannot be read."""


class TooLarge(Broken):
    """A record or chunk that may be whole and is larger than this reader takes."""


def open_log(path: Path) -> IO[bytes]:
    """The file, placed behind its first eight bytes, which must be MCAP's. DataError: it cannot be read,
    or is no MCAP."""
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


def records(stream: IO[bytes], most: int = MAX_BYTES) -> Iterator[tuple[int, int, bytes]]:
    """(opcode, offset, content) of each top-level record from here on; Broken where the file breaks off,
    TooLarge at a record of more than `most` bytes."""
    here = stream.tell()
    size = stream.seek(0, SEEK_END)
    stream.seek(here)
    while here < size:
        head = stream.read(9)
        if len(head) < 9:
            raise Broken(f"it breaks off at byte {here}")
        opcode, length = HEAD.unpack(head)
        if length > size - here - 9:
            raise Broken(
                f"it breaks off at byte {here}: a record of {length} bytes, {size - here - 9} are left"
            )
        if length > most:
            raise TooLarge(f"the record at byte {here} has {length} bytes, at most {most} are taken")
        if not 1 <= opcode <= DATA_END:
            raise Broken(f"no MCAP record begins at byte {here} (opcode {opcode})")
        yield opcode, here, stream.read(length)
        here += 9 + length


def unpacked(content: bytes, most: int = MAX_BYTES) -> bytes:
    """The records inside a chunk; Broken when it does not unpack to what it says, TooLarge when that is more
    than `most` bytes."""
    size, checksum = unpack_from("<QI", content, 16)
    compression, at = string(content, 28)
    length = unpack_from("<Q", content, at)[0]
    data = content[at + 8 :]
    if length != len(data):
        raise Broken(f"it claims {length} bytes packed and {size} unpacked")
    if size > most:
        raise TooLarge(f"it unpacks to {size} bytes, at most {most} are taken")
    raw = _decompress(compression, data, size, most)
    if len(raw) != size or (checksum and crc32(raw) != checksum):
        raise Broken("its checksum does not fit")
    return raw


def _decompress(compression: str, data: bytes, size: int, most: int) -> bytes:
    if not compression:
        return data
    try:
        if compression == "zstd":
            import zstandard

            window = max(1 << (most - 1).bit_length(), LEAST_WINDOW)
            with zstandard.ZstdDecompressor(max_window_size=window).stream_reader(data) as reader:
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
    """A length-prefixed text and the place behind it. Broken: it claims to be longer than what is there."""
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

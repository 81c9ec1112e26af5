"""A ship file and the file of its arrays, written so that a kill leaves the old or the new ship.

The arrays come first, under a name that holds their hash; the rename of the ship file is what counts; then
what no ship file names any more is removed. A writer that was killed leaves files aside, or arrays that
nothing names: the next one that writes the same ship file removes them."""

import fcntl
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from twin import whole
from twin.checksum import sha256_hex

MAX_BYTES = 32_000_000  # of a ship file, and of its arrays; what a calibration keeps takes less than 1 MB


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """While the ship file `path` and its arrays are written; `tidy` follows, also after a failure."""
    folder = _locked(path.parent, fcntl.LOCK_SH)
    try:
        yield
    finally:
        if folder is not None:
            with suppress(OSError):
                os.fsync(folder)  # the new names are on the disk before the old arrays go
                fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)  # not while another writes here
                _removed(path)
            os.close(folder)


def tidy(path: Path) -> None:
    """Removes what killed writers of the ship file `path` left in its folder, unless somebody writes a ship
    file there. Only what is ours for certain: files aside by the name that `whole.write` gives them, and
    arrays of the same stem whose name holds their own hash and stands in no ship file of the folder."""
    folder = _locked(path.parent, fcntl.LOCK_EX | fcntl.LOCK_NB)
    if folder is not None:
        with suppress(OSError):
            _removed(path)
        os.close(folder)


def _locked(folder: Path, how: int) -> int | None:
    """An open folder with its lock; None where it cannot be had (another has it, or the disk knows none)."""
    try:
        fd = os.open(folder, os.O_RDONLY)
    except OSError:
        return None
    try:
        fcntl.flock(fd, how)
    except OSError:
        os.close(fd)
        return None
    return fd


def _removed(path: Path) -> None:
    names, arrays = os.listdir(path.parent), rf"{re.escape(path.stem)}\.([0-9a-f]{{8}})\.json"
    aside = re.compile(whole.ASIDE.format(name=rf"(?:{re.escape(path.name)}|{arrays})"))
    for name in filter(aside.fullmatch, names):
        os.unlink(path.with_name(name))
    found = [name for name in names if (m := re.fullmatch(arrays, name)) and _is_ours(path, name, m[1])]
    for other in names if found else ():
        if ".toml" in other.lower() or "." not in other or other == path.name:
            said = _bytes(path.with_name(other))
            found = [name for name in found if name.encode() not in said]
    for name in found:
        os.unlink(path.with_name(name))


def _is_ours(path: Path, name: str, digest: str) -> bool:
    return sha256_hex(_bytes(path.with_name(name))).startswith(digest)


def _bytes(path: Path) -> bytes:
    """What a file holds that could be a ship file or arrays of one; b"" of all else that has such a name."""
    return whole.read(path, MAX_BYTES) if path.is_file() and path.stat().st_size <= MAX_BYTES else b""

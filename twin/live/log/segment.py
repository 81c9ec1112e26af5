"""One file of the log: numbered, locked while written, whole after every write.

A number that only grows names it and O_EXCL opens it, so neither a clock set back nor a second process
overwrites a log. A write that fails is cut back to the last whole chunk.
"""

import fcntl
import os
import re
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from twin.live.keelson.messages import schema_bytes
from twin.live.log.mcap_index import PROVENANCE
from twin.live.log.mcap_write import Compress, McapWriter
from twin.physics.maths import total

NOTHING: Mapping[str, str] = {}


class Segment:
    """The file being written, with what is told `about` it at its head; raises OSError from the constructor,
    `add`, `sync` and `finish`."""

    def __init__(
        self,
        folder: Path,
        name: str,
        now_s: float,
        sync: Callable[[int], None],
        compress: Compress,
        about: Mapping[str, str] = NOTHING,
    ):
        folder.mkdir(parents=True, exist_ok=True)
        self.opened_s = now_s
        self._named = False  # the folder with our name in it is on the disk
        self._sync = sync
        self.path, fd = _create(folder, name)
        self._file = WholeWrites(fd)
        self._writer = McapWriter(self._file.put, compress)
        try:
            self._writer.start()
            if about:
                self._writer.metadata(PROVENANCE, dict(about))
        except OSError:
            os.unlink(self.path)
            self.close()
            raise

    @property
    def size(self) -> int:
        """Bytes that are whole in the file."""
        return self._file.size

    @property
    def broken(self) -> bool:
        """Whether a write failed and could not be cut back."""
        return self._file.broken

    def add(self, topic: str, type_name: str, payload: bytes, log_ns: int, publish_ns: int) -> None:
        """One message into the file's open chunk."""
        self._writer.add(self._writer.channel(topic, type_name, schema_bytes), payload, log_ns, publish_ns)

    def sync(self) -> None:
        """Puts everything added so far on the disk."""
        self._writer.flush()  # now a kill loses nothing of it
        self._sync(self._file.fd)  # now a power cut neither
        if not self._named:
            _sync_folder(self.path.parent)
            self._named = True

    def give_up(self) -> None:
        """Forgets what could not be written."""
        self._writer.discard()

    @property
    def kept(self) -> int:
        """Messages that are whole in the file."""
        return total(self._writer.summary.counts.values())

    @property
    def channels(self) -> int:
        """Topics met so far."""
        return self._writer.channels

    def finish(self) -> None:
        """Write what is open and the index, and have the disk keep it."""
        self._writer.finish()
        self._sync(self._file.fd)

    def close(self) -> None:
        """Give the file back."""
        os.close(self._file.fd)

    def deleted(self) -> bool:
        """Whether somebody removed the file under our hands; not where the disk does not say so."""
        try:
            return os.fstat(self._file.fd).st_nlink == 0
        except OSError:
            return False


class WholeWrites:
    """An open file to which all of a piece is written or nothing. It knows nobody who writes to it, so a
    finished segment is freed without the garbage collector, which the service switches off."""

    def __init__(self, fd: int):
        self.fd, self.size, self.broken = fd, 0, False

    def put(self, data: bytes) -> None:
        """All of `data` or nothing: behind a short write nothing could be read."""
        done = 0
        try:
            while done < len(data):
                done += os.write(self.fd, data[done:])
        except OSError:
            self._cut_back()
            raise
        self.size += len(data)

    def _cut_back(self) -> None:
        try:
            os.ftruncate(self.fd, self.size)
            os.lseek(self.fd, self.size, os.SEEK_SET)
        except OSError:
            self.broken = True


def _create(folder: Path, name: str) -> tuple[Path, int]:
    """A new file with the next number; the wall clock is only for people to read."""
    number = _last_number(folder, name) + 1
    while True:
        stamp = time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())
        path = folder / f"{name}-{number:06d}-{stamp}.mcap"
        try:
            fd = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o640)
        except FileExistsError:
            number += 1
            continue
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:  # a disk that knows no locks: nothing is left behind, for this is tried each second
            os.close(fd)
            os.unlink(path)
            raise
        return path, fd


def _last_number(folder: Path, name: str) -> int:
    pattern = re.compile(re.escape(name) + r"-(\d+)-.*")
    return max((int(m[1]) for file in os.listdir(folder) if (m := pattern.match(file))), default=0)


def _sync_folder(folder: Path) -> None:
    """A new name is on the disk, too."""
    fd = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)

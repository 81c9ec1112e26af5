"""How much of the disk the log may take: days, megabytes, and what must stay free. The oldest own files go
first, never one that is being written."""

import errno
import fcntl
import os
import re
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from twin.num import as_given

DAY_S = 86400.0
MB = 1e6
ENDINGS = ("mcap", "unreadable")


class Quota(NamedTuple):
    """Limits of a log folder; 0 is none."""

    keep_days: float = 0.0  # a finished file goes when the newest is so much younger [days]
    max_mb: float = 0.0  # all own files together [MB]
    free_mb: float = 0.0  # what stays free on the disk for others [MB]


class Old(NamedTuple):
    """A finished file of the log."""

    number: int
    path: str  # no Path: each name would stay in the interpreter's table of names, which only grows
    size: int
    time_s: float


def trim(folder: Path, name: str, quota: Quota, writing: Path | None = None) -> str:
    """Deletes the oldest finished files until the folder keeps its limits; what was done in one sentence, ""
    for nothing. OSError when too little is free and nothing is left to delete."""
    old, total, gone = own_files(folder, name, writing), _size(writing), []
    for file in old:
        total += file.size
    # not the clock: set wrong, it would delete everything
    newest_s = max((file.time_s for file in old), default=0.0)
    free = _free(folder) if quota.free_mb else 0
    for file in old:
        why = _why(file, quota, newest_s, total, free)
        if not why:
            break
        if _delete(file.path):
            gone.append((file, why))
            total -= file.size
            free += file.size
    if quota.free_mb and free < quota.free_mb * MB and _free(folder) < quota.free_mb * MB:
        raise OSError(
            errno.ENOSPC,
            f"only {_free(folder) / MB:.0f} MB are free, log.free_mb keeps {as_given(quota.free_mb)} for "
            "others",
            str(folder),
        )
    return _in_words(gone)


def own_files(folder: Path, name: str, writing: Path | None = None) -> list[Old]:
    """The finished files of this log, the oldest first: by their numbers, which no clock can set back."""
    pattern, found = re.compile(rf"{re.escape(name)}-(\d+)-[^/]*\.({'|'.join(ENDINGS)})"), []
    own = writing.name if writing else ""
    with suppress(FileNotFoundError), os.scandir(folder) as entries:
        for entry in entries:
            match = pattern.fullmatch(entry.name)
            if match and entry.is_file(follow_symlinks=False) and entry.name != own:
                with suppress(FileNotFoundError):
                    about = entry.stat(follow_symlinks=False)
                    found.append(Old(int(match[1]), entry.path, about.st_size, about.st_mtime))
    return sorted(found)


def _why(file: Old, quota: Quota, newest_s: float, total: int, free: int) -> str:
    """The setting that asks for this file's place, "" when none does."""
    if quota.keep_days and newest_s - file.time_s > quota.keep_days * DAY_S:
        return f"log.keep_days = {as_given(quota.keep_days)}"
    if quota.max_mb and total > quota.max_mb * MB:
        return f"log.max_mb = {as_given(quota.max_mb)}"
    if quota.free_mb and free < quota.free_mb * MB:
        return f"log.free_mb = {as_given(quota.free_mb)}"
    return ""


def _delete(path: str) -> bool:
    """Whether it is gone; a file that another process is writing holds a lock and stays."""
    try:
        fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW)
    except OSError:
        return False
    try:
        fcntl.flock(fd, fcntl.LOCK_SH | fcntl.LOCK_NB)
        os.unlink(path)
    except OSError:
        return False
    finally:
        os.close(fd)
    return True


def _size(path: Path | None) -> int:
    with suppress(OSError):
        return path.stat().st_size if path else 0
    return 0


def _free(folder: Path) -> int:
    """Bytes that a process without rights may still write there."""
    about = os.statvfs(folder)
    return about.f_bavail * about.f_frsize


def _in_words(gone: list[tuple[Old, str]]) -> str:
    if not gone:
        return ""
    names = os.path.basename(gone[0][0].path) + (
        f" to {os.path.basename(gone[-1][0].path)}" if len(gone) > 1 else ""
    )
    files = "the oldest file" if len(gone) == 1 else f"the {len(gone)} oldest files"
    return f"log: {files} deleted ({names}), as {' and '.join(sorted({why for _, why in gone}))} asks"

"""Keeping time on a shared computer: scheduler, processor, memory, garbage. What is not allowed is said,
and the twin goes on.

Clean pages of libraries that the start needed and the loop does not are given back first, and only then is
memory locked, with MCL_ONFAULT: a plain mlockall would fetch every page of every library (80 MB and not 46).
"""

import ctypes
import gc
import os
import re
import sys
from collections.abc import Sequence
from typing import NamedTuple

MCL_CURRENT, MCL_FUTURE, MCL_ONFAULT = 1, 2, 4
MADV_DONTNEED = 4
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD, M_ARENA_MAX = -1, -3, -8
_MAPPING = re.compile(r"([0-9a-f]+)-([0-9a-f]+) (\S{4}) \S+ \S+ (\d+)\s*(.*)")


def settle(priority: int = 0, cpu: int = -1, lock_memory: bool = True, drop: bool = True) -> list[str]:
    """Make this process a real-time one as far as it is allowed; the sentences say what was refused, and
    what to do."""
    said = []
    gc.collect()
    gc.freeze()
    gc.disable()
    if cpu >= 0:
        said += _affinity(cpu)
    if drop:
        drop_pages()
    if lock_memory:
        said += _lock()
    if priority > 0:
        said += _fifo(priority)
    return said


def save_memory() -> None:
    """One heap for all threads, and what is freed goes back to the kernel; call it before the first thread
    starts."""
    libc = _libc()
    if libc is not None and hasattr(libc, "mallopt"):
        libc.mallopt(M_ARENA_MAX, 1)
        libc.mallopt(M_TRIM_THRESHOLD, 128 * 1024)
        libc.mallopt(M_MMAP_THRESHOLD, 64 * 1024)


def drop_pages() -> int:
    """Give back clean, file-backed pages (read-only mappings of libraries); returns the bytes of the
    mappings given back.

    They come back by themselves when they are needed. Writable and once-writable (relocated) mappings are
    left alone.
    """
    libc = _libc()
    if libc is None:
        return 0
    dropped = 0
    try:
        with open("/proc/self/maps", encoding="utf-8", errors="replace") as maps:
            lines = maps.readlines()
    except OSError:
        return 0
    libc.madvise.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    for start, end in clean(lines):
        if libc.madvise(start, end - start, MADV_DONTNEED) == 0:
            dropped += end - start
    return dropped


class Mapping(NamedTuple):
    """One line of /proc/self/maps: addresses, rights as in `r-xp`, and the file ("" for none)."""

    start: int
    end: int
    rights: str
    inode: str
    path: str


def clean(lines: Sequence[str]) -> list[tuple[int, int]]:
    """(start, end) of the mappings in /proc/self/maps that hold what their file holds: readable, not
    writable, never written to."""
    found = [
        Mapping(int(m[1], 16), int(m[2], 16), m[3], m[4], m[5])
        for line in lines
        if (m := _MAPPING.match(line))
    ]
    return [
        (m.start, m.end) for i, m in enumerate(found) if _of_a_file(m) and not _relocated(m, found[i + 1 :])
    ]


def _of_a_file(m: Mapping) -> bool:
    return m.inode != "0" and m.path.startswith("/") and "w" not in m.rights and m.rights[:3] != "---"


def _relocated(mine: Mapping, behind: Sequence[Mapping]) -> bool:
    """Whether a read-only mapping is the part of a library that the loader wrote to (RELRO): the next one
    with any rights is a writable one of the same file. Between them may lie a gap without rights (arm64,
    pages of 64 KiB)."""
    if not mine.rights.startswith("r--"):
        return False
    end = mine.end
    for m in behind:
        if m.rights[:3] == "---" and m.path in (mine.path, ""):
            end = m.end if m.start == end else end
            continue
        return "w" in m.rights and (m.path == mine.path or (m.path == "" and m.start == end))
    return False


def _affinity(cpu: int) -> list[str]:
    try:
        os.sched_setaffinity(0, {cpu})
    except (OSError, AttributeError) as error:
        return [f"loop.cpu = {cpu} could not be set ({error}); any processor is used"]
    return []


def _fifo(priority: int) -> list[str]:
    if not hasattr(os, "sched_setscheduler"):
        return ["no real-time scheduling on this system"]
    try:
        if os.sched_getscheduler(0) == os.SCHED_FIFO:
            return []
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except OSError as error:
        return [
            f"no real-time priority ({error.strerror}): under load ticks may come late. Allow it with "
            "LimitRTPRIO, or CAP_SYS_NICE"
        ]
    return []


def _lock() -> list[str]:
    libc = _libc()
    if libc is None or libc.mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0:
        return []
    return [
        f"memory is not locked ({os.strerror(ctypes.get_errno())}): a swap could delay a tick. Allow it "
        "with LimitMEMLOCK"
    ]


def _libc() -> ctypes.CDLL | None:
    return ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None

"""Manners of a real-time process: what is refused is said, what is given back comes back."""

import os
import subprocess
import sys

import pytest

from bench.tick.memory import memory
from twin.live import realtime


def test_memory_is_read_from_the_kernel():
    found = memory()
    assert found.peak_mb >= found.now_mb > 1.0 and found.anon_mb + found.file_mb <= found.now_mb + 1.0


def test_dropped_pages_come_back_by_themselves():
    """Test: drop all clean library pages, then use them. Expected: the process gets smaller and works on."""
    code = (
        "from bench.tick.memory import memory\nfrom twin.live import realtime\nfrom twin.live.keelson import decode\nfrom twin.live.learning import residual\n"
        "from twin.physics.ship import load\n"
        "r = residual.load(residual.bundled(load('kvlcc2')), load('kvlcc2'))\n"
        "before = memory().now_mb; dropped = realtime.drop_pages(); after = memory().now_mb\n"
        "assert r.network.run([0.0] * 5) == r.network.run([0.0] * 5)\n"
        "print(before, after, dropped)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    before, after, dropped = map(float, done.stdout.split())
    assert dropped > 0 and after < before - 5.0


def test_what_is_not_allowed_is_said_and_nothing_else_happens():
    """Test: a process without rights asks for everything, and for a processor that does not exist.
    Expected: sentences."""
    code = (
        "import os, resource\nfrom twin.live import realtime\n"
        "resource.setrlimit(resource.RLIMIT_MEMLOCK, (0, 0)); resource.setrlimit(resource.RLIMIT_RTPRIO, (0, "
        "0))\n"
        "os.setuid(65534) if os.getuid() == 0 else None\n"
        "print(*realtime.settle(priority=50, cpu=1000), sep='\\n')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, cwd="/")
    assert done.returncode == 0, done.stderr
    assert (
        "loop.cpu = 1000" in done.stdout
        and "real-time priority" in done.stdout
        and "not locked" in done.stdout
    )


def test_a_writable_mapping_is_never_dropped():
    big = bytearray(os.urandom(1 << 20))
    copy = bytes(big)
    realtime.drop_pages()
    assert bytes(big) == copy


PLAIN = """\
7f0000000000-7f0000010000 r--p 00000000 08:01 77 /lib/libblas.so
7f0000010000-7f0000050000 r-xp 00010000 08:01 77 /lib/libblas.so
7f0000050000-7f0000060000 r--p 00050000 08:01 77 /lib/libblas.so
7f0000060000-7f0000070000 r--p 0005f000 08:01 77 /lib/libblas.so
7f0000070000-7f0000080000 rw-p 0006f000 08:01 77 /lib/libblas.so
7f0000080000-7f0000090000 rw-p 00000000 00:00 0
"""
ARM64 = """\
ffff00000000-ffff00100000 r-xp 00000000 08:01 77 /lib/libopenblas.so
ffff00100000-ffff00110000 ---p 00100000 08:01 77 /lib/libopenblas.so
ffff00110000-ffff00120000 r--p 00100000 08:01 77 /lib/libopenblas.so
ffff00120000-ffff00130000 ---p 00110000 08:01 77 /lib/libopenblas.so
ffff00130000-ffff00140000 rw-p 00110000 08:01 77 /lib/libopenblas.so
ffff00200000-ffff00210000 r--p 00000000 08:01 78 /usr/lib/locale/C.utf8
ffff00210000-ffff00220000 r--p 00000000 00:00 0 [vvar]
"""


def test_what_the_loader_wrote_to_is_kept_next_to_a_writable_mapping():
    kept = (0x7F0000060000, 0x7F0000070000)
    found = realtime.clean(PLAIN.splitlines())
    assert kept not in found and found == [
        (0x7F0000000000, 0x7F0000010000),
        (0x7F0000010000, 0x7F0000050000),
        (0x7F0000050000, 0x7F0000060000),
    ]


def test_what_the_loader_wrote_to_is_kept_over_a_gap_without_rights():
    """Test: a library as arm64 maps it, a gap of one large page before its writable part. Expected: code and
    an ordinary file go, the relocated part and the gaps stay."""
    assert realtime.clean(ARM64.splitlines()) == [
        (0xFFFF00000000, 0xFFFF00100000),
        (0xFFFF00200000, 0xFFFF00210000),
    ]


@pytest.mark.parametrize("gap", ["", "ffff00120000-ffff00130000 ---p 00000000 00:00 0 \n"])
def test_it_is_kept_whether_the_gap_is_the_files_nobodys_or_not_mapped_at_all(gap):
    lines = [line for line in ARM64.splitlines() if not line.startswith("ffff00120000")]
    lines[3:3] = gap.splitlines()
    assert (0xFFFF00110000, 0xFFFF00120000) not in realtime.clean(lines)


def test_of_this_process_itself_nothing_is_dropped_that_the_kernel_says_was_written_to():
    """Test: /proc/self/smaps of this process, with numpy loaded. Expected: no clean mapping of a library has
    pages of its own."""
    import numpy  # noqa: F401

    with open("/proc/self/maps") as maps:
        found = {f"{a:x}-{b:x}" for a, b in realtime.clean(maps.readlines())}
    at, written = "", []
    with open("/proc/self/smaps") as smaps:
        for line in smaps:
            if "-" in line.split()[0] and not line.split()[0].endswith(":"):
                at = line.split()[0]
            elif line.startswith("Private_Dirty:") and at in found and int(line.split()[1]):
                written.append(at)
    assert found and not written

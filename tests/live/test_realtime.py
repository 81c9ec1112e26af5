"""Manners of a real-time process: what is refused is said, what is given back comes back."""

import os
import subprocess
import sys

from twin.live import realtime


def test_memory_is_read_from_the_kernel():
    found = realtime.memory_mb()
    assert found["peak"] >= found["rss"] > 1.0 and found["anonymous"] + found["file"] <= found["rss"] + 1.0


def test_dropped_pages_come_back_by_themselves():
    """Test: drop all clean library pages, then use them. Expected: the process gets smaller and works on."""
    code = (
        "from twin.live import realtime, decode, residual\n"
        "from twin.physics.ship import load\n"
        "r = residual.load(residual.bundled(load('kvlcc2')), load('kvlcc2'))\n"
        "before = realtime.memory_mb()['rss']; dropped = realtime.drop_pages(); after = "
        "realtime.memory_mb()['rss']\n"
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

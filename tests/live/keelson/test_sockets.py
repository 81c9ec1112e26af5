"""Only the configured socket listens (Q5), and an open bus does not hold up the end of a process (C4)."""

import subprocess
import sys
from pathlib import Path

from tests.live.keelson.test_bus import free_port

IMPORTS = (
    "from twin.live.keelson.zenoh_bus import ZenohBus\nfrom twin.live.keelson.zenoh_config import "
    "BusSettings\n"
)


def test_Q5_only_the_configured_socket_listens_and_only_on_loopback() -> None:
    """Expected: one TCP listener on 127.0.0.1, no UDP socket at all (no 7446 scouting)."""
    port = free_port()
    script = (
        f"{IMPORTS}with ZenohBus(BusSettings(listen='tcp/127.0.0.1:{port}')):\n"
        "    print('open', flush=True)\n    input()\n"
    )
    process = subprocess.Popen([sys.executable, "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdout is not None
    try:
        assert process.stdout.readline() == b"open\n"
        inodes = socket_inodes(process.pid)
        assert listeners("tcp", inodes) == [("0100007F", port)]
        assert [listeners(kind, inodes) for kind in ("tcp6", "udp", "udp6")] == [[], [], []]
    finally:
        process.communicate(b"\n", timeout=10)
    assert process.returncode == 0


def socket_inodes(pid: int) -> set[str]:
    links = []
    for file in Path(f"/proc/{pid}/fd").iterdir():
        links.append(str(file.readlink()))
    return {link[8:-1] for link in links if link.startswith("socket:[")}


def listeners(kind: str, inodes: set[str]) -> list[tuple[str, int]]:
    """(address in hexadecimal, port) of a process's sockets that take what comes."""
    rows = [line.split() for line in Path(f"/proc/net/{kind}").read_text().splitlines()[1:]]
    ours = [row for row in rows if row[9] in inodes and (kind[:3] == "udp" or row[3] == "0A")]
    waiting = [row[1].split(":") for row in ours]
    return [(address, int(port, 16)) for address, port in waiting]


def test_an_exception_with_an_open_bus_ends_the_process() -> None:
    """C4: no Python callback, so no hang (zenoh-python 434)."""
    script = (
        f"{IMPORTS}with ZenohBus(BusSettings(listen='tcp/127.0.0.1:0')) as bus:\n"
        "    bus.drain(0.0)\n    raise ValueError\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, timeout=20)
    assert done.returncode == 1

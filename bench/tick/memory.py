"""What a whole process occupies, by the kernel: peak, anonymous and file-backed parts [1e6 bytes]."""

from pathlib import Path
from typing import NamedTuple

from twin.errors import TwinError

KIB = 1024 / 1e6


class ProcessMemory(NamedTuple):
    """Resident memory. `peak` is VmHWM, the most it ever was; `anon` + `file` is what it is now."""

    peak_mb: float
    now_mb: float
    anon_mb: float
    file_mb: float


def memory(pid: int | str = "self") -> ProcessMemory:
    """Read from /proc, which only Linux has."""
    try:
        text = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        raise TwinError("Memory is read from /proc, which is not here. Run twin-bench on Linux.") from None
    lines = (line.partition(":") for line in text.splitlines())
    kib = {name: int(rest.split()[0]) for name, _, rest in lines if rest.endswith("kB")}
    file = kib["RssFile"] + kib["RssShmem"]
    return ProcessMemory(*(round(k * KIB, 2) for k in (kib["VmHWM"], kib["VmRSS"], kib["RssAnon"], file)))

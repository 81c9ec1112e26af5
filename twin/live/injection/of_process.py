"""A fault of a running process: it stands still, or nothing that it writes arrives."""

import os
import resource
import signal
import time
from math import inf

from twin.errors import UsageError

OF_A_PROCESS = {"pause": "stopped", "disk": "no write succeeded"}  # what, and what it then was


def of_a_process(what: str, pid: int | None, start_s: float, seconds: float) -> None:
    """Stop a process, or let none of its writes succeed, for a while; it is as before afterwards, also
    when this is interrupted. UsageError: no such process, or no end."""
    if pid is None or seconds == inf:
        raise UsageError(
            f"{what}: which process, and how long? --pid PID --for S. The twin's: systemctl "
            "show -p MainPID --value shiptwin"
        )
    if pid < 1:  # to the kernel 0 is the caller's own group of processes, and -1 is everybody's
        raise UsageError(f"--pid {pid}: a process has a number of 1 or more.")
    try:
        os.kill(pid, 0)
    except (ProcessLookupError, OverflowError):
        raise UsageError(f"--pid {pid}: there is no such process.") from None
    except PermissionError:
        raise UsageError(f"--pid {pid}: it is another user's. Use sudo.") from None
    time.sleep(start_s)
    (_pause if what == "pause" else _no_writes)(pid, seconds)


def _pause(pid: int, seconds: float) -> None:
    os.kill(pid, signal.SIGSTOP)
    try:
        time.sleep(seconds)
    finally:
        os.kill(pid, signal.SIGCONT)


def _no_writes(pid: int, seconds: float) -> None:
    """The kernel cuts every write to a file at no bytes: what a full disk does to this process alone."""
    before = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        time.sleep(seconds)
    finally:
        resource.prlimit(pid, resource.RLIMIT_FSIZE, before)

"""One twin for each state folder: two would write what they learned over each other's."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from twin.errors import TwinError

NAME = "twin.lock"


@contextmanager
def alone(folder: str) -> Iterator[None]:
    """The folder is this process's until the end, also when it is killed; TwinError (exit code 1: systemd
    tries again) while another has it. Without a folder, or where none can be made or locked, nobody is kept
    out."""
    fd = _opened(folder)
    try:
        if fd is not None:
            _lock(fd, folder)
        yield
    finally:
        if fd is not None:
            os.close(fd)


def _lock(fd: int, folder: str) -> None:
    try:
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise TwinError(
            f"{folder}: another twin keeps what it learns here. Stop it, or choose another [state] folder."
        ) from None
    except OSError:  # a disk that knows no locks
        return


def _opened(folder: str) -> int | None:
    if not folder:
        return None
    with suppress(OSError):
        os.makedirs(folder, exist_ok=True)
        return os.open(os.path.join(folder, NAME), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o640)
    return None

"""Instructions of one step, counted by valgrind: a figure that does not depend on the machine's mood.

The same program is counted with few and with many repeats; the difference, divided, is one repeat. Two runs
give the same count, so that a change of one per cent is a change of the code.

    python -m bench.tick.instructions PROGRAM REPEATS      runs a program of counted.py; valgrind watches it
"""

import gc
import re
import shutil
import subprocess
import sys
import tempfile

from bench.tick import counted
from twin.errors import TwinError

FEW, MANY = 30, 90
LIMIT_S = 600
VALGRIND = ("valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null")


def available() -> bool:
    return shutil.which("valgrind") is not None


def counts(names: tuple[str, ...] = tuple(counted.PROGRAMS)) -> dict[str, int]:
    """{program: instructions of one repeat}; every run is a process of its own."""
    with tempfile.TemporaryDirectory(prefix="twin-bench-") as home:
        return {name: _count(name, home) for name in names}


def _count(name: str, home: str) -> int:
    start((), name, 1, home).communicate(timeout=LIMIT_S)  # puts on file what is worked out only once
    few, many = (start(VALGRIND, name, repeats, home) for repeats in (FEW, MANY))
    return round((total(many) - total(few)) / (MANY - FEW))


def start(watcher: tuple[str, ...], name: str, repeats: int, home: str) -> "subprocess.Popen[str]":
    """The program, watched; its surroundings are the same each time."""
    command = [*watcher, sys.executable, "-P", "-m", "bench.tick.instructions", name, str(repeats)]
    env = {"PYTHONHASHSEED": "0", "PYTHONDONTWRITEBYTECODE": "1", "PATH": "/usr/bin:/bin", "HOME": home}
    return subprocess.Popen(command, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def total(process: "subprocess.Popen[str]") -> int:
    """All instructions of a watched process."""
    try:
        text = process.communicate(timeout=LIMIT_S)[1]
    except subprocess.TimeoutExpired:
        process.kill()
        raise TwinError(f"valgrind took more than {LIMIT_S} s. Leave it out: --no-instructions") from None
    found = re.search(r"I +refs: +([\d,]+)", text)
    if process.returncode != 0 or not found:
        raise TwinError(f"valgrind failed: {text.strip().splitlines()[-1:]}. Leave it out: --no-instructions")
    return int(found.group(1).replace(",", ""))


if __name__ == "__main__":
    step = counted.PROGRAMS[sys.argv[1]]()
    gc.freeze()
    gc.disable()  # as the service does
    for _ in range(int(sys.argv[2])):
        step()

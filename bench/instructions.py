"""Instructions of one step, counted by valgrind: a figure that does not depend on the machine's mood.

The same program is counted with few and with many repeats; the difference, divided, is one repeat. Two
runs give the same count, so that a change of one per cent is a change of the code.

    python -m bench.instructions PROGRAM REPEATS      runs a program (below) so often; valgrind watches it
"""

import re
import shutil
import subprocess
import sys
from collections.abc import Callable

from twin.errors import TwinError

FEW, MANY = 20, 520
LIMIT_S = 300
VALGRIND = ("valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null")


def analytic() -> Callable[[], object]:
    """One Runge-Kutta step of the equations."""
    from twin.physics.model import Model
    from twin.physics.ship import load
    from twin.physics.state import Situation

    ship = load("kvlcc2")
    model, s = Model.of(ship), Situation(u=ship.U_0, delta=0.1, n=1.5, wind_speed=8.0, wind_to=0.7)
    state = (0.0, 0.0, 0.0, ship.U_0, 0.1, 0.002)
    return lambda: model.step(state, s, 0.1)


PROGRAMS: dict[str, Callable[[], Callable[[], object]]] = {"analytic": analytic}


def available() -> bool:
    return shutil.which("valgrind") is not None


def counts(names: tuple[str, ...] = tuple(PROGRAMS)) -> dict[str, int]:
    """{program: instructions of one repeat}; every run is a process of its own, two at a time."""
    running = {(name, n): _start(name, n) for name in names for n in (FEW, MANY)}
    total = {key: _finish(process) for key, process in running.items()}
    return {name: round((total[name, MANY] - total[name, FEW]) / (MANY - FEW)) for name in names}


def _start(name: str, repeats: int) -> "subprocess.Popen[str]":
    program = [sys.executable, "-m", "bench.instructions", name, str(repeats)]
    command = [*VALGRIND, *program]
    env = {"PYTHONHASHSEED": "0", "PYTHONDONTWRITEBYTECODE": "1", "PATH": "/usr/bin:/bin", "HOME": "/tmp"}
    return subprocess.Popen(command, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def _finish(process: "subprocess.Popen[str]") -> int:
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
    step = PROGRAMS[sys.argv[1]]()
    for _ in range(int(sys.argv[2])):
        step()

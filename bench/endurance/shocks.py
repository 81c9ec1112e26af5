"""What is done to the running service: kill -9, SIGSTOP for a while, the wall clock set."""

import random
import signal
import time
from pathlib import Path
from typing import NamedTuple

from bench import bench_output
from bench.endurance.killed_service import Running, ServiceFolder, Shift
from twin.errors import TwinError
from twin.live.keelson import messages
from twin.live.log.mcap_read import McapReader
from twin.live.log.recover import recover_folder

PAUSES_S = (1.0, 1.0, 1.5, 2.0, 2.5, 2.9, 3.0, 3.1, 3.5, 4.0, 5.0, 1.2, 2.8, 3.3, 8.0, 10.0, 20.0, 60.0)
STEPS_S = (0.4, -0.4, 1.0, 1.5, 1.9, -1.2, -1.9, 2.5, 31.0, 3600.0, -7200.0, 0.8)
READY_S = 90.0  # the first start works the certificate out
BACK_S = 60.0  # within which everything should be as before


class Killed(NamedTuple):
    """One kill -9: how long the process had ticked, what was lost of the log, when the next one ticked."""

    lived_s: float
    lost_s: float
    start_s: float


class Shocked(NamedTuple):
    """One pause or clock step: seconds until the next tick and until the promise is back (None: not in time),
    whether it was announced, ticks since with another mode than hybrid."""

    what: str
    tick_s: float | None
    promise_s: float | None
    announced: bool
    not_hybrid: int


def kills(place: ServiceFolder, count: int) -> tuple[list[Killed], int, int]:
    """Each process is killed at a random instant; (kills, log files that are whole, all log files)."""
    dice, made = random.Random(4), list[Killed]()
    running = place.start()
    if running.until(lambda said: said.inside, READY_S) is None:
        raise TwinError(f"no promise within {READY_S:g} s: {running.last}")
    first_s = running.last.time_s
    for k in range(count):
        for _ in running.heard(dice.uniform(0.05, 2.5)):
            pass
        last = running.kill()
        lost_s = last.time_s - logged_until(place.logs, first_s)
        running = place.start()
        start_s = running.until(lambda said: True, READY_S)
        if start_s is None:
            raise TwinError(f"it did not start again after kill {k + 1}: see {place.folder / 'errors'}")
        made.append(Killed(last.time_s - first_s, max(lost_s, 0.0), time.monotonic() - running.began_s))
        first_s = running.last.time_s
        if k % 20 == 19:
            bench_output.tell(f"{k + 1} kills, at most {max(m.lost_s for m in made):.3f} s lost")
    if running.until(lambda said: said.inside, BACK_S) is None:
        raise TwinError(f"after {count} kills no promise within {BACK_S:g} s: {running.last}")
    running.stop()
    recover_folder(place.logs)
    files = list(place.logs.glob("*.mcap"))
    return made, sum(whole(path) for path in files), len(files)


def logged_until(folder: Path, first_s: float) -> float:
    """The newest tick that can be read of the run that began at first_s; the log is still as the kill left
    it."""
    newest = first_s
    for path in sorted(folder.glob("*"), key=lambda p: p.stat().st_mtime)[-2:]:
        try:
            for message in McapReader(path).messages():
                if message.type_name == "shiptwin.Tick":
                    newest = max(newest, messages.Tick.FromString(message.data).time_s)
        except TwinError:
            continue  # cut off before its first chunk
    return newest


def whole(path: Path) -> bool:
    """Whether every message can be read, and nothing but the repair is said; a process that was killed before
    its first half second leaves a log without any."""
    reader = McapReader(path)
    try:
        for _ in reader.messages():
            pass
    except TwinError:
        pass
    return all("repaired" in problem for problem in reader.problems)


def pauses(place: ServiceFolder, count: int) -> tuple[list[Shocked], int]:
    """SIGSTOP and SIGCONT; (each pause, exit code at the end)."""
    running = ready(place.start())
    made = []
    for k in range(count):
        pause_s = PAUSES_S[k % len(PAUSES_S)]
        running.tell(signal.SIGSTOP)
        time.sleep(pause_s)
        for _ in running.heard(0.02):  # what it had told before
            pass
        running.tell(signal.SIGCONT)
        made.append(after(running, f"pause of {pause_s:g} s", ("lagging", "began anew", "late")))
        bench_output.tell(str(made[-1]))
    return made, running.stop()


def clocks(place: ServiceFolder, count: int) -> tuple[list[Shocked], int]:
    """The wall clock is set and stays there; (each step, exit code at the end)."""
    shift = Shift(place.folder)
    running, offset_s, made = ready(place.start(**shift.environment)), 0.0, []
    for k in range(count):
        step_s = STEPS_S[k % len(STEPS_S)]
        offset_s += step_s
        shift.to(offset_s)
        made.append(after(running, f"clock {step_s:+g} s", ("clock", "stamps")))
        bench_output.tell(str(made[-1]))
    return made, running.stop()


def ready(running: Running) -> Running:
    if running.until(lambda said: said.inside and said.mode == "hybrid", READY_S) is None:
        raise TwinError(f"no promise within {READY_S:g} s: {running.last}")
    return running


def after(running: Running, what: str, words: tuple[str, ...]) -> Shocked:
    """Listens until ten seconds after the promise is there again."""
    began, first, back, announced, other = time.monotonic(), None, None, False, 0
    for said in running.heard(BACK_S):
        now = time.monotonic() - began
        first = now if first is None else first
        announced |= any(word in said.reasons for word in words)
        other += said.mode != "hybrid"
        settled = said.inside and said.mode == "hybrid"
        if not settled:
            back = None
        elif back is None:
            back = now
        if back is not None and now > back + 8.0:
            break
    return Shocked(what, first, back, announced, other)

"""What is done to the running service: kill -9, SIGSTOP for a while, the wall clock set."""

import random
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from bench.endurance.killed_service import Running, ServiceFolder, Shift
from twin.errors import TwinError
from twin.live.keelson import messages
from twin.live.log.mcap_read import McapReader
from twin.live.log.recover import recover_folder

PAUSES_S = (1.0, 1.0, 1.5, 2.0, 2.5, 2.9, 3.0, 3.1, 3.5, 4.0, 5.0, 1.2, 2.8, 3.3, 8.0, 10.0, 20.0, 60.0)
STEPS_S = (0.4, -0.4, 1.0, 1.5, 1.9, -1.2, -1.9, 2.5, 31.0, 3600.0, -7200.0, 0.8)
TENTHS_S = tuple(sign * tenth / 10.0 for tenth in range(1, 31) for sign in (1.0, -1.0))
PAUSE_S, STEP_TO_S = (0.1, 600.0), (0.05, 1e5)  # after those above: shortest and longest
READY_S = 90.0  # the first start works the certificate out
BACK_S = 60.0  # within which everything should be as before


class Killed(NamedTuple):
    """One kill -9: how long the process had ticked, what was lost of the log, when the next one ticked."""

    lived_s: float
    lost_s: float
    start_s: float


class Shocked(NamedTuple):
    """One pause or clock step and its size [s]: seconds until the next tick, until it was said and until the
    promise is back (None: not in time), ticks since with another mode than hybrid."""

    what: str
    size_s: float
    tick_s: float | None
    said_s: float | None
    promise_s: float | None
    not_hybrid: int


Keep = Callable[[int, NamedTuple], None]  # takes down what became of shock k


def spread_s(k: int, low_s: float, high_s: float) -> float:
    """The k-th of sizes that cover a range evenly in their logarithm, however many (golden ratio)."""
    return low_s * (high_s / low_s) ** ((k + 1) * 0.618034 % 1.0)


def pause_s(k: int) -> float:
    """The k-th pause [s]."""
    return PAUSES_S[k] if k < len(PAUSES_S) else spread_s(k - len(PAUSES_S), *PAUSE_S)


def clock_step_s(k: int) -> float:
    """The k-th step of the wall clock [s]: chosen ones, -3 to 3 s in tenths, then any size to either side."""
    first = (*STEPS_S, *TENTHS_S)
    return first[k] if k < len(first) else (-1) ** k * spread_s(k - len(first), *STEP_TO_S)


def kills(place: ServiceFolder, numbers: Iterator[int], keep: Keep) -> tuple[int, int]:
    """Each process is killed at a random instant; (log files that are whole, all log files)."""
    running = place.start()
    if running.until(lambda said: said.inside, READY_S) is None:
        raise TwinError(f"no promise within {READY_S:g} s: {running.last}")
    first_s = running.last.time_s
    for k in numbers:
        for _ in running.heard(random.Random(k).uniform(0.05, 2.5)):
            pass
        last = running.kill()
        lost_s = last.time_s - logged_until(place.logs, first_s)
        running = place.start()
        if running.until(lambda said: True, READY_S) is None:
            raise TwinError(f"it did not start again after kill {k + 1}: see {place.folder / 'errors'}")
        keep(k, Killed(last.time_s - first_s, max(lost_s, 0.0), time.monotonic() - running.began_s))
        first_s = running.last.time_s
    if running.until(lambda said: said.inside, BACK_S) is None:
        raise TwinError(f"after the kills no promise within {BACK_S:g} s: {running.last}")
    running.stop()
    recover_folder(place.logs)
    files = list(place.logs.glob("*.mcap"))
    return sum(whole(path) for path in files), len(files)


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


def pauses(place: ServiceFolder, numbers: Iterator[int], keep: Keep) -> tuple[int, int]:
    """SIGSTOP and SIGCONT; (processes that ended with 0 when told to, all processes)."""
    running = ready(place.start())
    for k in numbers:
        running.tell(signal.SIGSTOP)
        time.sleep(pause_s(k))
        for _ in running.heard(0.02):  # what it had told before
            pass
        running.tell(signal.SIGCONT)
        size_s = pause_s(k)
        keep(k, after(running, f"pause of {size_s:.3g} s", size_s, ("lagging", "began anew", "late")))
    return int(running.stop() == 0), 1


def clocks(place: ServiceFolder, numbers: Iterator[int], keep: Keep) -> tuple[int, int]:
    """The wall clock is set and stays there; (processes that ended with 0 when told to, all processes)."""
    shift = Shift(place.folder)
    running, offset_s = ready(place.start(**shift.environment)), 0.0
    for k in numbers:
        size_s = clock_step_s(k)
        offset_s += size_s
        shift.to(offset_s)
        keep(k, after(running, f"clock {size_s:+.3g} s", abs(size_s), ("clock", "stamps")))
    return int(running.stop() == 0), 1


def ready(running: Running) -> Running:
    if running.until(lambda said: said.inside and said.mode == "hybrid", READY_S) is None:
        raise TwinError(f"no promise within {READY_S:g} s: {running.last}")
    return running


def after(running: Running, what: str, size_s: float, words: tuple[str, ...]) -> Shocked:
    """Listens until eight seconds after the promise is there again. TwinError: the process has ended."""
    began, first, back, said_s, other = time.monotonic(), None, None, None, 0
    for said in running.heard(BACK_S):
        now = time.monotonic() - began
        first = now if first is None else first
        if said_s is None and any(word in said.reasons for word in words):
            said_s = now
        other += said.mode != "hybrid"
        settled = said.inside and said.mode == "hybrid"
        if not settled:
            back = None
        elif back is None:
            back = now
        if back is not None and now > back + 8.0:
            break
    if running.process.poll() is not None:
        raise TwinError(f"{what}: the process ended with {running.process.returncode}: {running.last}")
    return Shocked(what, size_s, first, said_s, back, other)

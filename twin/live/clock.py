"""When the next tick is: absolute deadlines on the monotonic clock, or the instants of a log.

Every clock has one verb, `wait()`, which gives the next `Instant` or None when there are no more. State
depends on the monotonic time alone; the wall clock is only written down, and a step of it is announced.
"""

import math
import time
from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol


class Instant(NamedTuple):
    """One tick's time: `time_s` monotonic [s], `wall_s` UTC since 1970 [s]."""

    number: int  # of this tick, from 0
    time_s: float
    wall_s: float
    late_s: float = 0.0  # how long after its deadline the tick woke
    skipped: int = 0  # periods missed just before this tick: counted, never made up


class Clock(Protocol):
    """The face every clock has."""

    def wait(self) -> Instant | None:
        """The next tick, when it is time; None when there are no more."""
        ...

    def slack_s(self) -> float | None:
        """Time left until the next deadline [s], negative when it is over; None where there are none."""
        ...


class MonotonicClock:
    """A tick each 1/rate_hz [s] on a fixed grid. A tick that comes too late skips whole periods; one that
    woke more than half a period late skips the next as well, so no two are closer than half a period."""

    def __init__(
        self,
        rate_hz: float,
        monotonic: Callable[[], float] = time.monotonic,
        wall: Callable[[], float] = time.time,
        sleep: Callable[[float], None] = time.sleep,
    ):
        self.period_s = 1.0 / rate_hz
        self.overruns = 0
        self._monotonic, self._wall, self._sleep = monotonic, wall, sleep
        self._start_s = monotonic()
        self._period = 0  # whole periods from the start to the next deadline
        self._index = 0
        self._woke_s = self._start_s - self.period_s

    def wait(self) -> Instant:
        """The next tick, once its deadline has come; periods that are over are skipped and counted."""
        skipped = self._skip()
        deadline = self._start_s + self._period * self.period_s
        while (left := deadline - self._monotonic()) > 0.0:
            self._sleep(left)
        now_s = self._monotonic()
        wall_s = self._wall()
        instant = Instant(self._index, now_s, wall_s, now_s - deadline, skipped)
        self._index += 1
        self._period += 1
        self._woke_s = now_s
        return instant

    def slack_s(self) -> float:
        """Time left until the next deadline [s]; negative when it is over."""
        return self._start_s + self._period * self.period_s - self._monotonic()

    def _skip(self) -> int:
        """Moves the next deadline past every whole period that is over, and half a period from the last tick;
        merely late is not skipped."""
        over = math.floor((self._monotonic() - self._start_s) / self.period_s)
        apart = math.ceil((self._woke_s - self._start_s) / self.period_s + 0.5)
        behind = max(over, apart) - self._period
        if behind <= 0:
            return 0
        self._period += behind
        self.overruns += behind
        return behind


LONGEST_SLEEP_S = 60.0  # between two instants of a log: a longer hole in it is jumped over


class ReplayClock:
    """The instants of a log, one after the other; `pace` 1.0 sleeps as the voyage did (but through no long
    hole), 0.0 not at all."""

    def __init__(self, times: Iterable[tuple[float, float]], pace: float = 0.0):
        self._times = iter(times)
        self._pace = pace
        self._index = 0
        self._began: tuple[float, float] | None = None
        self._last_s = 0.0

    def wait(self) -> Instant | None:
        """The log's next instant, at its pace; None behind the last."""
        try:
            time_s, wall_s = next(self._times)
        except StopIteration:
            return None
        if self._pace > 0.0:
            self._keep_pace(time_s)
        instant = Instant(self._index, time_s, wall_s)
        self._index += 1
        return instant

    def slack_s(self) -> None:
        """None: a log has no deadlines."""
        return None

    def _keep_pace(self, time_s: float) -> None:
        now_s = time.monotonic()
        if self._began is None or time_s - self._last_s > LONGEST_SLEEP_S:
            self._began = (now_s, time_s)
        self._last_s = time_s
        began_s, first_s = self._began
        time.sleep(max(0.0, began_s + (time_s - first_s) / self._pace - now_s))

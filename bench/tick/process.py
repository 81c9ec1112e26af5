"""The whole service in a process, measured from inside: bus over loopback TCP, log, network, adaptation.

Only what the service loads is loaded here, so that the memory is the service's. The stop-watch is the
clock that the service waits for: a step is everything it does between two waits. Prints one JSON object.

    python -m bench.tick.process CONFIG MARK STEPS PARTS fast|paced
"""

import json
import math
import os
import sys
import time
from array import array
from collections.abc import Callable
from typing import Any

from bench.tick.mark import Mark
from bench.tick.memory import ProcessMemory, memory
from bench.tick.timing import quantiles
from twin.live.clock import Clock, Instant, MonotonicClock
from twin.live.service import Stop, opened
from twin.live.signals import config

# ticks before anything is counted: the feed is heard, gates open, the first prediction is made, the log is
# open
WARM_UP = 900
CONNECT_S = 20.0
FEED_S = 20.0  # a feed that is silent for so long has stopped
LAG_S = 0.2  # of the loop's own time
OLD_S = 1.0  # of the loop's own time: measurements older than this are late, not lost


class FastClock:
    """A clock that is always due: each tick is one period later than the last, whatever the time is.

    Outside every step it waits for a feed that lags by more than `LAG_S` (without measurements the loop would
    do less work), and rests now and then (the kernel stops a real-time process that never sleeps). What the
    feed has said may still be on its way: while the newest measurement is older than `OLD_S` it ticks on
    time."""

    overruns = 0
    work_s, rest_s = 0.05, 0.01

    def __init__(self, rate_hz: float, mark: Mark | None = None, age_s: Callable[[], float] = lambda: 0.0):
        self.period_s, self._index, self._mark, self._age_s = 1.0 / rate_hz, 0, mark, age_s
        # of the first tick: the feed may take a while to connect
        self._start_s = self._wall_s = self._rested_s = 0.0

    def wait(self) -> Instant:
        if self._index == 0:
            self._start_s, self._wall_s = time.monotonic(), time.time()
        if self._age_s() > OLD_S:
            time.sleep(self.period_s)
        if time.monotonic() - self._rested_s > self.work_s:
            time.sleep(self.rest_s)
            self._rested_s = time.monotonic()
        at = self._index * self.period_s
        if self._mark is not None:
            self._wait_for_feed(self._mark, self._wall_s + at - LAG_S)
        self._index += 1
        return Instant(self._index - 1, self._start_s + at, self._wall_s + at)

    def slack_s(self) -> None:
        return None

    def _wait_for_feed(self, mark: Mark, wall_s: float) -> None:
        if self._index * self.period_s <= LAG_S:
            return
        until = time.monotonic() + FEED_S
        while mark.read() < wall_s:
            if time.monotonic() > until:
                raise SystemExit("the feed has stopped")
            time.sleep(5e-5)


class StopWatch:
    """A clock around a clock: WARM_UP ticks, `steps` that are measured, `parts` with a watch on each part."""

    def __init__(self, clock: Any, steps: int, parts: int):
        self.clock, self.steps, self.parts, self.index = clock, steps, parts, 0
        self.times, self.late = array("f", bytes(4 * steps)), array("f", bytes(4 * steps))
        self.at: dict[str, Any] = {}  # tick number -> what to do before it
        self._began = 0

    def wait(self) -> Instant | None:
        ended, step = time.perf_counter_ns(), self.index - WARM_UP - 1
        if 0 <= step < self.steps:
            self.times[step] = (ended - self._began) * 1e-3
        if self.index == WARM_UP + self.steps + self.parts:
            return None
        if self.index in self.at:
            self.at[self.index]()
        instant: Instant = self.clock.wait()
        if 0 <= step + 1 < self.steps:
            self.late[step + 1] = instant.late_s * 1e6
        self.index += 1
        self._began = time.perf_counter_ns()
        return instant

    def slack_s(self) -> float | None:
        return self.clock.slack_s()  # type: ignore[no-any-return]


class MeasuredLoop:
    """One service, and what was seen of it."""

    def __init__(self, path: str, mark: str, steps: int, parts: int, paced: bool):
        self.settings, self.mark = config.load(path), Mark(mark)
        self.modes: dict[str, int] = {}
        self.steps, self.parts, self.paced = steps, parts, paced
        self.seen: list[
            tuple[ProcessMemory, int, int, float]
        ] = []  # memory, messages, overruns, processor time
        self.watches: Any = None
        self.last: Any = None

    def run(self) -> dict[str, Any]:
        with opened(self.settings, self._clock) as service:
            self.loop, self.bus = service.loop, service.bus
            end = WARM_UP + self.steps
            self.watch.at = {WARM_UP: self._look, WARM_UP + self.steps // 10: self._look, end: self._finish}
            _connect(self.bus)
            service.run(Stop(), None, self._keep)
            if not self.parts:
                self._look()
        assert service.recorder is not None
        return self._result() | {"log": service.recorder.state._asdict()}

    def _clock(self, rate_hz: float) -> Clock:
        clock: Clock = MonotonicClock(rate_hz) if self.paced else FastClock(rate_hz, self.mark, self._age_s)
        self.watch = StopWatch(clock, self.steps, self.parts)
        return self.watch

    def _age_s(self) -> float:
        """Of the newest heading, by the loop's own clock; infinite before there is one."""
        seen = self.loop.last
        return seen.measured.now_s - seen.measured.time.get("psi", -math.inf) if seen else 0.0

    def _keep(self, tick: Any) -> None:
        self.last = tick
        if self.watch.index > WARM_UP:
            self.modes[tick.mode] = self.modes.get(tick.mode, 0) + 1

    def _look(self) -> None:
        clock = self.watch.clock
        self.seen.append((memory(), self.bus.state.received, clock.overruns, time.process_time()))

    def _finish(self) -> None:
        self._look()
        self.watches = self.loop.measure_parts()

    def _result(self) -> dict[str, Any]:
        (_, received, overruns, used), (early, *_), (end, received_2, overruns_2, used_2) = self.seen[:3]
        period_us = self.loop.period_s * 1e6
        return {
            "step_us": quantiles(self.watch.times),
            "wake_up_us": quantiles(self.watch.late),
            "missed_deadlines": overruns_2 - overruns,
            "longer_than_period": sum(t > period_us for t in self.watch.times),
            "messages_per_step": round((received_2 - received) / self.steps, 2),
            "cpu_us_per_step": round((used_2 - used) / self.steps * 1e6, 1),
            "memory": end._asdict(),
            "growth_mb": round(end.now_mb - early.now_mb, 2),
            "growth_anon_mb": round(end.anon_mb - early.anon_mb, 2),
            "mode": max(self.modes, key=lambda mode: self.modes[mode]),
            "modes": self.modes,
            "reasons": list(self.last.reasons),
            "learned_weight": self.last.learned.weight,
            "notes": self.loop.notes,
            "parts_us": self._parts(),
        }

    def _parts(self) -> dict[str, dict[str, float]]:
        ns = self.watches.ns if self.watches else {}
        return {part: _times([n * 1e-3 for n in times]) for part, times in ns.items()}


def _times(us: list[float]) -> dict[str, float]:
    """Median, p99 and mean: a part that works only in some ticks has a small median and a fair mean."""
    return quantiles(us, ("median", "p99")) | {"mean": round(sum(us) / len(us), 2)}


def _connect(bus: Any) -> None:
    until = time.monotonic() + CONNECT_S
    while not bus.state.connected and time.monotonic() < until:
        time.sleep(0.05)
    if not bus.state.connected:
        raise SystemExit("nobody connected: the feed did not start")


if __name__ == "__main__":
    code = 1
    try:
        _, settings, mark, steps, parts, pace = sys.argv
        print(json.dumps(MeasuredLoop(settings, mark, int(steps), int(parts), pace == "paced").run()))
        code = 0
    except BaseException:
        import traceback  # which the service does without

        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)

"""Whose clock is it? Sources' time stamps put on the twin's monotonic clock.

    t = stamp - (wall - monotonic) - offset        offset: the source's clock less ours [s]

A wall clock may be stepped by an hour while the ship sails on (NTP, a leap second, a hand), and an
instrument's may never have been right. So each source has an offset of its own, for each channel. It is 0
until the source's samples show otherwise, and a step of our own clock changes it by as much at once: nothing
is thrown away because a clock was set. How the offset is learned: `SourceClock`.
"""

from math import inf, isfinite

from twin.live.keelson.source_clock import LATE_S, SourceClock
from twin.live.signals.readings import Quality, Reading

LATEST_S = 4102444800.0  # the year 2100: no recorded stamp is later
YEAR_S = 366.0 * 86400.0  # no two that follow each other in a record are farther apart
STEP_S = 0.2  # a wall clock that moves by more against the monotonic one was set
FORGET_S = 120.0  # after a step of our clock a source's may follow, and a silent source is spoken of
STEPS = 4  # steps of our clock remembered
SOURCES = 512  # a hostile sender cannot fill the memory: beyond that, offsets are those of our own clock
SAID = 0.05  # s: a smaller offset is not worth a word


class Stamps:
    """Puts stamps on the monotonic clock, and refuses those that are too old or lie ahead."""

    def __init__(self, max_delay_s: float = 2.0, max_ahead_s: float = 0.5):
        self.max_delay_s, self.max_ahead_s = max_delay_s, max_ahead_s
        self._base: float | None = None  # wall - monotonic without the steps of our clock
        self._stepped = 0.0  # sum of those steps
        self._steps: list[tuple[float, float]] = []  # when, by how much
        self._clocks: dict[tuple[str, str], SourceClock] = {}
        self._other = 0.0  # what another source's clock was last found to be off

    def observe(self, now_s: float, wall_s: float) -> float:
        """Look at the twin's own two clocks; returns by how much the wall clock was just set (0.0: it was
        not) [s]."""
        base = wall_s - now_s - self._stepped
        if self._base is None:
            self._base = base
        step = base - self._base
        self._steps = [(t, by) for t, by in self._steps if now_s - t <= FORGET_S]
        if abs(step) <= STEP_S:
            self._base = base
            return 0.0
        self._stepped += step
        self._base = wall_s - now_s - self._stepped
        self._steps = [*self._steps, (now_s, step)][-STEPS:]
        return step

    def on_monotonic(self, reading: Reading) -> tuple[float, Quality]:
        """When it was measured [s, monotonic], and whether that may be."""
        if not isfinite(reading.time_s):
            return reading.received_s, Quality.NO_TIMESTAMP
        if self._base is None:
            self._base = reading.time_s - reading.received_s
        clock = self._clock(reading)
        delay_s = clock.delay(reading.received_s - reading.time_s + self._base, reading, self._others(clock))
        if clock.offset != self._stepped:
            self._other = clock.offset
        return min(reading.received_s - delay_s, reading.received_s), self._judge(delay_s)

    def reasons(self, now_s: float) -> list[str]:
        """Whose clock is not ours, and by how much, in words."""
        found: dict[str, float] = {}
        for (source, _), clock in self._clocks.items():
            off = clock.offset - self._stepped
            if abs(off) > abs(found.get(source, SAID)) and now_s - clock.heard_s < FORGET_S:
                found[source] = off
        return [
            f"clock of {source}: {abs(off):.1f} s {'ahead of' if off > 0.0 else 'behind'} this computer's; "
            "its stamps are corrected by that"
            for source, off in found.items()
        ]

    def unsure(self, now_s: float) -> str:
        """Whose samples may be late instead of its clock being behind, in words; "" when nobody's."""
        for (source, _), clock in self._clocks.items():
            if not clock.sure and now_s - clock.heard_s < FORGET_S:
                said = "it may be behind, or its samples come late. Set that clock by this computer's"
                return f"clock of {source}: {said}"
        return ""

    def _clock(self, reading: Reading) -> SourceClock:
        """The source's clock as this channel shows it; a new one is taken to be ours as it is now."""
        key = reading.source, reading.channel
        clock = self._clocks.get(key)
        if clock is None:
            clock = SourceClock(self._stepped, min(LATE_S, self.max_delay_s))
            if len(self._clocks) >= SOURCES:
                self._clocks = {
                    k: c for k, c in self._clocks.items() if reading.received_s - c.heard_s < FORGET_S
                }
            if len(self._clocks) < SOURCES:
                self._clocks[key] = clock
        return clock

    def _others(self, clock: SourceClock) -> list[float]:
        """What else the offset may be: as before and after the last steps of our clock; for a new source,
        what another's is."""
        others = [clock.offset + sign * by for _, by in reversed(self._steps) for sign in (1.0, -1.0)]
        return others if clock.last_s > -inf else [*others, self._other]

    def _judge(self, delay_s: float) -> Quality:
        if delay_s > self.max_delay_s:
            return Quality.OLD
        return Quality.FUTURE if delay_s < -self.max_ahead_s else Quality.OK

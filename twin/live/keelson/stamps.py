"""Whose clock is it? Sources' time stamps put on the twin's monotonic clock.

    t = stamp - (wall - monotonic)

A wall clock may be stepped by an hour while the ship sails on (NTP, a leap second, a hand). So the twin
remembers the offset from before a step beside the one after it, and each source may keep either: nothing is
thrown away because a clock was set.
"""

from math import isfinite

from twin.live.signals.readings import Quality, Reading

LATEST_S = 4102444800.0  # the year 2100: no recorded stamp is later
YEAR_S = 366.0 * 86400.0  # no two that follow each other in a record are farther apart
STEP_S = 0.2  # a wall clock that moves by more against the monotonic one was set
FORGET_S = 120.0  # how long the offset from before a step is remembered


class Stamps:
    """Puts stamps on the monotonic clock, and refuses those that are too old or lie ahead."""

    def __init__(self, max_delay_s: float = 2.0, max_ahead_s: float = 0.5):
        self.max_delay_s, self.max_ahead_s = max_delay_s, max_ahead_s
        self._offset: float | None = None  # wall - monotonic, now
        self._before: float | None = None  # the same before the last step
        self._stepped_s = 0.0
        self._keeps_before: set[str] = set()  # sources whose clock did not take part in the step

    def observe(self, now_s: float, wall_s: float) -> float:
        """Look at the twin's own two clocks; returns by how much the wall clock was just set (0.0: it was
        not) [s]."""
        offset = wall_s - now_s
        if self._offset is None:
            self._offset = offset
        step = offset - self._offset
        if abs(step) > STEP_S:
            self._before, self._stepped_s = self._offset, now_s
            self._keeps_before.clear()
        elif self._before is not None and now_s - self._stepped_s > FORGET_S and not self._keeps_before:
            self._before = None
        self._offset = offset
        return step if abs(step) > STEP_S else 0.0

    def on_monotonic(self, reading: Reading) -> tuple[float, Quality]:
        """When it was measured [s, monotonic], and whether that may be."""
        if not isfinite(reading.time_s):
            return reading.received_s, Quality.NO_TIMESTAMP
        if self._offset is None:
            self._offset = reading.time_s - reading.received_s
        t = reading.time_s - self._offset
        quality = self._judge(reading.received_s - t)
        if self._before is not None:
            t_before = reading.time_s - self._before
            kept = self._judge(reading.received_s - t_before) is Quality.OK
            if kept and quality is not Quality.OK:
                self._keeps_before.add(reading.source)
                t, quality = t_before, Quality.OK
        return min(t, reading.received_s), quality

    def _judge(self, delay_s: float) -> Quality:
        if delay_s > self.max_delay_s:
            return Quality.OLD
        return Quality.FUTURE if delay_s < -self.max_ahead_s else Quality.OK

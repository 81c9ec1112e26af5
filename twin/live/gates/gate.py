"""One channel's gate: which of its samples may be used, by the memory of those before.

A sample is refused when another source already speaks for the channel, when its stamp repeats or runs
backwards, when it changed faster than a ship can, or when the instrument is frozen. A step that lasts is
believed after SETTLE_S, and announced.
"""

from math import exp, isfinite

from twin.live.gates.frozen import Frozen
from twin.live.signals.channels import Channel
from twin.live.signals.readings import Quality, Reading

SETTLE_S = 1.2  # how long a step must last before it is believed
SETTLE_SAMPLES = 3
LEARN = 10  # samples until the channel's own rhythm is known
WINDOW_S = 3.0  # memory of the sample rate


class Gate:
    """The last good sample of one channel (`value` in border units, at `time_s` on the monotonic clock)
    and its quality."""

    def __init__(
        self, channel: Channel, allowance: float, frozen: Frozen | None = None, source: str | None = None
    ):
        self.channel, self.allowance = (
            channel,
            allowance,
        )  # `allowance`: what noise may add to a change, border units
        self.chosen = source  # the only source that may speak, if the owner chose one
        self.low, self.high = channel.low, channel.high
        self.value: float | None = None
        self.time_s, self.received_s, self.expires_s = -1e18, -1e18, -1e18
        self.source = self.rival = ""
        self.rival_s = -1e18
        self.refused, self.refusal, self.refused_s = 0, Quality.OK, -1e18
        self.step = 0.0  # by how much the value was reset with the last sample
        self.interval_s, self.samples = 0.0, 0
        self._frozen = frozen
        self._stamp = -1.0
        self._candidate: tuple[float, float, float, int] | None = None  # value, time, first time, count
        self._rate, self._rate_s = 0.0, 0.0

    def accept(self, reading: Reading, t: float, motion: float = 0.0) -> Quality:
        """Judge one sample measured at `t`; `motion` is how fast the ship's motion changes this channel
        [unit/s]."""
        self.step = 0.0
        quality = self._judge(reading, t, motion)
        if quality is Quality.OK:
            self._store(reading, t)
        elif quality is not Quality.DUPLICATE and not (self.chosen and quality is Quality.CONFLICT):
            self.refuse(quality, reading.received_s)
        return quality

    def refuse(self, quality: Quality, received_s: float) -> None:
        """Remember that a sample was refused, and why."""
        self.refused, self.refusal, self.refused_s = self.refused + 1, quality, received_s

    def stale_s(self) -> float:
        """The age after which the channel counts as lost: ten of its own periods, at least 1 s, at most
        the table's limit."""
        if self.samples < LEARN:
            return self.channel.stale_s
        return min(max(10.0 * self.interval_s, 1.0), self.channel.stale_s)

    def lost(self, now_s: float) -> bool:
        """Whether the last good sample is too old at `now_s` [s]."""
        return now_s > self.expires_s

    def quality(self, now_s: float) -> Quality:
        """May what the channel says now be used?"""
        if self.received_s < self.refused_s and now_s - self.refused_s < self.channel.stale_s:
            return self.refusal
        if self.value is None:
            return Quality.NEVER_SEEN
        if self.lost(now_s):
            return Quality.STALE
        return Quality.CONFLICT if not self.chosen and now_s - self.rival_s < 2.0 else Quality.OK

    def losing(self, now_s: float) -> bool:
        """Whether less than 60 % of the usual samples arrive."""
        if self.samples < 3 * LEARN or not 0.0 < self.interval_s < 1.0:
            return False
        return self._rate * exp((self._rate_s - now_s) / WINDOW_S) < 0.6 / self.interval_s

    def _judge(self, reading: Reading, t: float, motion: float) -> Quality:
        if not self.low <= reading.value <= self.high:
            return Quality.OUT_OF_RANGE if isfinite(reading.value) else Quality.NOT_FINITE
        if self.chosen is not None and reading.source != self.chosen:
            return Quality.CONFLICT
        if reading.source != self.source and self.source and not self.lost(reading.received_s):
            self.rival, self.rival_s = reading.source, reading.received_s
            return Quality.CONFLICT
        if reading.time_s == self._stamp:
            return Quality.DUPLICATE
        if self.value is None:
            return Quality.OK
        dt = t - self.time_s
        if dt <= 0.0:
            return Quality.OUT_OF_ORDER
        gap = abs(reading.value - self.value)
        if gap > self.allowance and dt < 3.0 * self.stale_s() and self._jumped(reading.value, self.value, dt):
            return self._settle(reading.value, t, motion * dt)
        self._candidate = None
        if self._frozen is not None and self._frozen.stuck(reading.value, t, motion):
            self._stamp = reading.time_s
            return Quality.FROZEN
        return Quality.OK

    def _jumped(self, value: float, before: float, dt: float) -> bool:
        return abs(self.difference(value, before)) > self.allowance + self.channel.max_rate * dt

    def difference(self, value: float, before: float) -> float:
        """value - before, the short way round for an angle."""
        period = self.channel.period
        return (value - before + 0.5 * period) % period - 0.5 * period if period else value - before

    def _settle(self, value: float, t: float, way: float) -> Quality:
        """A jump: refused, until later samples have agreed with it for long enough."""
        before = self._candidate
        if before is None or self._jumped(value, before[0], max(t - before[1], 1e-3)):
            self._candidate = (value, t, t, 1)
            return Quality.JUMP
        self._candidate = (value, t, before[2], before[3] + 1)
        if t - before[2] < SETTLE_S or before[3] + 1 < SETTLE_SAMPLES:
            return Quality.JUMP
        self.step = self.difference(value, self.value + way)  # type: ignore[operator]
        self._candidate = None
        return Quality.OK

    def _store(self, reading: Reading, t: float) -> None:
        dt, received_s = t - self.time_s, reading.received_s
        if dt < 60.0 and self.value is not None:
            self.samples += 1
            usual = self.interval_s
            late = 3.0 * usual if 0.0 < 3.0 * usual < dt else dt
            self.interval_s = usual + (late - usual) * (1.0 / self.samples if self.samples < 500 else 0.002)
        gone = (received_s - self._rate_s) / WINDOW_S
        self._rate = (
            self._rate / (1.0 + gone + 0.5 * gone * gone) if gone > 0.0 else self._rate
        ) + 1.0 / WINDOW_S
        self._rate_s = received_s
        self.value, self.time_s, self.received_s = reading.value, t, received_s
        self.source, self._stamp = reading.source, reading.time_s
        self.expires_s = t + self.stale_s()

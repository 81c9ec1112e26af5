"""By how much a source's clock differs from ours, learned from when its samples arrive.

    delay = received - stamp + (wall - monotonic) + offset

No sample arrives before it was measured, and on board none takes more than LATE_S. So as long as one sample
in a few seconds has a delay between these, the stamps are believed as they are, however late the others come.
When none has, for SETTLE_S, the offset is moved by the smallest delay among them (the third smallest: two
wild stamps move nothing), so that the slow ones of a busy bus are not taken for a clock. A transport that
begins to delay holds the samples up first, by as much; where none was held up, the clock was set, and SET_S
are enough. What is more than MOST_S off is no clock that was set badly but a recording, or not a clock at
all.
"""

from math import inf

from twin.live.signals.readings import Reading

# delays that need no explanation: clocks kept by NTP, instruments and bus of a ship
AHEAD_S, LATE_S = 0.1, 0.5
SETTLE_S, SET_S = 5.0, 1.0
SAMPLES = 3
MOST_S = 30.0


class SourceClock:
    """One source's clock as one of its channels shows it: `offset` is its clock less ours without the steps
    ours made [s]; `sure`: it cannot be the transport instead."""

    __slots__ = (
        "_ahead",
        "_late_s",
        "_needed_s",
        "_run_s",
        "_smallest",
        "_stamp",
        "_usual",
        "heard_s",
        "last_s",
        "offset",
        "sure",
    )

    def __init__(self, offset: float, late_s: float = LATE_S):
        self.offset, self.sure, self._late_s = offset, True, late_s
        # when a sample came, and one with a delay that needs no explanation
        self.heard_s, self.last_s = -inf, -inf
        self._stamp = -inf
        self._usual = 0.0  # the last such delay
        self._ahead = False
        # samples in a row outside, on one side
        self._run_s, self._needed_s, self._smallest = 0.0, 0.0, list[float]()

    def delay(self, plain_s: float, reading: Reading, others: list[float]) -> float:
        """How long this sample was on its way [s]; `plain_s`: the same with an offset of 0, `others`: what
        the offset may be instead."""
        before_s, self.heard_s = self.heard_s, reading.received_s
        new = reading.time_s != self._stamp
        self._stamp = reading.time_s
        delay_s = plain_s + self.offset
        if not self._explained(delay_s):
            for offset in others:
                if self._explained(plain_s + offset):
                    self.offset, self.sure, delay_s = offset, True, plain_s + offset
                    break
        if self._explained(delay_s):
            self._smallest.clear()
            self.last_s, self._usual = reading.received_s, delay_s
        elif new and abs(delay_s) <= MOST_S:
            self._learn(delay_s, reading.received_s, before_s)
        return plain_s + self.offset

    def _learn(self, delay_s: float, now_s: float, before_s: float) -> None:
        """One more in a row that lies outside; enough of them move the offset."""
        if not self._smallest or self._ahead != (delay_s < 0.0):
            self._ahead, self._run_s = delay_s < 0.0, now_s
            self._smallest.clear()
            held_up = now_s - before_s >= 0.5 * (delay_s - self._usual)  # also where nothing came before
            self._needed_s = SETTLE_S if delay_s > 0.0 and held_up else SET_S
        self._smallest = sorted([*self._smallest, delay_s])[:SAMPLES]
        if len(self._smallest) == SAMPLES and now_s - self._run_s >= self._needed_s - 1e-9:
            self.offset -= self._smallest[-1]
            self.sure = self._needed_s == SET_S
            self._smallest.clear()

    def _explained(self, delay_s: float) -> bool:
        return -AHEAD_S <= delay_s <= self._late_s

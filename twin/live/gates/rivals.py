"""Two receivers of one quantity: do they stay together?

The gate believes one source of a channel; what another says is refused, but compared. Their difference is
learned while they agree (two compasses, two antennas apart); one that walks away is named, though not which
of the two is wrong.
"""

from twin.live.gates.cusum import Cusum
from twin.live.gates.gate import Gate
from twin.live.signals.readings import Reading

BLOCK_S = 4.0
FORGET_S = 20.0  # a rival that has not spoken for so long is spoken of no more
# least scale and greatest difference that is usual, in what noise may add to a change (Gate.allowance)
LEAST_SCALE, GREATEST_DIFFERENCE = 0.1, 1.0
PAIRS = 64  # a hostile sender cannot fill the memory
PLACES = {"north_m": 0, "east_m": 1}
APART_M = 150.0  # antennas of one ship


class Rivals:
    """`compare` is asked for each sample that a second source gave; `reasons` say which sources part."""

    def __init__(self) -> None:
        self._pairs: dict[tuple[str, str, str], RivalPair] = {}

    def reasons(self, now_s: float) -> list[str]:
        """Which sources part at `now_s` [s], in words; a rival not heard for FORGET_S is forgotten."""
        return [
            f"{name}: {used} and {other} walk apart; one of the two is wrong"
            for (name, used, other), pair in self._pairs.items()
            if pair.test.alarm and now_s - pair.heard_s < FORGET_S
        ]

    def compare(self, gate: Gate, reading: Reading, t: float, motion: float) -> None:
        """A rival's sample, measured at `t`, beside the last one that was believed, carried to that time."""
        if (
            gate.value is None
            or not gate.source
            or abs(t - gate.time_s) > 2.0
            or not gate.low <= reading.value <= gate.high
        ):
            return
        key = gate.channel.name, gate.source, reading.source
        pair = self._pairs.get(key)
        if pair is None:
            if len(self._pairs) >= PAIRS:
                self._pairs = {
                    k: p for k, p in self._pairs.items() if reading.received_s - p.heard_s < FORGET_S
                }
            if len(self._pairs) >= PAIRS:
                return
            pair = self._pairs[key] = RivalPair(gate)
        pair.feed(gate.difference(reading.value, gate.value) - motion * (t - gate.time_s), reading.received_s)


class RivalPair:
    """The mean difference of two sources over blocks of time."""

    def __init__(self, gate: Gate):
        allowance = min(gate.allowance, 10.0)
        most = APART_M if gate.channel.name in PLACES else GREATEST_DIFFERENCE * allowance
        self.test = Cusum(LEAST_SCALE * allowance, most)
        self.heard_s = -1e18
        self._sum, self._count, self._since_s = 0.0, 0, -1e18

    def feed(self, difference: float, now_s: float) -> None:
        """One difference, measured at `now_s` [s]; a block that is full goes to the test."""
        if now_s - self.heard_s > FORGET_S:
            self._sum, self._count, self._since_s = 0.0, 0, now_s
        self.heard_s = now_s
        self._sum, self._count = self._sum + difference, self._count + 1
        if now_s - self._since_s >= BLOCK_S:
            self.test.feed(self._sum / self._count)
            self._sum, self._count, self._since_s = 0.0, 0, now_s

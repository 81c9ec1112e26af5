"""The live bound of the observer's error, tick by tick, through measurements, drop-outs and changing seas.

    before the measurements of a tick:   E = V p + push d(H_s) + calm
    with one (row by row):               p = W p + again max(E) + drift max(p) + c
    without:                             p = E, and what a rejected sample was allowed to pull

The matrices are those of twin/live/certificate/theorem.py.
"""

from collections import deque
from typing import TYPE_CHECKING

from twin.live.certificate.comparison import add, apply, scaled_row
from twin.live.observer.operating import NU, WORDS
from twin.physics.state import Situation

if TYPE_CHECKING:
    from twin.live.certificate.certificate import Certificate

NOTHING = 1e9  # a bound so wide that it says nothing: hours without a measurement, or no certificate

Three = tuple[float, float, float]
STILL = (0.0, 0.0, 0.0)


class Highest:
    """The greatest of the last so many values, in a time that does not grow with their number."""

    __slots__ = ("count", "kept", "size")

    def __init__(self, size: int, *first: float) -> None:
        self.size, self.count = size, 0
        self.kept: deque[tuple[int, float]] = deque()  # falling values with the number each came as
        for x in first:
            self.push(x)

    def push(self, x: float) -> float:
        """Take one more; the greatest of the window with it."""
        kept = self.kept
        while kept and kept[-1][1] <= x:
            kept.pop()
        kept.append((self.count, x))
        self.count += 1
        if kept[0][0] <= self.count - 1 - self.size:
            kept.popleft()
        return kept[0][1]


class Tube:
    """|nu_hat - nu| <= beta, component by component [m/s, m/s, rad/s], as long as the assumptions hold."""

    def __init__(self, certificate: "Certificate", start: Three | None = None) -> None:
        """`start` bounds the error of the first estimate; by default that is a measurement, so its noise."""
        self.certificate = certificate
        self.window = 2 * max(certificate.delays) + 1
        self.way: Three  # how fast she can change her motion in the sea of the last step [m/s2, m/s2, rad/s2]
        self._rows(0.0)
        self.reset(start)

    def reset(self, start: Three | None = None) -> None:
        """Begin anew, after the observer was set to a measurement."""
        self.beta: Three = self.certificate.noise if start is None else start
        self._after, self._before = ([Highest(self.window, b) for b in self.beta] for _ in range(2))
        self._widest = self.beta  # greatest after of the window
        self._seas = Highest(self.window)
        self._pulls: deque[Three] = deque(maxlen=self.window)
        self._sea = -1.0  # the highest in the window, for which the rows below were made

    def step(self, received: tuple[bool, bool, bool], H_s: float = 0.0, pulled: Three = STILL) -> Three:
        """The bound after this tick; `received` says which of u, v, r was measured and accepted.

        `pulled`: by how much a sample that was not accepted may have moved the estimate all the same.
        """
        if self._sea != (high := self._seas.push(H_s)):
            self._sea = high
            self._rows(high)
        pu, pv, pr = self._widest
        u, v, r = self.beta
        beta = []
        for i, (v0, v1, v2, d, w0, w1, w2, again, d0, d1, d2, c) in enumerate(self._table):
            E = min(v0 * u + v1 * v + v2 * r + d, NOTHING)
            widest = self._before[i].push(E)
            if received[i]:
                E = w0 * u + w1 * v + w2 * r + again * widest + d0 * pu + d1 * pv + d2 * pr + c
            beta.append(E)
        if pulled is not STILL or self._pulls:
            beta = self._and_pulled(beta, received, pulled)
        u, v, r = self.beta = beta[0], beta[1], beta[2]
        first, second, third = self._after
        self._widest = first.push(u), second.push(v), third.push(r)
        return self.beta

    def _and_pulled(self, beta: list[float], received: tuple[bool, bool, bool], pulled: Three) -> list[float]:
        """A rejected sample's pull counts in full now, and shows in late measurements for a while."""
        step = self.certificate.step
        late = [
            step.before[i] * step.pull[i] * max((p[i] for p in self._pulls), default=0.0) for i in (0, 1, 2)
        ]
        self._pulls.append(pulled)
        if not any(any(p) for p in self._pulls):
            self._pulls.clear()
        return [b + (late[i] if received[i] else pulled[i]) for i, b in enumerate(beta)]

    def _rows(self, H_s: float) -> None:
        """For each axis (V, d, W, again, drift, c) in this sea."""
        c = self.certificate
        pushed = apply(c.push, c.disturbance.at(H_s))
        step, d = c.step, add(pushed, c.calm)
        self.way = add(c.plant.most, scaled_row(1.0 / c.h, pushed))
        told = step.told(d, c.noise)
        self._table = tuple(
            (*step.V[i], d[i], *step.now[i], step.again[i], *step.drift[i], told[i]) for i in (0, 1, 2)
        )

    @property
    def widest(self) -> Three:
        """The greatest bound of the window that a measurement of greatest age looks back on."""
        return self._widest

    def outside(self, s: Situation, within: Three | None = None) -> str | None:
        """What leaves the operating set, or may within a sample, in words; None when the ship is surely in
        it. `within`: how far she may be from the estimate, where that is known better than by the tube."""
        return self.certificate.operating.outside(
            s, add(within or self.beta, scaled_row(self.certificate.h, self.way))
        )

    def says_nothing(self) -> str | None:
        """In words, while the bound is as wide as the operating set itself; else None."""
        ranges = self.certificate.operating.ranges
        for name, b in zip(NU, self.beta, strict=True):
            low, high = ranges[name]
            if not b < 0.5 * (high - low):
                return f"the bound of {WORDS[name]}, {b:.3g}, is as wide as the operating set"
        return None

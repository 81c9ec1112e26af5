"""The live bound of the observer's error, tick by tick, through measurements, drop-outs and changing seas.

    with a measurement:     beta+ = now beta + past max(last 2m+1 beta) + push d(H_s) + rest
    without (row by row):   beta+ = coast beta + push_coast d(H_s) + rest_coast
"""

from collections import deque

from twin.physics.state import Situation

from .comparison import add, apply
from .theorem import Certificate

NOTHING = 1e9  # a bound so wide that it says nothing: hours without a measurement, or no certificate

Three = tuple[float, float, float]


class Tube:
    """|nu_hat - nu| <= beta, component by component [m/s, m/s, rad/s], as long as the assumptions hold."""

    def __init__(self, certificate: Certificate, start: Three | None = None) -> None:
        """`start` bounds the error of the first estimate; by default it is a first measurement, so its noise."""
        self.certificate = certificate
        self._window = 2 * certificate.delay_samples + 1
        self.reset(start)

    def reset(self, start: Three | None = None) -> None:
        """Begin anew, after the observer was set to a measurement."""
        self.beta: Three = self.certificate.noise if start is None else start
        self._past = tuple(deque((b,), maxlen=self._window) for b in self.beta)
        self._seas: deque[float] = deque(maxlen=self._window)
        self._sea = -1.0  # the highest in the window, for which the rows below were made

    def step(self, received: tuple[bool, bool, bool], H_s: float = 0.0) -> Three:
        """The bound one sample on; `received` says which of u, v, r was measured and accepted this tick."""
        seas, past, (bu, bv, br) = self._seas, self._past, self.beta
        seas.append(H_s)
        if self._sea != (high := max(seas)):
            self._sea = high
            self._with, self._without = self._rows(high)
        wu, wv, wr = max(past[0]), max(past[1]), max(past[2])
        after = []
        for got, measured, missed in zip(received, self._with, self._without):  # noqa: B905 (a tick, not a check)
            a0, a1, a2, p0, p1, p2, g = measured if got else missed
            after.append(min(a0 * bu + a1 * bv + a2 * br + p0 * wu + p1 * wv + p2 * wr + g, NOTHING))
        self.beta = bu, bv, br = after[0], after[1], after[2]
        past[0].append(bu)
        past[1].append(bv)
        past[2].append(br)
        return self.beta

    def _rows(self, H_s: float) -> tuple[tuple[tuple[float, ...], ...], ...]:
        """For each axis (now, past, g) with a measurement and (coast, 0, g) without, in this sea."""
        c = self.certificate
        d = c.disturbance.at(H_s)
        seen, unseen = add(apply(c.push, d), c.rest), add(apply(c.push_coast, d), c.rest_coast)
        return (
            tuple((*c.now[i], *c.past[i], seen[i]) for i in (0, 1, 2)),
            tuple((*c.coast[i], 0.0, 0.0, 0.0, unseen[i]) for i in (0, 1, 2)),
        )

    def inside(self, s: Situation) -> bool:
        """True when the ship is surely in the operating set: the estimate, widened by its bound, and every measured input."""
        return self.outside(s) is None

    def outside(self, s: Situation) -> str | None:
        """What leaves the operating set, in words; None when nothing does."""
        return self.certificate.operating.outside(s, self.beta)

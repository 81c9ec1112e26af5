"""The live bound of the observer's error, tick by tick, through measurements, drop-outs and changing seas.

    with a measurement:     beta+ = now beta + past max(last 2m+1 beta) + push d(H_s) + rest
    without (row by row):   beta+ = coast beta + push_coast d(H_s) + rest_coast
"""

from collections import deque

from twin.physics.state import Situation

from .theorem import Certificate

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
        self._seas: deque[float] = deque((0.0,), maxlen=self._window)

    def step(self, received: tuple[bool, bool, bool], H_s: float = 0.0) -> Three:
        """The bound one sample on; `received` says which of u, v, r was measured and accepted this tick."""
        c, (bu, bv, br), past = self.certificate, self.beta, self._past
        self._seas.append(H_s)
        dX, dY, dN = c.disturbance.at(max(self._seas))
        wu, wv, wr = max(past[0]), max(past[1]), max(past[2])
        after = []
        for i in (0, 1, 2):
            if received[i]:
                a, p, q = c.now[i], c.past[i], c.push[i]
                b = a[0] * bu + a[1] * bv + a[2] * br + p[0] * wu + p[1] * wv + p[2] * wr + c.rest[i]
            else:
                a, q = c.coast[i], c.push_coast[i]
                b = a[0] * bu + a[1] * bv + a[2] * br + c.rest_coast[i]
            after.append(b + q[0] * dX + q[1] * dY + q[2] * dN)
        self.beta = beta = (after[0], after[1], after[2])
        for row, b in zip(past, beta, strict=True):
            row.append(b)
        return beta

    def inside(self, s: Situation) -> bool:
        """True when the ship is surely in the operating set: the estimate, widened by its bound, and every measured input."""
        return self.outside(s) is None

    def outside(self, s: Situation) -> str | None:
        """What leaves the operating set, in words; None when nothing does."""
        return self.certificate.operating.outside(s, self.beta)

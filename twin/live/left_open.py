"""What the instruments alone leave open of the estimate's error, whatever the observer's bound was.

    |nu_hat - nu| <= |nu_hat - y| + n + age (way of a second)     row by row; unmeasured: all that a ship can
"""

from math import pi

from twin.live.certificate.observer_tube import NU, Three, Tube
from twin.live.observer.observer import Observer
from twin.live.observer.operating import WORDS
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.num import num

Bounds = tuple[Three, float]  # of (u, v, r) [m/s, m/s, rad/s] and of psi [rad]


class LeftOpen:
    """Of one tick: `since_late_s` is for how long every tick came in time, `inside_s` for how long the ship
    has surely been in the operating set, where its way of a second is bounded [s]."""

    def __init__(
        self, observer: Observer, measured: Measured, tube: Tube, since_late_s: float, inside_s: float
    ) -> None:
        self._observer, self._measured, self._tube = observer, measured, tube
        self.oldest_s, self._inside_s = min(tube.oldest_s, since_late_s), inside_s

    def in_time(self, attribute: str) -> bool:
        """Measured by its own instrument, not older than the certificate allows, and not from before a late
        tick."""
        return self._own(attribute) and self._measured.age_s(attribute) <= self.oldest_s

    def known(self, attribute: str) -> bool:
        """In time, or measured by its own instrument since it has been inside."""
        return self.in_time(attribute) or (
            self._own(attribute) and self._measured.age_s(attribute) <= self._inside_s
        )

    def _own(self, attribute: str) -> bool:
        return attribute in self._measured.si and attribute not in self._measured.derived

    @property
    def bounds(self) -> Bounds:
        """What the estimate is off by at most."""
        e, measured, tube = self._observer.estimate, self._measured, self._tube
        u, v, r = (
            abs(measured.si[a] - now) + noise + measured.age_s(a) * way if self.known(a) else 2.0 * most
            for a, now, noise, way, most in zip(
                NU, (e.u, e.v, e.r), tube.noise, tube.way, self._observer.most, strict=True
            )
        )
        return (u, v, r), self._heading()

    def _heading(self) -> float:
        if not self.known("psi"):
            return pi
        off = abs(turn(self._measured.si["psi"] - self._observer.estimate.psi))
        return off + self._tube.heading_noise + self._measured.age_s("psi") * self._observer.most[2]

    def unknown(self, guessed: tuple[str, ...], heard: set[str]) -> str:
        """Why nothing is known of the first of these speeds and rate of turn; "" where there is none.
        `heard`: which of them an instrument of their own ever measured."""
        if not guessed:
            return ""
        a, measured = guessed[0], self._measured
        name = WORDS[a]
        if a not in heard:
            return f"{name} is not measured yet"
        if a not in measured.si or a in measured.derived:
            return f"{name} is not measured"
        return (
            f"{name} is not measured often enough, age = {num(measured.age_s(a), 2)} s where at most "
            f"{num(self.oldest_s, 2)} s are certified"
        )


def least(a: Bounds, b: Bounds) -> Bounds:
    """Of two bounds that both hold the lesser, row by row."""
    u, v, r = (min(x, y) for x, y in zip(a[0], b[0], strict=True))
    return (u, v, r), min(a[1], b[1])

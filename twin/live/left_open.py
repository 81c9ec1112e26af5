"""What the instruments alone leave open of the estimate's error, whatever the observer's bound was.

|nu_hat - nu| <= |nu_hat - y| + n + age (way of a second)     row by row; unmeasured: all that a ship can
"""

from math import inf, pi

from twin.live.certificate.observer_tube import NU, Three, Tube
from twin.live.observer.observer import Observer
from twin.live.observer.operating import WORDS
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.num import num

BOUNDED = (*NU, "psi")
Bounds = tuple[Three, float]  # of (u, v, r) [m/s, m/s, rad/s] and of psi [rad]


class LeftOpen:
    """Of one tick: `since_late_s` is for how long every tick came in time, `inside_s` for how long the ship
    has surely been in the operating set, where its way of a second is bounded [s]."""

    __slots__ = ("_ages_s", "_measured", "_observer", "_tube", "_wide_s", "oldest_s")

    def __init__(
        self, observer: Observer, measured: Measured, tube: Tube, since_late_s: float, inside_s: float
    ) -> None:
        self._observer, self._measured, self._tube = observer, measured, tube
        self.oldest_s = min(tube.oldest_s, since_late_s)
        self._wide_s = max(self.oldest_s, inside_s)
        si, time, now_s = measured.si, measured.time, measured.now_s
        self._ages_s = {
            a: now_s - time[a] if a in si and a not in measured.derived else inf for a in BOUNDED
        }  # of what an instrument of its own measures

    def distrust(self, attribute: str) -> None:
        """Its samples leave open what they like: they are suspected."""
        self._ages_s[attribute] = inf

    def in_time(self, attribute: str) -> bool:
        """Measured by its own instrument, not older than the certificate allows, and not from before a late
        tick."""
        return self._ages_s[attribute] <= self.oldest_s

    def known(self, attribute: str) -> bool:
        """In time, or measured by its own instrument since it has been inside."""
        return self._ages_s[attribute] <= self._wide_s

    @property
    def bounds(self) -> Bounds:
        """What the estimate is off by at most."""
        e, tube, si, most = self._observer.estimate, self._tube, self._measured.si, self._observer.most
        u, v, r, psi = self._ages_s.values()
        noise, way, far = tube.noise, tube.way, self._wide_s
        return (
            abs(si["u"] - e.u) + noise[0] + u * way[0] if u <= far else 2.0 * most[0],
            abs(si["v"] - e.v) + noise[1] + v * way[1] if v <= far else 2.0 * most[1],
            abs(si["r"] - e.r) + noise[2] + r * way[2] if r <= far else 2.0 * most[2],
        ), (abs(turn(si["psi"] - e.psi)) + tube.heading_noise + psi * most[2] if psi <= far else pi)

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
    (au, av, ar), (bu, bv, br) = a[0], b[0]
    return (min(au, bu), min(av, bv), min(ar, br)), min(a[1], b[1])

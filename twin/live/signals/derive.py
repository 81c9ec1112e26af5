"""What follows from a measurement when its own instrument is missing: speed from positions, rate of turn
from headings, wind.

The filters are critically damped (fading memory): with theta = exp(-omega dt), alpha = 1 - theta^2, beta = (1
- theta)^2, they are stable for every sample interval. The speed is tracked in body axes, so that a steady
turn leaves no lag.
"""

from math import atan2, cos, exp, hypot, pi, sin

COURSE_S, OF_COURSE = 15.0, 0.5  # over which a course is made good, and how much of what it says is believed
READY = 4.0  # time constants until a derived value may be used


class SpeedFromPosition:
    """(u, v) over ground [m/s] from positions [m] and heading [rad]."""

    def __init__(self, omega: float):
        self.omega = omega  # [1/s]
        self.u = self.v = 0.0
        self._x = self._y = 0.0
        self._t: float | None = None
        self._since = 0.0

    def feed(self, x: float, y: float, psi: float, t: float) -> bool:
        """One position; True when (u, v) may be used."""
        if self._t is None or not 0.0 < t - self._t < READY / self.omega:
            return self._restart(x, y, t)
        dt, self._t = t - self._t, t
        c, s = cos(psi), sin(psi)
        self._x += (self.u * c - self.v * s) * dt
        self._y += (self.u * s + self.v * c) * dt
        theta = exp(-self.omega * dt)
        alpha, beta = 1.0 - theta * theta, (1.0 - theta) ** 2 / dt
        ex, ey = x - self._x, y - self._y
        self._x, self._y = self._x + alpha * ex, self._y + alpha * ey
        self.u += beta * (ex * c + ey * s)
        self.v += beta * (ey * c - ex * s)
        return t - self._since > READY / self.omega

    def _restart(self, x: float, y: float, t: float) -> bool:
        if self._t is None or t > self._t:
            self._x, self._y, self._t, self._since = x, y, t, t
        return False


class RateFromHeading:
    """r [rad/s] from headings [rad]."""

    def __init__(self, omega: float):
        self.omega = omega
        self.r = 0.0
        self._psi = 0.0
        self._t: float | None = None
        self._since = 0.0

    def feed(self, psi: float, t: float) -> bool:
        """One heading; True when r may be used."""
        if self._t is None or not 0.0 < t - self._t < READY / self.omega:
            if self._t is None or t > self._t:
                self._psi, self._t, self._since, self.r = psi, t, t, 0.0
            return False
        dt, self._t = t - self._t, t
        error = turn(psi - self._psi - self.r * dt)
        theta = exp(-self.omega * dt)
        self._psi += self.r * dt + (1.0 - theta * theta) * error
        self.r += (1.0 - theta) ** 2 / dt * error
        return t - self._since > READY / self.omega


class CarriedHeading:
    """psi [rad] without a compass: the gyro's rate of turn (the model's, where there is none) carries it, and
    the course that the positions make good puts it right, COURSE_S at a time."""

    def __init__(self, slowest: float):
        self.slowest = slowest  # [m/s] below which a course says nothing
        self.psi = 0.0
        self._t: float | None = None
        self._start: tuple[float, float, float] | None = None  # x, y, time
        self._way = [0.0, 0.0]

    def stop(self) -> None:
        """The compass is back."""
        self._t = None

    def feed(
        self, t: float, psi: float, nu: tuple[float, float, float], place: tuple[float, float] | None
    ) -> float:
        """One tick; `psi` is where it starts from, nu = (u, v, r) over ground, `place` a new position."""
        if self._t is None:
            self.psi, self._t, self._start = psi, t, None
        dt, self._t = t - self._t, t
        u, v, r = nu
        self.psi += r * dt
        c, s = cos(self.psi), sin(self.psi)
        self._way[0] += (u * c - v * s) * dt
        self._way[1] += (u * s + v * c) * dt
        if place is not None:
            self._course(*place, t)
        return self.psi % (2.0 * pi)

    def _course(self, x: float, y: float, t: float) -> None:
        if self._start is not None:
            x0, y0, t0 = self._start
            if t - t0 < COURSE_S:
                return
            made, meant = hypot(x - x0, y - y0), hypot(*self._way)
            if min(made, meant) > self.slowest * (t - t0):
                self.psi += OF_COURSE * turn(atan2(y - y0, x - x0) - atan2(self._way[1], self._way[0]))
        self._start, self._way = (x, y, t), [0.0, 0.0]


def turn(angle: float) -> float:
    """The angle the short way round, in [-pi, pi)."""
    return (angle + pi) % (2.0 * pi) - pi


def true_wind(speed: float, angle_from: float, psi: float, u: float, v: float) -> tuple[float, float]:
    """(speed [m/s], direction it blows to [rad]) over ground, from the wind felt on a ship that moves with
    (u, v)."""
    # the air over ground, body axes
    ahead, starboard = u - speed * cos(angle_from), v - speed * sin(angle_from)
    return hypot(ahead, starboard), (psi + atan2(starboard, ahead)) % (2.0 * pi)


def apparent_wind(speed: float, wind_to: float, psi: float, u: float, v: float) -> tuple[float, float]:
    """(speed [m/s], angle off the bow it comes from [rad], starboard positive) on a ship that moves with
    (u, v)."""
    ahead, starboard = speed * cos(wind_to - psi) - u, speed * sin(wind_to - psi) - v  # the air past the ship
    return hypot(ahead, starboard), turn(atan2(-starboard, -ahead))

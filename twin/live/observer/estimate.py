"""What the observer knows of the ship: its state, how sure it is of each part, and the current it follows."""

from dataclasses import dataclass
from math import cos, sin, sqrt

from twin.live.signals.measured import Measured
from twin.physics.ship import Ship

STATES = ("x", "y", "psi", "u", "v", "r")
A_MAX = 0.5  # no sample pulls more than half way in one tick
HELD = 1.2  # of its usual interval a sample pulls until the next one comes
DELAYED = 0.6  # K times (delay + time that a sample pulls): above about 1 an observer swings
OUTLIER = 4.0  # usual deviations beyond which a sample pulls no more


@dataclass(slots=True)
class Estimate:
    """Where the ship is and how it moves [SI], `sigma` of each, and the current towards north and east
    [m/s]."""

    x: float = 0.0
    y: float = 0.0
    psi: float = 0.0
    u: float = 0.0
    v: float = 0.0
    r: float = 0.0
    sigma: tuple[float, ...] = (0.0,) * 6
    current_north: float = 0.0
    current_east: float = 0.0
    ready: bool = False

    def velocity_ned(self) -> tuple[float, float]:
        """Velocity over ground toward north and east [m/s]."""
        c, s = cos(self.psi), sin(self.psi)
        return self.u * c - self.v * s, self.u * s + self.v * c

    def current_body(self) -> tuple[float, float]:
        """The current in body axes, ahead and to starboard [m/s]."""
        c, s = cos(self.psi), sin(self.psi)
        return self.current_north * c + self.current_east * s, self.current_east * c - self.current_north * s

    def state(self) -> tuple[float, ...]:
        """(x, y, psi, u, v, r) [m, m, rad, m/s, m/s, rad/s]."""
        return self.x, self.y, self.psi, self.u, self.v, self.r


class Doubt:
    """How sure one state is: `sigma` grows while the model runs alone and shrinks with every sample."""

    __slots__ = ("least_spread", "sigma", "spread", "usual")

    def __init__(self, usual: float):
        self.usual, self.least_spread = usual, 0.01 * usual * usual
        self.sigma = 0.0
        self.spread = usual * usual  # mean squared innovation

    def limit(self) -> float:
        """Beyond this an innovation is an outlier."""
        return OUTLIER * sqrt(self.spread + self.sigma * self.sigma)

    def learn(self, gap: float) -> None:
        """What innovations are usual, from one that is within the limit."""
        self.spread += 0.02 * (1.2 * gap * gap + self.least_spread - self.spread)

    def shrink(self, a: float) -> None:
        """A sample pulled by the share a."""
        kept, noise = (1.0 - a) * self.sigma, max(self.spread - self.sigma * self.sigma, self.least_spread)
        self.sigma = sqrt(kept * kept + a * a * noise)


class Sigma:
    """The doubt of all states."""

    def __init__(self, ship: Ship):
        speed, rate, push = 0.03 * ship.U_0, 0.05 * ship.U_0 / ship.L_pp, 0.015 * ship.U_0**2 / ship.L_pp
        # an innovation, to begin with
        usual = {"x": 3.0, "y": 3.0, "psi": 0.01, "u": speed, "v": speed, "r": rate}
        self.of = {state: Doubt(usual[state]) for state in STATES}
        # how fast the model alone goes astray in speed and in turning
        self._astray = push, 1.5 * push / ship.L_pp

    def all(self) -> tuple[float, ...]:
        """Standard deviation of each part of the state, in SI."""
        return tuple([doubt.sigma for doubt in self.of.values()])

    def begin(self, measured: dict[str, float]) -> None:
        """Start: as usual where it was measured, ten times that elsewhere."""
        for state, doubt in self.of.items():
            doubt.sigma = doubt.usual * (1.0 if state in measured else 10.0)

    def begin_one(self, state: str) -> None:
        """Start one part anew, as usual."""
        self.of[state].sigma = self.of[state].usual

    def grow(self, dt: float, speed: float) -> None:
        """The model alone for dt seconds at this speed."""
        x, y, psi, u, v, r = self.of.values()
        moving = (u.sigma + v.sigma + speed * psi.sigma) * dt
        push, twist = self._astray
        x.sigma += moving
        y.sigma += moving
        psi.sigma += r.sigma * dt
        u.sigma += push * dt
        v.sigma += push * dt
        r.sigma += twist * dt


class CurrentFilter:
    """The current over three ship lengths: speed over ground less speed through water, bounded."""

    def __init__(self, ship: Ship, north: float, east: float):
        self.north, self.east = north, east
        self.time_s = 3.0 * ship.L_pp / ship.U_0
        self.bound = min(max(0.6 * ship.U_0, 1.0), 5.0)  # [m/s]

    def feed(self, measured: Measured, e: Estimate) -> tuple[float, float]:
        """Only along those axes of the ship on which both speeds are measured."""
        si, fresh = measured.si, measured.fresh
        if "u_r" not in fresh and "v_r" not in fresh:
            return self.north, self.east
        c, s = cos(e.psi), sin(e.psi)
        for ground, water, axis_north, axis_east in (("u", "u_r", c, s), ("v", "v_r", -s, c)):
            if water in fresh and ground in si:
                a = min(fresh[water] / self.time_s, 0.1)
                gap = si[ground] - si[water] - (self.north * axis_north + self.east * axis_east)
                self.north += a * gap * axis_north
                self.east += a * gap * axis_east
        size = sqrt(self.north * self.north + self.east * self.east)
        if size > self.bound:
            self.north, self.east = self.north * self.bound / size, self.east * self.bound / size
        return self.north, self.east


def gain_for(ship: Ship) -> float:
    """K [1/s] by the ship's own time."""
    return float(12.0 * ship.U_0 / ship.L_pp)


def fastest_gain(h: float, samples: int) -> float:
    """The greatest K [1/s] that acts in full at a period of h seconds, with an instrument heard in each tick
    and as late as that."""
    return min(DELAYED / (HELD + samples), A_MAX) / h

"""Where the ship is and what the stream does at given times, of a problem's states."""

from functools import cached_property

import numpy as np

from twin.study.instruments.problem import Problem
from twin.study.instruments.spline import Weights
from twin.study.instruments.unknowns import INDEX

Theta = np.ndarray


class Here:
    """The path at times t (n,) [s]: its value `x`, slope `v` and second slope `a` (n, 3), worked out when
    asked for, and their weights."""

    def __init__(self, p: Problem, t: np.ndarray) -> None:
        self.p, self.t, self.coefficients = p, t, p.x[p.at[0]]

    @cached_property
    def w(self) -> tuple[Weights, ...]:
        """By which coefficients, (n,) and (n, 4) weights, the value, slope and second slope are made."""
        return tuple(self.p.path.weights(self.t, k) for k in range(3))

    def _curve(self, slope: int) -> np.ndarray:
        return self.p.path.value(self.coefficients, self.p.path.weights(self.t, slope))

    @cached_property
    def x(self) -> np.ndarray:
        """(n, 3) place toward north and east [m] and heading [rad]."""
        return self._curve(0)

    @cached_property
    def v(self) -> np.ndarray:
        """(n, 3) velocity over ground toward north and east [m/s] and rate of turn [rad/s]."""
        return self._curve(1)

    @cached_property
    def a(self) -> np.ndarray:
        """(n, 3) acceleration toward north and east [m/s2] and change of the rate of turn [rad/s2]."""
        return self._curve(2)

    @cached_property
    def c(self) -> np.ndarray:
        """(n,) cosine of the heading [-]."""
        return np.asarray(np.cos(self.x[:, 2]))

    @cached_property
    def s(self) -> np.ndarray:
        """(n,) sine of the heading [-]."""
        return np.asarray(np.sin(self.x[:, 2]))

    def body(self, north: np.ndarray, east: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The parts ahead and to starboard of vectors toward north (n,) and east (n,), in the unit of
        those."""
        return north * self.c + east * self.s, east * self.c - north * self.s


def get(theta: Theta, name: str) -> float:
    """One of the numbers theta (P,), by its name in UNKNOWNS, in its own unit."""
    return float(theta[INDEX[name]])


def stream_at(p: Problem, theta: Theta, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Velocity of the stream toward north and toward east [m/s], each (n,), at times t (n,) [s]: what theta
    (P,) says of the middle of the voyage, and how the states have it wander from there."""
    walk = p.stream.value(p.x[p.at[1]], p.stream.weights(t))
    return walk[:, 0] + get(theta, "current_north"), walk[:, 1] + get(theta, "current_east")

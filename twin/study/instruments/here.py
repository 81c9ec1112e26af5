"""Where the ship is and what the stream does at given times, of a problem's states."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property

import numpy as np

from twin.study.instruments.problem import Problem
from twin.study.instruments.spline import Weights
from twin.study.instruments.unknowns import INDEX

Theta = np.ndarray


class Here:
    """The path at times t (n,) [s]: its value `x`, slope `v` and second slope `a` (n, 3), and the stream's
    walk, worked out when asked for."""

    def __init__(self, p: Problem, t: np.ndarray) -> None:
        self.p, self.t, self.coefficients = p, t, p.x[p.at[0]]
        self._weights: dict[int, Weights] = {}

    def weights(self, slope: int) -> Weights:
        """By which coefficients (n,), and by how much of each (n, 4), the value, slope or second slope is
        made."""
        if slope not in self._weights:
            self._weights[slope] = self.p.path.weights(self.t, slope)
        return self._weights[slope]

    def _curve(self, slope: int) -> np.ndarray:
        return self.p.path.value(self.coefficients, self.weights(slope))

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

    @cached_property
    def slow(self) -> Weights:
        """By which of the stream's coefficients (n,), and by how much of each (n, 2), its walk is made."""
        return self.p.stream.weights(self.t)

    @cached_property
    def walk(self) -> np.ndarray:
        """(n, 2) how far the stream has wandered from that in the middle of the voyage [m/s]."""
        return self.p.stream.value(self.p.x[self.p.at[1]], self.slow)

    def body(self, north: np.ndarray, east: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The parts ahead and to starboard of vectors toward north (n,) and east (n,), in the unit of
        those."""
        return north * self.c + east * self.s, east * self.c - north * self.s


def get(theta: Theta, name: str) -> float:
    """One of the numbers theta (P,), by its name in UNKNOWNS, in its own unit."""
    return float(theta[INDEX[name]])


def stream_at(here: Here, theta: Theta) -> tuple[np.ndarray, np.ndarray]:
    """Velocity of the stream toward north and toward east [m/s], each (n,): what theta (P,) says of the
    middle of the voyage, and how the states have it wander from there."""
    return here.walk[:, 0] + get(theta, "current_north"), here.walk[:, 1] + get(theta, "current_east")


def at(p: Problem, t: np.ndarray, *late_s: float) -> Here:
    """The path at times t (n,) less these [s]; the same one again while the problem's states stay where they
    are (`remembering`). `t`: one of the problem's own arrays."""
    if p.met is None:
        return Here(p, _less(t, late_s))
    key = (id(t), late_s)
    if key not in p.met:
        p.met[key] = Here(p, _less(t, late_s))
    return p.met[key]  # type: ignore[no-any-return]


def _less(t: np.ndarray, late_s: tuple[float, ...]) -> np.ndarray:
    for late in late_s:
        t = t - late
    return t


@contextmanager
def remembering(p: Problem) -> Iterator[None]:
    """While the states stay where they are: most numbers of an instrument do not change when it read."""
    p.met = {}
    try:
        yield
    finally:
        p.met = None

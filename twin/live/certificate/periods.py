"""A tick that lasts longer than the certified period: one longer step of the physics, in which no measurement
counts.

    E = V_j p + push_j d + calm_j + turned_j psi          j whole periods, from a table

What a midpoint taken for one period misses over a longer one is at most (j h)^2/2 of the slope's change, not
a quarter."""

from math import ceil
from typing import NamedTuple

from twin.live.certificate.certificate import Certificate
from twin.live.certificate.comparison_systems import AXES, Matrix, Row, apply, row
from twin.live.certificate.plant import Plant
from twin.live.certificate.recursion import CURVE, pushed, recursion

TABLE = (1, 2, 3, 5, 10, 30)  # periods; a longer tick begins the bound anew
TOO_LONG = 0
LATE_CURVE = 0.5
ROUNDING_SHARE = 1e-6  # share of a period that rounding of the clock may add


class Step(NamedTuple):
    """One tick of so many periods, with no measurement; `turned`: what an error of heading does [m/s/rad,
    1/s]."""

    V: Matrix
    push: Matrix
    calm: Row
    turned: Row

    def pushed(self, force: Row) -> Row:
        """Bound of what a force [N, N, N m] adds to an error in this step [m/s, m/s, rad/s]."""
        return apply(self.push, force)


class Periods:
    """The steps of the table, each worked out once."""

    def __init__(self, h: float, steps: dict[int, Step]) -> None:
        self.h, self._steps = h, steps

    def count(self, dt: float) -> int:
        """The entry of the table that covers dt; TOO_LONG where none does."""
        periods = max(ceil(dt / self.h - ROUNDING_SHARE), 1)
        return next((j for j in TABLE if j >= periods), TOO_LONG)

    def of(self, count: int) -> Step:
        """The step of so many periods; for one too long for the table (0), its longest."""
        return self._steps[count or TABLE[-1]]


def of_certificate(c: Certificate) -> Periods:
    """From the slopes that are on file."""
    return Periods(
        c.h, {j: _step(c.plant.at_period(j * c.h), c, CURVE if j == 1 else LATE_CURVE) for j in TABLE}
    )


def _step(plant: Plant, c: Certificate, curve: float) -> Step:
    push, calm = pushed(plant, 0.0, curve)
    turned = row(plant.h * plant.heading[i] + plant.bend[i][3] for i in AXES)
    return Step(recursion(plant, c.K, c.delays, c.extra_growth).V, push, calm, turned)

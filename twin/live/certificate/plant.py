"""What the stabilizer's theorem needs to know of a ship: how steep its equations are over the operating set,
and how it is disturbed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import Any

from twin.errors import SettingsError
from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.comparison_systems import AXES, Matrix, Row
from twin.live.certificate.set_cells import IN_CELLS, Cells, of_slopes
from twin.live.learning.movable import Movable
from twin.live.observer.operating import OperatingSet
from twin.physics import core
from twin.physics.maths import total
from twin.physics.model import Model
from twin.physics.ship import Ship


@dataclass(frozen=True)
class Plant:
    """Sure bounds over the operating set; SI units, plain numbers, kept as JSON.

    lo, hi: slopes of nu_dot with (u, v, r) [1/s, and m, 1/m where units differ]; heading: greatest slope with
    psi; most: greatest |nu_dot|; inertia: |M^-1|; h: sample period [s]; bend: of a step's slopes beyond I + h
    A (see `at_period`); moved: how far adaptation of the effects' numbers can take nu_dot from the ship
    file's."""

    lo: Matrix
    hi: Matrix
    heading: Row
    most: Row
    inertia: Matrix
    h: float
    operating: OperatingSet
    bend: tuple[tuple[float, ...], ...] = ()
    moved: Row = (0.0, 0.0, 0.0)
    cells: Cells | None = None  # the same, part by part of the set

    @classmethod
    def of_table(cls, table: dict[str, Any]) -> "Plant":
        """From its fields by name, those of set and cells as tables."""
        cells = table["cells"] and Cells(**table["cells"])
        return cls(**{**table, "operating": OperatingSet(**table["operating"]), "cells": cells})

    @property
    def whole(self) -> bool:
        """Whether set and cells have all of their numbers."""
        cells_whole = self.cells is None or self.cells.whole(self.operating.reach)
        return self.operating.whole and cells_whole

    @property
    def bounded(self) -> bool:
        """Whether no slope and no rate is endless, and none that is a size is negative."""
        sizes = (*self.heading, *self.most, *self.moved)
        slopes = (x for row in (*self.lo, *self.hi, *self.bend) for x in row)
        whole = len(self.heading) == len(self.most) == len(self.moved) == len(AXES)
        return whole and all(map(isfinite, (*sizes, *slopes))) and min(sizes) >= 0.0

    def magnitude(self) -> Matrix:
        """|A|: the greatest slope either way."""
        return c3.matrix(lambda i, j: max(-self.lo[i][j], self.hi[i][j]))

    def at_period(self, h: float) -> "Plant":
        """The same ship sampled every h seconds: the bend is exp(h |A|) from its second term on, with the
        heading as a fourth state.
        """
        size = self.magnitude()
        rows = tuple((*(h * x for x in size[i]), h * self.heading[i]) for i in AXES)
        return replace(self, h=h, bend=c3.beyond_first((*rows, (0.0, 0.0, h, 0.0))))

    def swing(self) -> tuple[tuple[float, ...], ...]:
        """exp(h |A|) |A|, heading and all: how steep the way of one sample can be, whatever the step's method
        lies off it."""
        size = self.magnitude()
        rows = (*((*size[i], self.heading[i]) for i in AXES), (0.0, 0.0, 1.0, 0.0))
        whole = [[float(i == j) + self.h * rows[i][j] + self.bend[i][j] for j in range(4)] for i in range(4)]
        return tuple(tuple(total(whole[i][k] * rows[k][j] for k in range(4)) for j in range(4)) for i in AXES)

    def growth(self, clipped: bool = True) -> Matrix:
        """A^M: what can make an error grow; on the diagonal only a slope above zero, because clip() may
        switch damping off. Where nothing is clipped damping counts.
        """
        size, least = self.magnitude(), 0.0 if clipped else -inf
        return c3.matrix(lambda i, j: max(self.hi[i][i], least) if i == j else size[i][j])


@dataclass(frozen=True)
class Disturbance:
    """Bound of what neither physics nor network explain of the low-frequency motion, |f - f_learned| [N, N,
    N m]: calm water, and per metre of wave height (second-order drift). `motion`: how far the motion with the
    waves is from it, per metre [m/s, m/s, rad/s, rad]; all zero where nothing is split: the drift is then the
    whole of the waves' force.
    """

    calm: Row
    per_metre: Row = (0.0, 0.0, 0.0)
    motion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)

    @property
    def numbers(self) -> tuple[float, ...]:
        """All ten; none is negative."""
        return *self.calm, *self.per_metre, *self.motion

    def at(self, H_s: float) -> Row:
        """The bound in a sea of that significant wave height [N, N, N m]."""
        return c3.row(a + b * H_s for a, b in zip(self.calm, self.per_metre, strict=True))

    def noise(self, noise: Row, H_s: float) -> Row:
        """What an instrument may be off from the low-frequency motion in that sea."""
        return c3.row(n + a * H_s for n, a in zip(noise, self.motion, strict=False))

    def heading_noise(self, noise: float, H_s: float) -> float:
        """What the compass may be off from the low-frequency heading in that sea [rad]."""
        return noise + self.motion[3] * H_s


def as_disturbance(disturbance: Sequence[float] | Disturbance | None) -> Disturbance | None:
    """A force that is the same in any sea as a Disturbance."""
    if disturbance is None or isinstance(disturbance, Disturbance):
        return disturbance
    return Disturbance(c3.row(disturbance))


def plant_of(
    model: Model, operating: OperatingSet, h: float, numbers: Sequence[Movable] = (), by_cell: bool = False
) -> Plant:
    """Sure bounds of the known physics (the learned force is an input, not a slope); a quarter of a second
    for a ship with wind. `numbers`: those of the effects that adaptation may move, all over their boxes.
    `by_cell`: part by part of the set as well.
    """
    from twin.live.certificate.enclosure import PIECES, anywhere, slopes, slopes_by_cell

    steep = slopes(model, operating.ranges, numbers=numbers)
    cells = None
    if by_cell:
        found = slopes_by_cell(model, operating.reach, PIECES | IN_CELLS, numbers)
        cells = of_slopes(*found[:3], c3.row(found[3]))
    unit = [core.accelerations(*row, anywhere(model, numbers).c) for row in c3.IDENTITY]
    made = Plant(
        lo=c3.matrix(lambda i, j: steep.lo[i][j]),
        hi=c3.matrix(lambda i, j: steep.hi[i][j]),
        heading=c3.row(max(-steep.lo[i][3], steep.hi[i][3]) for i in AXES),
        most=c3.row(steep.most),
        inertia=c3.matrix(lambda i, j: _size(unit[j][i])),
        h=h,
        operating=operating,
        moved=c3.row(steep.moved),
        cells=cells,
    )
    return made.at_period(h)


def _size(x: Any) -> float:
    """The greatest |x|, of a number or of one that lies in an interval."""
    x = getattr(x, "value", x)
    return float(getattr(x, "magnitude", abs(x)))


DRIFT = ("drift_X", "drift_Y", "drift_N")  # [N/m, N/m, N m/m]
MOTION = ("motion_u", "motion_v", "motion_r", "motion_psi")  # [m/s/m, m/s/m, rad/s/m, rad/m]


def seaway_of(ship: Ship) -> tuple[Row, tuple[float, float, float, float]] | None:
    """What the ship file says of a seaway, by metre of H_s: the drift, and the motion with the waves; None
    where it says nothing. SettingsError where it says no number."""
    table = ship.notes.get("seaway")
    if table is None:
        return None
    found = []
    for name in (*DRIFT, *MOTION):
        entry = table.get(name) if isinstance(table, Mapping) else None
        value = entry.get("value") if isinstance(entry, Mapping) else entry
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 <= value < 1e18:
            raise SettingsError(
                f"{ship.name}: seaway.{name} = {value!r}: a number from 0 on is needed. Calibrate again, or "
                "leave the whole section out."
            )
        found.append(float(value))
    return (found[0], found[1], found[2]), (found[3], found[4], found[5], found[6])


HEADING_NOISE = 0.005  # rad: three deviations of a usual compass


def usual_noise(ship: Ship) -> Row:
    """Three deviations of what usual instruments of a ship of this size and speed read wrongly [m/s, m/s,
    rad/s]: a log to 0.15 m/s or 4 % of U_0, a rate of turn to 0.0005 rad/s or 1 % of U_0/L."""
    speed = min(0.15, 0.04 * ship.U_0)
    return (speed, speed, max(5e-4, 0.0106 * ship.U_0 / ship.L_pp))


def usual_disturbance(model: Model) -> Disturbance:
    """What the ship file found on reference voyages ([seaway], `twin/study/reference/split.py`), else a size
    before any voyage: in calm water 1 % of 1/2 rho U_0^2 L T ahead and in yaw and three times that aside;
    in waves their pressure.

    The waves' part is the Froude-Krylov size rho g H_s times (B T, L T, L^2 T) and shares that a tanker
    needed; a residual record of one's own ship gives better numbers.
    """
    ship = model.loaded
    force, moment = ship.scale("force"), ship.scale("moment")
    calm: Row = (force, 3.0 * force, moment)
    if found := seaway_of(model.ship):
        return Disturbance(calm, *found)
    wave = ship.rho * core.GRAVITY * ship.T
    return Disturbance(
        calm,
        (0.5 * wave * ship.B, 0.75 * wave * ship.L_pp, 0.22 * wave * ship.L_pp**2),
    )


def self_regressor(plant: Plant, weights: Row, slope: float, per_state: Row) -> Matrix:
    """What a network fed with its own estimate (coasting) adds to the growth of errors: |M^-1| |W| Lip(phi)
    |d zeta/d nu|.

    weights: norm of each row of W [N, N, N m]; slope: `lipschitz(...)` of the trunk; per_state: |d zeta/d
    nu_j|.
    """
    return c3.product(plant.inertia, c3.matrix(lambda i, j: weights[i] * slope * per_state[j]))


def lipschitz(spectral_norms: list[float], steepest: float = 1.0998) -> float:
    """Lipschitz bound of a trunk from its layers' spectral norms and the steepest slope of its activation
    (swish: 1.0998).
    """
    total = 1.0
    for norm in spectral_norms:
        total *= norm * steepest
    return total


def output_bound(row_norm: float, features: float, saturation: float) -> float:
    """|w phi| <= min(||w|| ||phi||, saturation): what one row of the learned force can reach [N or N m],
    whatever adapts w.
    """
    return min(row_norm * features, saturation)

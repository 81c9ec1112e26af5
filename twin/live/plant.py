"""What the stabilizer's theorem needs to know of a ship: how steep her equations are over the operating set, and how she is disturbed."""

from dataclasses import dataclass

from twin.physics import core
from twin.physics.model import Model

from . import comparison as c3
from .comparison import AXES, Matrix, Row
from .operating import OperatingSet


@dataclass(frozen=True)
class Plant:
    """What the theorem needs to know of a ship over her operating set; SI units, plain numbers, kept as JSON.

    lo, hi: slopes of nu_dot with (u, v, r); heading: greatest slope with psi; most: greatest |nu_dot|; inertia: |M^-1|;
    step_error: error of one integrator step [per second of it].
    """

    lo: Matrix
    hi: Matrix
    heading: Row
    most: Row
    inertia: Matrix
    step_error: Row
    h: float
    operating: OperatingSet

    def growth(self) -> Matrix:
        """A^M: what can make an error grow; on the diagonal only a slope above zero, because clip() may switch damping off."""
        return c3.matrix(lambda i, j: max(self.hi[i][i], 0.0) if i == j else max(-self.lo[i][j], self.hi[i][j]))


@dataclass(frozen=True)
class Disturbance:
    """Bound of what neither physics nor network explain, |f - f_learned| [N, N, N m]: calm water, and per metre of wave height."""

    calm: Row
    per_metre: Row = (0.0, 0.0, 0.0)

    def at(self, H_s: float) -> Row:
        return tuple(a + b * H_s for a, b in zip(self.calm, self.per_metre, strict=True))  # type: ignore[return-value]


def plant_of(model: Model, operating: OperatingSet, h: float) -> Plant:
    """Sure bounds over the operating set; takes a quarter of a second for a ship with wind."""
    from .enclosure import slopes, step_error

    steep = slopes(model, operating.ranges)
    unit = [core.accelerations(*row, model.c) for row in c3.IDENTITY]
    return Plant(
        lo=c3.matrix(lambda i, j: steep.lo[i][j]), hi=c3.matrix(lambda i, j: steep.hi[i][j]), most=steep.most,  # type: ignore[arg-type]
        heading=tuple(max(-steep.lo[i][3], steep.hi[i][3]) for i in AXES), inertia=c3.matrix(lambda i, j: abs(unit[j][i])),  # type: ignore[arg-type]
        step_error=step_error(model, operating.ranges, h), h=h, operating=operating,
    )  # fmt: skip


def usual_disturbance(model: Model) -> Disturbance:
    """Before any voyage: in calm water 1 % of 1/2 rho U_0^2 L T ahead and in yaw and three times that aside; in waves their pressure.

    The waves' part is the Froude-Krylov size rho g H_s times (B T, L T, L^2 T) and shares that a tanker needed; a residual record of
    one's own ship gives better numbers.
    """
    ship = model.loaded
    force, moment = ship.scale("force"), ship.scale("moment")
    wave = ship.rho * core.GRAVITY * ship.T
    return Disturbance((force, 3.0 * force, moment), (0.5 * wave * ship.B, 0.75 * wave * ship.L_pp, 0.22 * wave * ship.L_pp**2))

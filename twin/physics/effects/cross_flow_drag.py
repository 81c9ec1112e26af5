"""Extra quadratic cross-flow drag, integrated over strips along the hull.

Y = -1/2 rho T  int c(x) |v_r + x r| (v_r + x r) dx
N = -1/2 rho T  int c(x) |v_r + x r| (v_r + x r) x dx,
    c(x) = c_d - 2 c_aft x / L + c_mid (1 - 12 x^2/L^2)
x from -L/2 to L/2 in ten strips; the mean of c over its length is c_d (but for the strips' own coarseness).
"""

from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation

STRIPS = tuple((i + 0.5) / 10.0 - 0.5 for i in range(10))  # middle of each strip, in L


class CrossFlowDrag(Force):
    """Bilge keels, growth or a blunt bilge hold the ship against the water that crosses under it when it
    drifts and turns."""

    size = "c_d"
    added_later = ("c_aft", "c_mid")
    source = (
        "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., ch. 6 (cross-flow drag); "
        "Faltinsen (1990) Sea Loads, ch. 6"
    )

    c_d: float = param(
        0.4,
        unit="-",
        lo=0.0,
        hi=2.0,
        sd=0.4,
        doc="drag coefficient beyond that of the hull's derivatives, mean of its length",
    )
    c_aft: float = param(
        0.0,
        unit="-",
        lo=-1.0,
        hi=1.0,
        sd=0.2,
        doc="how much larger it is at the stern, and smaller at the bow",
    )
    c_mid: float = param(
        0.0,
        unit="-",
        lo=-1.0,
        hi=1.0,
        sd=0.2,
        doc="how much larger it is amidships, and smaller, twice as much, at the ends",
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        L, Y, N = ship.L_pp, 0.0, 0.0
        for xi in STRIPS:
            cross = s.v_r + xi * L * s.r
            y = (self.c_d - 2.0 * self.c_aft * xi + self.c_mid * (1.0 - 12.0 * xi * xi)) * abs(cross) * cross
            Y, N = Y + y, N + xi * y
        q = -0.05 * ship.rho * ship.T * L
        return ForceVector(Y=q * Y, N=q * L * N)

"""Propeller walk: the blades push the stern sideways, with the square of the shaft speed.

Two screws that turn outward or inward alike have none; what is left where one of them gives less turns it,
too, and is called this.
Y = rho D^4   c_y n |n|,   N = rho D^4 L c_n n |n|
"""

from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class PropellerWalk(Force):
    """The screw pushes the stern to one side, the more the harder it turns (of two, one gives less than
    the other): the ship needs trim rudder to go straight, at any speed."""

    one_screw = True
    source = "Brix (1993) Manoeuvring Technical Manual (side force of a single screw)"

    c_y: float = param(
        0.01, unit="-", lo=-0.1, hi=0.1, sd=0.01, doc="side force, positive to starboard when going ahead"
    )
    c_n: float = param(
        -0.005,
        unit="-",
        lo=-0.05,
        hi=0.05,
        sd=0.005,
        doc="yaw moment, positive to starboard when going ahead",
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        f = ship.rho * ship.D_P**4 * s.n * abs(s.n)
        return ForceVector(Y=f * self.c_y, N=f * ship.L_pp * self.c_n)

"""A worn, fouled or damaged rudder: a fraction of its force is lost.

(X, Y, N) = -loss (X, Y, N)_rudder
"""

from twin.physics import core
from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class RudderWear(Force):
    """The rudder gives less force at the same angle: the ship answers late, turns wider and is harder to stop
    turning."""

    one_screw = True
    source = "Yasukawa & Yoshimura (2015) J. Mar. Sci. Technol. 20, 37-52, eq. (20)-(27): a share of F_N"

    loss: float = param(0.15, unit="-", lo=0.0, hi=0.8, sd=0.15, doc="share of the rudder force that is lost")

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        c = ship.c
        X, Y, N = core.rudder(s.u_r, s.v_r, s.r, s.delta, core.thrust(s.u_r, s.n, c), c)
        return ForceVector(-self.loss * X, -self.loss * Y, -self.loss * N)

"""The neutral angle: the rudder stands at delta + offset where the indicator says delta.

(X, Y, N) = (X, Y, N)_rudder(delta + offset) - (X, Y, N)_rudder(delta)
"""

from twin.physics import core
from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class RudderOffset(Force):
    """The rudder's zero is not where the indicator says, so the ship needs the same angle to go straight at
    every speed."""

    one_screw = True
    source = "IMO MSC/Circ.1053 (2002), neutral rudder angle; Yasukawa & Yoshimura (2015) eq. (20)-(27)"

    offset: float = param(
        0.02,
        unit="rad",
        lo=-0.2,
        hi=0.2,
        sd=0.02,
        doc="true rudder angle less the indicated one, positive to starboard",
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        c = ship.c
        thrust = core.thrust(s.u_r, s.n, c)
        told = core.rudder(s.u_r, s.v_r, s.r, s.delta, thrust, c)
        true = core.rudder(s.u_r, s.v_r, s.r, s.delta + self.offset, thrust, c)
        return ForceVector(true[0] - told[0], true[1] - told[1], true[2] - told[2])

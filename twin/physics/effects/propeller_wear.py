"""A worn, bent or fouled propeller: a fraction of the thrust is lost, and with it part of the slipstream at
the rudder.

X = -(1 - t) loss T(u_r, n)  +  X_rudder((1 - loss) T) - X_rudder(T),   Y, N likewise from the rudder
"""

from twin.physics import core
from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class PropellerWear(Force):
    """The propeller gives less thrust than it did, so the ship is slower and its rudder, in a weaker
    slipstream, bites less."""

    one_screw = True
    source = (
        "Carlton (2018) Marine Propellers and Propulsion, 4th ed. (blade roughness and damage in service)"
    )

    loss: float = param(
        0.1,
        unit="-",
        lo=0.0,
        hi=0.7,
        sd=0.1,
        form=0.2,
        doc="share of the thrust that is lost, alike at every advance",
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        c = ship.c
        thrust = core.thrust(s.u_r, s.n, c)
        new = core.rudder(s.u_r, s.v_r, s.r, s.delta, thrust, c)
        worn = core.rudder(s.u_r, s.v_r, s.r, s.delta, thrust * (1.0 - self.loss), c)
        return ForceVector(
            worn[0] - new[0] - c.thrust_share * self.loss * thrust, worn[1] - new[1], worn[2] - new[2]
        )

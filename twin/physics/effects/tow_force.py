"""A force that turns with the ship and does not change.

(X, Y, N) = constant, body axes
"""

from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class TowForce(Force):
    """Something pulls at the ship and turns with it: a tow, a thruster left on, a dragging anchor, a list
    that nobody recorded."""

    belongs_to = "voyage"
    source = "Newton's second law; size: shares of its own resistance"

    ahead: float = param(-0.5, unit="N", lo=-8.0, hi=8.0, sd=0.6, of="force", doc="force ahead")
    starboard: float = param(0.3, unit="N", lo=-8.0, hi=8.0, sd=0.5, of="force", doc="force to starboard")
    turning: float = param(
        0.1, unit="N m", lo=-3.0, hi=3.0, sd=0.15, of="moment", doc="moment turning to starboard"
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        return ForceVector(self.ahead, self.starboard, self.turning)

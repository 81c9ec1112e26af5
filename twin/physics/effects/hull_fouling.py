"""Fouling: a fraction of the calm-water resistance is added.

X = -extra R(u_r),   R = -(X_u + X_uu |u_r| + X_uuu u_r^2) u_r
"""

from twin.physics.core import resistance
from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class HullFouling(Force):
    """Growth on the hull makes the ship harder to drive: the same shaft speed gives less speed."""

    source = (
        "ITTC 7.5-02-03-01.4 (roughness allowance); Schultz (2007) Biofouling 23, 331-341 (+10 % slime "
        "to +80 % heavy shell)"
    )

    extra: float = param(
        0.3, unit="-", lo=0.0, hi=2.0, sd=0.25, doc="added resistance over calm-water resistance"
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        return ForceVector(X=self.extra * resistance(s.u_r, ship.c))

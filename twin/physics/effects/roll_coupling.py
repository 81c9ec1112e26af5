"""Heel makes the hull asymmetric: side force and yaw moment that grow with roll, and more so in a turn.

U^2 = u_r^2 + v_r^2
Y = 1/2 rho L T   (c_y U^2 + c_yr L^2 r^2) phi
N = 1/2 rho L^2 T (c_n U^2 + c_nr L^2 r^2) phi
"""

from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class RollCoupling(Force):
    """When the ship heels it is no longer the same on both sides: heel pushes it aside and turns it, most in
    a turn."""

    needs = ("phi",)
    source = (
        "Son & Nomoto (1981) J. Soc. Naval Arch. Japan 150 (Y_phi, N_phi, Y_rrphi, N_rrphi); Fossen "
        "(2021) ch. 6"
    )

    c_y: float = param(
        0.0, unit="1/rad", lo=-0.3, hi=0.3, sd=0.02, doc="side force of heel, running straight"
    )
    c_n: float = param(
        -0.003, unit="1/rad", lo=-0.2, hi=0.2, sd=0.01, doc="yaw moment of heel, running straight"
    )
    c_yr: float = param(0.2, unit="1/rad", lo=-2.0, hi=2.0, sd=0.2, doc="side force of heel, per (L r/U)^2")
    c_nr: float = param(
        -0.08, unit="1/rad", lo=-1.0, hi=1.0, sd=0.08, doc="yaw moment of heel, per (L r/U)^2"
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        L, UU = ship.L_pp, s.u_r * s.u_r + s.v_r * s.v_r
        turn = L * L * s.r * s.r
        f = 0.5 * ship.rho * L * ship.T * s.phi
        return ForceVector(
            Y=f * (self.c_y * UU + self.c_yr * turn), N=f * L * (self.c_n * UU + self.c_nr * turn)
        )

"""A hull that is not alike on both sides: a bent bilge keel or plate, growth on one side, a stabilizer fin
that was left out.

    Y = 1/2 rho L T Y_0 u |u|,  N = 1/2 rho L^2 T N_0 u |u|
The force of the flow along the hull, in proportion to the square of its speed, whatever the shaft does.
"""

from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class HullAsymmetry(Force):
    """The flow along the hull pushes it to one side and turns it: something sticks out on one side."""

    source = "Abkowitz (1964) Lectures on ship hydrodynamics, HyA report Hy-5 (forces of asymmetry)"

    Y_0: float = param(0.01, unit="-", lo=-0.1, hi=0.1, sd=0.01, doc="side force, positive to starboard")
    N_0: float = param(0.003, unit="-", lo=-0.03, hi=0.03, sd=0.003, doc="yaw moment, positive to starboard")

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        f = 0.5 * ship.rho * ship.L_pp * ship.T * s.u_r * abs(s.u_r)
        return ForceVector(Y=f * self.Y_0, N=f * ship.L_pp * self.N_0)

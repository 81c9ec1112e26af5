"""The compass is off: the heading, and what is turned into body or earth axes by it.

    psi_m = psi + bias,   wind_to_m = wind_to + bias
    u_m = u cos(turned) + v sin(turned),   v_m = v cos(turned) - u sin(turned)      (over ground)
`turned` = bias where the velocity over ground is turned into body axes by this compass, and 0 where the
receiver has an attitude of its own (an inertial unit, two antennas).
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class HeadingBias(SensorFault):
    """The compass shows a heading that is off by a constant, so the ship seems to drift sideways wherever it
    goes."""

    attitude = True
    varies = 0.15
    turning = "turned"
    by_readings = MappingProxyType({"A": "bias"})
    source = "ISO 8728 and IMO A.424(XI) (gyro-compass settle-point error)"

    bias: float = param(
        0.02,
        unit="rad",
        lo=-0.55,
        hi=0.55,
        sd=0.02,
        doc="shown heading less the true one (variation of 30 deg is in)",
    )
    turned: float = param(
        0.0,
        unit="rad",
        lo=-0.55,
        hi=0.55,
        sd=0.02,
        doc="by what speed over ground is turned: bias, or 0 (see above)",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        c, si = cos(self.turned), sin(self.turned)
        return replace(
            s,
            psi=s.psi + self.bias,
            u=s.u * c + s.v * si,
            v=s.v * c - s.u * si,
            wind_to=None if s.wind_to is None else s.wind_to + self.bias,
        )

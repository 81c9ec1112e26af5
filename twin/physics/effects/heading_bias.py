"""The compass is off: the heading, and all that is turned into body or earth axes by it.

    psi_m = psi + bias;   (u, v)_m = R(bias)^T (u, v)  over ground, since they come from GNSS by the heading;   wind_to_m = wind_to + bias
"""

from dataclasses import replace

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.state import Situation


class HeadingBias(SensorFault):
    """The compass shows a heading that is off by a constant, so she seems to drift sideways wherever she goes."""

    source = "IMO A.424(XI) and ISO 8728 (gyro settle-point error); Fossen (2021) sec. 13"

    bias: float = param(0.015, unit="rad", lo=-0.2, hi=0.2, sd=0.015, doc="shown heading less the true one")

    def read(self, s: Situation, ship: object) -> Situation:
        c, si = cos(self.bias), sin(self.bias)
        return replace(
            s,
            psi=s.psi + self.bias,
            u=s.u * c + s.v * si,
            v=s.v * c - s.u * si,
            wind_to=None if s.wind_to is None else s.wind_to + self.bias,
        )

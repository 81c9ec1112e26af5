"""The speed log is mounted askew: its axes are turned from the ship's.

u_r,m = u_r cos(angle) + v_r sin(angle),   v_r,m = v_r cos(angle) - u_r sin(angle)
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class SpeedLogMisalignment(SensorFault):
    """The speed log is mounted askew, so speed ahead shows up as drift in proportion."""

    needs = ("u_r", "v_r")
    varies = 0.15
    by_readings = MappingProxyType({"log_angle": "angle"})
    source = (
        "Kinsey & Whitcomb (2007) In situ alignment calibration of attitude and Doppler sensors, IEEE "
        "J. Oceanic Eng. 32, 286-299"
    )

    angle: float = param(
        0.03,
        unit="rad",
        lo=-0.3,
        hi=0.3,
        sd=0.03,
        doc="how far the log's axis ahead points to starboard of the ship's",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        c, si = cos(self.angle), sin(self.angle)
        return replace(s, u_r=s.u_r * c + s.v_r * si, v_r=s.v_r * c - s.u_r * si)

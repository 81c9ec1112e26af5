"""The rate gyro is off by a factor.

r_m = (1 + scale) r
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class GyroScale(SensorFault):
    """The rate gyro shows a fixed percentage too much or too little of every turn; the heading turns by
    less or more."""

    needs = ("r",)
    attitude = True
    kinematic = True
    by_readings = MappingProxyType({"gyro_scale": "scale"})
    source = "IEEE Std 952-1997 (scale factor error); IMO A.526(13) (rate-of-turn indicators: 5 %)"

    scale: float = param(
        0.05, unit="-", lo=-0.6, hi=0.6, sd=0.05, doc="shown rate of turn over the true one, less 1"
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        return replace(s, r=s.r * (1.0 + self.scale))

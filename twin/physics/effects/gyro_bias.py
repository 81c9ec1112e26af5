"""The rate gyro is off by a constant.

r_m = r + bias
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class GyroBias(SensorFault):
    """The rate gyro shows a turn when there is none; the heading does not turn with it."""

    needs = ("r",)
    attitude = True
    by_readings = MappingProxyType({"gyro_bias": "bias"})
    source = "IEEE Std 952-1997 (gyro bias); IMO A.526(13) (rate-of-turn indicators: 0.5 deg/min)"

    bias: float = param(
        0.0005, unit="rad/s", lo=-0.02, hi=0.02, sd=0.0007, doc="shown yaw rate less the true one"
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        return replace(s, r=s.r + self.bias)

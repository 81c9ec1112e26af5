"""The rate gyro is off by a factor.

r_m = (1 + scale) r
"""

from dataclasses import replace

from twin.physics.effect import SensorFault, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class GyroScale(SensorFault):
    """The rate gyro shows a fixed percentage too much or too little of each turn (a wrong calibration, an
    axis that is not upright)."""

    needs = ("r",)
    attitude = True
    source = "IEEE Std 952-1997 (scale factor); IMO A.526(13) (rate-of-turn indicators: 5 % of what is shown)"

    scale: float = param(
        0.05, unit="-", lo=-0.5, hi=0.5, sd=0.05, doc="shown rate of turn over the true one, less 1"
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        return replace(s, r=s.r * (1.0 + self.scale))

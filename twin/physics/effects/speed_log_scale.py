"""The speed log is off by a factor.

(u_r, v_r)_m = (1 + scale) (u_r, v_r)
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class SpeedLogScale(SensorFault):
    """The speed log shows a fixed percentage too much or too little (the boundary layer, a wrong
    calibration)."""

    needs = ("u_r",)
    by_readings = MappingProxyType({"log_scale": "scale"})
    source = "IMO MSC.96(72) (performance of speed logs: 2 % or 0.2 kn)"

    scale: float = param(
        0.04, unit="-", lo=-0.6, hi=0.6, sd=0.04, doc="shown speed over the true one, less 1"
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        return replace(s, u_r=s.u_r * (1.0 + self.scale), v_r=s.v_r * (1.0 + self.scale))

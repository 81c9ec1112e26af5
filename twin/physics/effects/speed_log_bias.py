"""The speed log is off by a constant ahead.

u_r,m = u_r + bias
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class SpeedLogBias(SensorFault):
    """The speed log shows a constant too much or too little ahead, which looks like a current that turns with
    it."""

    needs = ("u_r",)
    by_readings = MappingProxyType({"log_bias": "bias"})
    source = "IMO MSC.96(72) (performance of speed logs: 2 % or 0.2 kn)"

    bias: float = param(
        0.04,
        unit="m/s",
        lo=-0.4,
        hi=0.4,
        sd=0.04,
        of="speed",
        doc="shown speed through water less the true one",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        return replace(s, u_r=s.u_r + self.bias)

"""The compass is slow: it shows the heading of `lag` seconds ago (a filtered magnetic or satellite compass, a
slow message).

    psi_m = psi - behind(lag),   behind(t) = t r - t^2/2 dr/dt
    u_m = u cos(behind(turned)) - v sin(behind(turned)),   v_m = v cos(behind(turned)) + u sin(behind(turned))
        (over ground)
`turned` = lag where the velocity over ground is turned into body axes by this compass, and 0 where the
receiver has an attitude of its own. Second order in the lag: of first order alone, a rudder that is put
over would seem to turn the ship less.
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class HeadingLag(SensorFault):
    """The compass shows the heading of some seconds ago, so while turning the ship seems to drift, and on a
    straight course all is well."""

    attitude = True
    kinematic = True
    ages = ("lag",)
    turning = "turned"
    by_readings = MappingProxyType({"heading_delay": "lag"})
    source = (
        "ISO 11606 and ISO 22090-3 (follow-up error of heading devices); Skog & Haendel (2011) IEEE "
        "Trans. ITS 12, 1014-1023"
    )

    lag: float = param(
        0.5,
        unit="s",
        lo=-1.0,
        hi=10.0,
        sd=0.5,
        doc="age of the shown heading; below zero: it runs ahead of the other instruments",
    )
    turned: float = param(
        0.0,
        unit="s",
        lo=-1.0,
        hi=10.0,
        sd=0.5,
        doc="age of that by which speed over ground is turned: lag, or 0 (see above)",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        behind, turned = (age * (s.r - 0.5 * age * s.r_dot) for age in (self.lag, self.turned))
        c, si = cos(turned), sin(turned)
        return replace(s, psi=s.psi - behind, u=s.u * c - s.v * si, v=s.v * c + s.u * si)

"""The compass is slow: it shows the heading of `lag` seconds ago (a filtered magnetic or satellite compass, a
slow message).

    psi_m = psi - behind(lag),   behind(t) = t r - (1 + filtered) t^2/2 dr/dt
    u_m = u cos(behind(turned)) - v sin(behind(turned)),   v_m = v cos(behind(turned)) + u sin(behind(turned))
        (over ground)
`turned` = lag where the velocity over ground is turned into body axes by this compass, and 0 where the
receiver has an attitude of its own. Of the ages that are mixed in what is shown, lag is the mean, and
filtered lag^2 the variance: none of a late message, lag^2 of a filter of first order. Second order in the
lag: of first order alone, a rudder that is put over would seem to turn the ship less.
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
    suspected_first = True
    ages = ("lag",)
    turning = "turned"
    size = "lag"
    added_later = ("filtered",)
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
    filtered: float = param(
        0.5,
        unit="-",
        lo=0.0,
        hi=1.0,
        sd=0.3,
        null=0.5,
        doc="how far its lag is that of a filter (1), not of a late message (0)",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        k = 0.5 * (1.0 + self.filtered)
        behind, turned = (age * (s.r - k * age * s.r_dot) for age in (self.lag, self.turned))
        c, si = cos(turned), sin(turned)
        return replace(s, psi=s.psi - behind, u=s.u * c - s.v * si, v=s.v * c + s.u * si)

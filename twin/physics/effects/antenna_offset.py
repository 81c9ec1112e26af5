"""The antenna is not where it is said to be: position and velocity over ground are those of another point of
the ship.

a_x ahead, a_y to starboard, from the point whose position the settings promise (midship; docs/import.md); a_z
above the axis of roll, from where heel phi carries it aside (a_z = 0 where roll was not recorded; p is its
rate):
x_m = x + a_x cos(psi) - a sin(psi),   y_m = y + a_x sin(psi) + a cos(psi),   a = a_y + a_z sin(phi)
u_m = u - a r,                         v_m = v + a_x r + a_z cos(phi) p
and their rates of change, which a receiver that is late or smooths shows, grow by -a dr/dt and a_x dr/dt.
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class AntennaOffset(SensorFault):
    """The satellite antenna stands elsewhere on board than the settings say: the ship seems to swing about
    the wrong point."""

    role = "antenna"
    with_core = "the place was measured there on the reference voyages"
    by_readings = MappingProxyType(
        {"antenna_ahead": "ahead", "antenna_starboard": "starboard", "antenna_above": "above"}
    )
    added_later = ("above",)
    source = "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., ch. 2 and 13 (lever arms)"

    ahead: float = param(
        0.1, unit="m", lo=-0.6, hi=0.6, sd=0.1, of="length", doc="antenna ahead of where the settings put it"
    )
    starboard: float = param(
        0.0,
        unit="m",
        lo=-0.1,
        hi=0.1,
        sd=0.015,
        of="length",
        doc="antenna to starboard of where the settings put it",
    )
    above: float = param(
        0.0,
        unit="m",
        lo=-0.1,
        hi=0.5,
        sd=0.1,
        of="length",
        input="phi",
        doc="antenna above the axis of roll, where roll was recorded",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        c, si = cos(s.psi), sin(s.psi)
        aside = self.starboard + (0.0 if s.phi is None else self.above * sin(s.phi))
        swung = 0.0 if s.phi is None or s.p is None else self.above * cos(s.phi) * s.p
        return replace(
            s,
            x=s.x + self.ahead * c - aside * si,
            y=s.y + self.ahead * si + aside * c,
            u=s.u - aside * s.r,
            v=s.v + self.ahead * s.r + swung,
            u_dot=s.u_dot - aside * s.r_dot,
            v_dot=s.v_dot + self.ahead * s.r_dot,
        )

"""The antenna is not where it is said to be: position and velocity over ground are those of another point of the ship.

a_x ahead, a_y to starboard, from the point whose position the settings promise (midship; docs/import.md):
x_m = x + a_x cos(psi) - a_y sin(psi),   y_m = y + a_x sin(psi) + a_y cos(psi)
u_m = u - a_y r,                         v_m = v + a_x r
"""

from dataclasses import replace

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.particulars import Ship
from twin.physics.state import Situation


class AntennaOffset(SensorFault):
    """The satellite antenna stands elsewhere on board than the settings say: she seems to swing about the wrong point."""

    source = "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., ch. 2 and 13 (lever arms)"

    ahead: float = param(0.1, unit="m", lo=-0.6, hi=0.6, sd=0.1, of="length", doc="antenna ahead of where the settings put it")
    starboard: float = param(0.0, unit="m", lo=-0.1, hi=0.1, sd=0.015, of="length", doc="antenna to starboard of where the settings put it")

    def read(self, s: Situation, ship: Ship) -> Situation:
        c, si = cos(s.psi), sin(s.psi)
        return replace(
            s,
            x=s.x + self.ahead * c - self.starboard * si,
            y=s.y + self.ahead * si + self.starboard * c,
            u=s.u - self.starboard * s.r,
            v=s.v + self.ahead * s.r,
        )

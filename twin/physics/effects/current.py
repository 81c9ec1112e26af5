"""A steady current: the water moves over ground, and the ship with it.

u_c =  V_N cos(psi) + V_E sin(psi),  v_c = -V_N sin(psi) + V_E cos(psi)
"""

from types import MappingProxyType

from twin.physics.effect import Flow, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation, Water


class Current(Flow):
    """A steady current carries the ship over ground; hull, propeller and rudder feel only the motion through
    the water."""

    belongs_to = "voyage"
    every_day = ("north", "east")
    stream = True
    role = "stream"
    by_readings = MappingProxyType({"current_north": "north", "current_east": "east"})
    source = "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., sec. 10.3"

    north: float = param(0.0, unit="m/s", lo=-1.0, hi=1.0, sd=0.08, of="speed", doc="current toward north")
    east: float = param(0.0, unit="m/s", lo=-1.0, hi=1.0, sd=0.08, of="speed", doc="current toward east")

    def water(self, s: Situation, ship: ShipLike) -> Water:
        c, si = cos(s.psi), sin(s.psi)
        return Water(u=self.north * c + self.east * si, v=self.east * c - self.north * si)

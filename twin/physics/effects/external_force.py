"""A force that keeps its direction over ground, and the moment of its lever about midship.

X =  F_N cos(psi) + F_E sin(psi),   Y = -F_N sin(psi) + F_E cos(psi)
N = -M_N sin(psi) + M_E cos(psi),   M = lever times F
"""

from twin.physics.effect import Force, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class ExternalForce(Force):
    """Something pulls at the ship from a fixed bearing: a mooring or tug line from shore, a swell that was
    not measured."""

    belongs_to = "voyage"
    every_day = ("north", "east")
    source = (
        "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., ch. 2 (rotation from NED to body)"
    )

    north: float = param(0.4, unit="N", lo=-8.0, hi=8.0, sd=0.6, of="force", doc="force toward north")
    east: float = param(0.0, unit="N", lo=-8.0, hi=8.0, sd=0.6, of="force", doc="force toward east")
    turn_north: float = param(
        0.0,
        unit="N m",
        lo=-3.0,
        hi=3.0,
        sd=0.1,
        of="moment",
        doc="north force times its lever ahead of midship",
    )
    turn_east: float = param(
        0.0,
        unit="N m",
        lo=-3.0,
        hi=3.0,
        sd=0.1,
        of="moment",
        doc="east force times its lever ahead of midship",
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        c, si = cos(s.psi), sin(s.psi)
        return ForceVector(
            X=self.north * c + self.east * si,
            Y=self.east * c - self.north * si,
            N=self.turn_east * c - self.turn_north * si,
        )

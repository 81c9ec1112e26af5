"""A current that changes slowly: a mean and three harmonics of one hour, toward north and toward east.

    V(t) = V_0 + sum_k (a_k cos(w_k t) + b_k sin(w_k t)),   w_k = 2 pi k / 3600 s,  k = 1, 2, 3
Linear in every number; slower than 20 min within a voyage of an hour, and bounded ever after (it repeats,
which is all that can be promised of a stream that was not forecast: on board the observer's own filter
follows the whole stream)."""

from math import pi

from twin.physics.effect import Flow, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Number, Situation, Water

HOUR = 3600.0  # s


def _wave(k: int, toward: str, of_time: str) -> float:
    sd = (0.05, 0.035, 0.025)[k - 1]
    return param(
        0.0,
        unit="m/s",
        lo=-0.4,
        hi=0.4,
        sd=sd,
        of="speed",
        doc=f"toward {toward}, {of_time} of {60 // k} min",
    )


class VaryingCurrent(Flow):
    """A current that changes in the course of the voyage, as a tide does or a stream the ship sails into and
    out of."""

    belongs_to = "voyage"
    stream = True
    needs = ("t",)
    holds = ("Current",)
    source = (
        "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., sec. 10.3; harmonic form as in "
        "tidal analysis (Foreman 1977)"
    )

    north: float = param(0.0, unit="m/s", lo=-1.0, hi=1.0, sd=0.08, of="speed", doc="mean toward north")
    east: float = param(0.0, unit="m/s", lo=-1.0, hi=1.0, sd=0.08, of="speed", doc="mean toward east")
    north_c1: float = _wave(1, "north", "cosine")
    north_s1: float = _wave(1, "north", "sine")
    north_c2: float = _wave(2, "north", "cosine")
    north_s2: float = _wave(2, "north", "sine")
    north_c3: float = _wave(3, "north", "cosine")
    north_s3: float = _wave(3, "north", "sine")
    east_c1: float = _wave(1, "east", "cosine")
    east_s1: float = _wave(1, "east", "sine")
    east_c2: float = _wave(2, "east", "cosine")
    east_s2: float = _wave(2, "east", "sine")
    east_c3: float = _wave(3, "east", "cosine")
    east_s3: float = _wave(3, "east", "sine")

    def toward(self, t: Number) -> tuple[Number, Number]:
        """Velocity of the water over ground, north and east [m/s]."""
        c, s = cos(2.0 * pi / HOUR * t), sin(2.0 * pi / HOUR * t)
        c2, s2 = c * c - s * s, 2.0 * s * c
        c3, s3 = c2 * c - s2 * s, s2 * c + c2 * s
        return (
            self.north
            + self.north_c1 * c
            + self.north_s1 * s
            + self.north_c2 * c2
            + self.north_s2 * s2
            + self.north_c3 * c3
            + self.north_s3 * s3,
            self.east
            + self.east_c1 * c
            + self.east_s1 * s
            + self.east_c2 * c2
            + self.east_s2 * s2
            + self.east_c3 * c3
            + self.east_s3 * s3,
        )

    def water(self, s: Situation, ship: ShipLike) -> Water:
        north, east = self.toward(s.t)
        c, si = cos(s.psi), sin(s.psi)
        return Water(u=north * c + east * si, v=east * c - north * si)

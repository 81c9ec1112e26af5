"""A magnetic compass's deviation curve: the error goes round with the heading, as the ship's own iron makes
it.

    e = A + B sin(psi) + C cos(psi) + D sin(2 psi) + E cos(2 psi)
    psi_m = psi + e,   wind_to_m = wind_to + e
    u_m = u cos(k e) + v sin(k e),   v_m = v cos(k e) - u sin(k e)      (over ground),   k = `turned`
`turned` = 1 where the velocity over ground is turned into body axes by this compass, as course and speed
over ground are, and 0 where the receiver has an attitude of its own. The chart's variation is a part of A
(HeadingBias is A alone).
"""

from dataclasses import replace
from types import MappingProxyType
from typing import Self

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Number, Situation


def _coefficient(default: float, sd: float, of: str) -> float:
    return param(default, unit="rad", lo=-0.55, hi=0.55, sd=sd, doc=of)


class CompassDeviation(SensorFault):
    """The ship's own iron turns the compass, by another angle on every heading."""

    attitude = True
    kinematic = True
    suspected_first = True
    role = "compass"
    with_core = "so the ship's way through the water told on the reference voyages"
    by_readings = MappingProxyType({name: name for name in "BCDE"})
    source = (
        "Admiralty Manual for the Deviation of the Compass (Evans & Smith); ISO 1069 (coefficients A "
        "to E); Bowditch (2019) ch. 7"
    )

    A: float = _coefficient(0.0, 0.02, "constant part")
    B: float = _coefficient(0.05, 0.05, "semicircular, with the sine of the heading (iron ahead and astern)")
    C: float = _coefficient(0.0, 0.05, "semicircular, with the cosine of the heading (iron abeam)")
    D: float = _coefficient(0.0, 0.02, "quadrantal, with the sine of twice the heading (soft iron)")
    E: float = _coefficient(0.0, 0.01, "quadrantal, with the cosine of twice the heading")
    turned: float = param(
        1.0,
        unit="-",
        lo=-0.5,
        hi=1.5,
        sd=0.5,
        null=1.0,
        doc="share by which speed over ground is turned too: 1, or 0 (see above)",
    )

    def error(self, psi: float) -> float:
        """What the compass shows too much on this true heading [rad]."""
        c, s = cos(psi), sin(psi)
        return self.A + self.B * s + self.C * c + self.D * 2.0 * s * c + self.E * (c * c - s * s)

    def as_read(self, number: str, value: Number, attitude: bool) -> Self:
        return super().as_read(number, value, attitude).but(turned=0.0 if attitude else 1.0)

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        e = self.error(s.psi)
        c, si = cos(self.turned * e), sin(self.turned * e)
        return replace(
            s,
            psi=s.psi + e,
            u=s.u * c + s.v * si,
            v=s.v * c - s.u * si,
            wind_to=None if s.wind_to is None else s.wind_to + e,
        )

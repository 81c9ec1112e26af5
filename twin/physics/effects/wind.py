"""Wind on hull and superstructure, from the air past the ship in body axes.

V_w, beta_w: speed and direction to which the wind blows, over ground
u_rw = u - V_w cos(beta_w - psi),  v_rw = v - V_w sin(beta_w - psi),  V_rw = |(u_rw, v_rw)|
X = -1/2 rho_a A_F  c_x  V_rw u_rw
Y = -1/2 rho_a A_L  c_y  V_rw v_rw
N = -1/2 rho_a A_L L (2 c_n u_rw + c_m V_rw) v_rw
"""

from twin.physics.effect import Force, param
from twin.physics.maths import cos, hypot, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation

RHO_AIR = 1.225  # kg/m3 at 15 degC, ISO 2533


class Wind(Force):
    """Wind pushes the ship aside, slows or drives it, and turns it; worst in ballast and at low speed."""

    belongs_to = "voyage"
    needs = ("wind_speed", "wind_to")
    needs_ship = ("A_F", "A_L")
    lever = 0.05  # it moves along it with the direction, by more than four coefficients say
    role = "wind"
    with_core = "it blew on the reference voyages"
    source = (
        "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., sec. 10.1; Blendermann (1994) "
        "coefficient ranges"
    )

    c_x: float = param(0.7, unit="-", lo=0.0, hi=1.6, sd=0.7, doc="head-wind drag on the frontal area A_F")
    c_y: float = param(0.85, unit="-", lo=0.0, hi=1.8, sd=0.8, doc="beam-wind drag on the lateral area A_L")
    c_n: float = param(
        0.08,
        unit="-",
        lo=-0.3,
        hi=0.4,
        sd=0.1,
        doc="yaw moment that bow and stern quartering winds add (sin 2 gamma)",
    )
    c_m: float = param(
        0.0,
        unit="-",
        lo=-0.3,
        hi=0.3,
        sd=0.05,
        doc="yaw moment of beam wind: c_y times the lever of the lateral area's centre, in L",
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        u_rw = s.u - s.wind_speed * cos(s.wind_to - s.psi)  # the ship through the air, body axes [m/s]
        v_rw = s.v - s.wind_speed * sin(s.wind_to - s.psi)
        V_rw = hypot(u_rw, v_rw)
        q = 0.5 * RHO_AIR
        return ForceVector(
            X=-q * ship.A_F * self.c_x * V_rw * u_rw,
            Y=-q * ship.A_L * self.c_y * V_rw * v_rw,
            N=-q * ship.A_L * ship.L_pp * (2.0 * self.c_n * u_rw + self.c_m * V_rw) * v_rw,
        )

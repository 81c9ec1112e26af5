"""Mean second-order drift: the momentum of the waves that the hull throws back.

    beta_wave: direction to which the waves run
    chi = beta_wave - psi,  q = 1/16 rho g H_s^2 R,  R = 1 - exp(-2 k T),
        k = (2 pi / T_p)^2 / g   (R = 1 where T_p is unknown)
    X = q B sqrt(B/L)  c_x cos(chi)
    Y = q L            c_y |sin(chi)| sin(chi)
    N = q L^2          c_n sin(2 chi)
A vertical wall that reflects everything has c_y = 1; long waves pass under the keel, which R takes off. Waves
come in groups, and the force with them: it follows the square of their envelope, which in a narrow band
scatters as much as its mean is (Newman 1974)."""

from math import pi

from twin.physics.core import GRAVITY
from twin.physics.effect import Force, param
from twin.physics.maths import cos, exp, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Number, Situation


class WaveDrift(Force):
    """The sea pushes the ship slowly along with the waves, slows it in head seas and turns it across
    them."""

    belongs_to = "voyage"
    needs = ("H_s", "wave_to")  # T_p is used where it is known
    irregular = True
    lever = 0.05
    source = (
        "Faltinsen (1990) Sea Loads on Ships and Offshore Structures, ch. 5 (wall reflection); ITTC "
        "7.5-04-01-01.2 STAWAVE-1 (c_x = 1)"
    )

    c_x: float = param(
        1.0, unit="-", lo=0.0, hi=6.0, sd=1.2, doc="added resistance in head sea, in units of STAWAVE-1"
    )
    c_y: float = param(0.8, unit="-", lo=0.0, hi=2.0, sd=0.6, doc="beam drift, in units of a reflecting wall")
    c_n: float = param(0.0, unit="-", lo=-0.3, hi=0.3, sd=0.06, doc="yaw moment of bow and quartering seas")

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        chi = s.wave_to - s.psi
        si, co = sin(chi), cos(chi)
        q = 0.0625 * ship.rho * GRAVITY * s.H_s * s.H_s * reflected(s.T_p, ship.T)
        return ForceVector(
            X=q * ship.B * (ship.B / ship.L_pp) ** 0.5 * self.c_x * co,
            Y=q * ship.L_pp * self.c_y * abs(si) * si,
            N=q * ship.L_pp * ship.L_pp * self.c_n * 2.0 * si * co,
        )


def reflected(T_p: Number, T: Number) -> Number:
    """Share of the wave energy above the keel, which the hull throws back."""
    return 1.0 if T_p is None else 1.0 - exp(-8.0 * pi**2 * T / (GRAVITY * T_p * T_p))

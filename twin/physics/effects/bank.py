"""Bank suction: the stream between hull and bank runs faster, and pulls the ship to the bank and its bow off
it.

d: from the ship's side to the bank (where there is none, 10000 m)
e = f(d_starboard) - f(d_port),  f(d) = eta (1 + steep (3 eta - 1)),  eta = B/(B + 2 d)
Y =  1/2 rho L T   u_r^2     suction  e
N = -1/2 rho L^2 T u_r|u_r|  bow_out  e
How fast the suction falls off with the distance depends on hull and bank, and those who measured it disagree:
with eta, or with its square; one beam off both say the same."""

from twin.physics.effect import Force, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Number, Situation


class Bank(Force):
    """A bank close by sucks the ship toward it and pushes its bow away, with the square of its speed."""

    belongs_to = "voyage"
    needs = ("bank_port", "bank_starboard")
    of_place = True
    source = (
        "Norrbin (1974) Bank effects on a ship moving through a short dredged channel, 10th Symp. Naval "
        "Hydrodynamics; "
        "Ch'ng, Doctors & Renilson (1993) ISP 40"
    )

    suction: float = param(0.03, unit="-", lo=0.0, hi=0.5, sd=0.05, doc="side force toward the nearer bank")
    bow_out: float = param(
        0.008, unit="-", lo=0.0, hi=0.15, sd=0.015, doc="moment that turns the bow from the nearer bank"
    )
    steep: float = param(
        0.5, unit="-", lo=0.0, hi=1.0, sd=0.5, doc="share of both that falls off with eta squared"
    )

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        e = self._pull(s.bank_starboard, ship) - self._pull(s.bank_port, ship)
        f = 0.5 * ship.rho * ship.L_pp * ship.T * s.u_r * e
        return ForceVector(Y=f * s.u_r * self.suction, N=-f * abs(s.u_r) * ship.L_pp * self.bow_out)

    def _pull(self, clearance: Number, ship: ShipLike) -> Number:
        eta = ship.B / (ship.B + 2.0 * clearance)
        return eta * (1.0 + self.steep * (3.0 * eta - 1.0))

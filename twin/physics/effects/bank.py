"""Bank suction: the stream between hull and bank runs faster, and pulls the ship to the bank and her bow off it.

e = B/(B + 2 d_starboard) - B/(B + 2 d_port)
Y =  1/2 rho L T   u_r^2     suction  e
N = -1/2 rho L^2 T u_r|u_r|  bow_out  e
"""

from twin.physics.effect import Force, param
from twin.physics.particulars import Ship
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation


class Bank(Force):
    """A bank close by sucks the ship toward it and pushes her bow away, with the square of her speed."""

    needs = ("bank_port", "bank_starboard")
    source = (
        "Norrbin (1974) Bank effects on a ship moving through a short dredged channel, 10th Symp. Naval Hydrodynamics; "
        "Ch'ng, Doctors & Renilson (1993) ISP 40"
    )

    suction: float = param(0.03, unit="-", lo=0.0, hi=0.5, sd=0.05, doc="side force toward the nearer bank")
    bow_out: float = param(0.008, unit="-", lo=0.0, hi=0.15, sd=0.015, doc="moment that turns the bow from the nearer bank")

    def force(self, s: Situation, ship: Ship) -> ForceVector:
        e = ship.B / (ship.B + 2.0 * s.bank_starboard) - ship.B / (ship.B + 2.0 * s.bank_port)
        f = 0.5 * ship.rho * ship.L_pp * ship.T * s.u_r * e
        return ForceVector(Y=f * s.u_r * self.suction, N=-f * abs(s.u_r) * ship.L_pp * self.bow_out)

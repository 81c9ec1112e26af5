"""Another loading condition: heavier or lighter, deeper or shallower, trimmed.

    m -> (1 + mass) m,  T -> k T with k = 1 + draught,  x_G -> x_G + shift,  I_z -> (1 + mass) I_z + m (x_G^2 - x_G0^2)
Added masses in sway and yaw and the hull's lift grow with T^2 (slender body), cross-flow drag with T, the added mass in surge with
m, the resistance with the wetted surface 1.7 L T + C_b L B. Derivatives are stored over T, so that one power of k is there already.
"""

from dataclasses import replace

from twin.physics.effect import Force, param
from twin.physics.maths import maximum
from twin.physics.particulars import Ship
from twin.physics.state import Number

SLENDER = ("Y_vdot", "Y_rdot", "N_vdot", "N_rdot", "Y_uv", "Y_ur", "N_uv", "N_ur")  # prime value grows with T
LEAST = 0.2  # share of the area above the water that stays: superstructure, however deep she lies


class Loading(Force):
    """She is loaded otherwise than the model believes: mass, draught or trim differ, so she answers slower or quicker."""

    source = "Clarke, Gedling & Hine (1983) Trans. RINA 125 (T/L powers); Denny-Mumford wetted surface in Molland et al. (2017)"

    mass: float = param(0.2, unit="-", lo=-0.7, hi=0.6, sd=0.15, doc="mass beyond the model's, as a fraction of it")
    draught: float = param(0.15, unit="-", lo=-0.7, hi=0.6, sd=0.12, doc="draught beyond the model's, as a fraction of it")
    x_G: float = param(
        0.0, unit="m", lo=-0.06, hi=0.06, sd=0.01, of="length",
        doc="shift of the centre of gravity as she steers, ahead positive: what a trim does to her lift is in it, so no loading computer's number",
    )  # fmt: skip

    def alter(self, ship: Ship) -> Ship:
        m, k, x_G = ship.m * (1.0 + self.mass), 1.0 + self.draught, ship.x_G + self.x_G
        d = ship.derivatives
        primes: dict[str, Number] = {name: getattr(d, name) * k for name in SLENDER}
        primes["X_udot"] = d.X_udot * (1.0 + self.mass) / k
        side, bottom = 1.7 * ship.T, ship.C_b * ship.B
        wetter = (side * k + bottom) / (side + bottom) / k
        for name in ("X_u", "X_uu"):
            primes[name] = getattr(d, name) * wetter
        dry = ship.T * self.draught  # freeboard lost [m]
        return replace(
            ship,
            m=m,
            T=ship.T * k,
            x_G=x_G,
            I_z=ship.I_z * (1.0 + self.mass) + m * (x_G * x_G - ship.x_G * ship.x_G),
            A_F=None if ship.A_F is None else maximum(ship.A_F - ship.B * dry, LEAST * ship.A_F),
            A_L=None if ship.A_L is None else maximum(ship.A_L - ship.L_pp * dry, LEAST * ship.A_L),
            derivatives=replace(d, **primes),
        )

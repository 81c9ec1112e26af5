"""Another loading condition: heavier or lighter, deeper or shallower, trimmed.

    m -> (1 + mass) m,  T -> k T with k = 1 + draught,  x_G -> x_G + shift,
        I_z -> (1 + mass) I_z + m (x_G^2 - x_G0^2)
Added masses in sway and yaw and the hull's lift grow with T^2 + a B T, as regressions have them (a slender
body's with T^2 alone), cross-flow drag with T, the added mass in surge with m, the resistance with the wetted
surface 1.7 L T + C_b L B. Derivatives are stored over T, so that one power of k is there already.

A load that stands farther aft trims it by the stern, trim / T = -(shift / L) C_b / C_IL, and its lift moves
aft with its draught:
    Y_uv -> (1 + 0.67 trim / T) Y_uv,  N_uv -> N_uv - 0.27 trim / T Y_uv,  Y_ur -> (1 + 0.8 trim / T) Y_ur,
        N_ur -> (1 + 0.3 trim / T) N_ur
Such regressions miss the derivatives of any one hull by a tenth or two. What added mass, lift and damping
have beyond them are numbers of the load, too.
"""

from dataclasses import replace

from twin.physics.effect import Force, S, param
from twin.physics.maths import maximum
from twin.physics.ship_like import ShipLike
from twin.physics.state import Number

BLUNT = {
    "Y_vdot": (0.0, 0.16),
    "Y_rdot": (0.0, 0.0),
    "N_vdot": (0.0, 0.0),
    "N_rdot": (0.0, 0.2),
    "Y_uv": (0.0, 0.4),
    "Y_ur": (0.16, 0.0),
    "N_uv": (0.0, 0.0),
    "N_ur": (0.16, 0.0),
}  # a of each, and a over C_b; the terms in B/L left out
LIFT = {"Y_uv": 0.67, "Y_ur": 0.8, "N_ur": 0.3}  # share by which a trim of one draught raises them
OWN = (
    "Y_vdot",
    "N_rdot",
    "Y_uv",
    "Y_ur",
    "N_uv",
    "N_ur",
)  # what a hull has otherwise than regressions over many hulls
LEVER = -0.27  # [L] by which N_uv changes with Y_uv
SUPERSTRUCTURE_SHARE = (
    0.2  # share of the area above the water that stays: superstructure, however deep it lies
)


def _beyond(derivative: str) -> float:
    """A number of the load: what one hull's derivative has beyond regressions over many."""
    doc = f"{derivative} beyond what the regressions say, as a share of it"
    return param(0.0, unit="-", lo=-0.3, hi=0.3, sd=0.1, doc=doc)


class Loading(Force):
    """The ship is loaded otherwise than the model believes: mass, draught or trim differ, so it answers
    slower or quicker."""

    source = (
        "Clarke, Gedling & Hine (1983) Trans. RINA 125 (T/L powers); Inoue, Hirano & Kijima (1981) Int. "
        "Shipbuild. Prog. 28 (trim); D'Arcangelo "
        "(1969) in Parsons (2003) Parametric design, ch. 11 (C_IL); Denny-Mumford wetted surface in Molland "
        "et al. (2017)"
    )

    mass: float = param(
        0.2, unit="-", lo=-0.7, hi=0.6, sd=0.15, doc="mass beyond the model's, as a fraction of it"
    )
    draught: float = param(
        0.15, unit="-", lo=-0.7, hi=0.6, sd=0.12, doc="draught beyond the model's, as a fraction of it"
    )
    x_G: float = param(
        0.0,
        unit="m",
        lo=-0.06,
        hi=0.06,
        sd=0.01,
        of="length",
        doc="shift of the centre of gravity, ahead positive; with the trim that follows, so that a loading "
        "computer's number is near it",
    )
    Y_vdot: float = _beyond("Y_vdot")
    N_rdot: float = _beyond("N_rdot")
    Y_uv: float = _beyond("Y_uv")
    Y_ur: float = _beyond("Y_ur")
    N_uv: float = _beyond("N_uv")
    N_ur: float = _beyond("N_ur")

    def alter(self, ship: S) -> S:
        m, k, x_G = ship.m * (1.0 + self.mass), 1.0 + self.draught, ship.x_G + self.x_G
        d = ship.derivatives
        primes: dict[str, Number] = {name: getattr(d, name) * deeper(ship, name, k) for name in BLUNT}
        trim = -self.x_G * trim_per_shift(ship)
        primes["N_uv"] = primes["N_uv"] + LEVER * trim * primes["Y_uv"]
        primes |= {name: primes[name] * (1.0 + share * trim) for name, share in LIFT.items()}
        for name in OWN:
            primes[name] = primes[name] * (1.0 + getattr(self, name))
        primes["X_udot"] = d.X_udot * (1.0 + self.mass) / k
        side, bottom = 1.7 * ship.T, ship.C_b * ship.B
        wetter = (side * k + bottom) / (side + bottom) / k
        for name in ("X_u", "X_uu", "X_uuu"):
            primes[name] = getattr(d, name) * wetter
        dry = ship.T * self.draught  # freeboard lost [m]
        return replace(
            ship,
            m=m,
            T=ship.T * k,
            x_G=x_G,
            I_z=ship.I_z * (1.0 + self.mass) + m * (x_G * x_G - ship.x_G * ship.x_G),
            A_F=None
            if ship.A_F is None
            else maximum(ship.A_F - ship.B * dry, SUPERSTRUCTURE_SHARE * ship.A_F),
            A_L=None
            if ship.A_L is None
            else maximum(ship.A_L - ship.L_pp * dry, SUPERSTRUCTURE_SHARE * ship.A_L),
            derivatives=replace(d, **primes),
        )


def deeper(ship: ShipLike, name: str, k: Number) -> Number:
    """Factor on a prime derivative when the draught is k times what it was."""
    a, full = BLUNT[name]
    share = (a + full * ship.C_b) * ship.B / ship.T
    return (k + share) / (1.0 + share)


def trim_per_shift(ship: ShipLike) -> Number:
    """Trim over draught for a shift of the centre of gravity of one metre: L / BM_L, BM_L = C_IL L^2 / (C_b
    T) [1/m]."""
    C_wp = waterplane(ship)
    return ship.C_b / ((0.35 * C_wp * C_wp - 0.405 * C_wp + 0.146) * ship.L_pp)


def waterplane(ship: ShipLike) -> Number:
    """C_wp as hulls of this fullness usually have it [Schneekluth & Bertram 1998, ship design for efficiency
    and economy, sec. 1.6]."""
    return (1.0 + 2.0 * ship.C_b) / 3.0

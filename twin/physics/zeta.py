"""zeta: what the learned residual looks at, without dimensions, so that one network form serves every
ship.

Each number is worked out from a situation and the ship's own scales, for floats, arrays and tensors alike;
the live loop and the training use this one table. A number whose measurement is missing is None.
"""

from collections.abc import Callable
from typing import NamedTuple

from .maths import cos, sin
from .ship_like import ShipLike
from .state import Number, Situation


class Zeta(NamedTuple):
    """One input: its formula in words, and how it is worked out."""

    formula: str
    of: Callable[[Situation, ShipLike], Number]
    needs: tuple[str, ...] = ()


def _air(s: Situation) -> tuple[Number, Number]:
    """The air past the ship, body axes [m/s]: where it goes, seen from it."""
    return s.wind_speed * cos(s.wind_to - s.psi) - s.u, s.wind_speed * sin(s.wind_to - s.psi) - s.v


WIND, WAVES = ("wind_speed", "wind_to"), ("H_s", "wave_to")
ZETA: dict[str, Zeta] = {
    "surge": Zeta("u_r / U_0", lambda s, ship: s.u_r / ship.U_0),
    "sway": Zeta("v_r / U_0", lambda s, ship: s.v_r / ship.U_0),
    "yaw": Zeta("r L_pp / U_0", lambda s, ship: s.r * ship.L_pp / ship.U_0),
    "rudder": Zeta("delta [rad]", lambda s, ship: s.delta),
    "propeller": Zeta("n D_P / U_0", lambda s, ship: s.n * ship.D_P / ship.U_0),
    "air_ahead": Zeta("air past the ship towards the bow / U_0", lambda s, ship: _air(s)[0] / ship.U_0, WIND),
    "air_starboard": Zeta(
        "air past the ship towards starboard / U_0", lambda s, ship: _air(s)[1] / ship.U_0, WIND
    ),
    "wave_ahead": Zeta(
        "H_s / L_pp cos(wave_to - psi)", lambda s, ship: s.H_s / ship.L_pp * cos(s.wave_to - s.psi), WAVES
    ),
    "wave_starboard": Zeta(
        "H_s / L_pp sin(wave_to - psi)", lambda s, ship: s.H_s / ship.L_pp * sin(s.wave_to - s.psi), WAVES
    ),
    "shallow": Zeta("T / depth", lambda s, ship: ship.T / s.depth, ("depth",)),
    "roll": Zeta("phi [rad]", lambda s, ship: s.phi, ("phi",)),
}


def inputs(names: tuple[str, ...], s: Situation, ship: ShipLike) -> list[Number]:
    """The named inputs of one situation, in order; None for each whose measurement is missing. s.u_r,
    s.v_r must be set."""
    out = []
    for name in names:
        zeta = ZETA[name]
        missing = [need for need in zeta.needs if getattr(s, need) is None]
        out.append(None if missing else zeta.of(s, ship))
    return out

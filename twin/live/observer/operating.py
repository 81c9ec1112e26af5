"""The operating set: the motions and the inputs for which something is promised.

In the ship's own scales, so that one rule serves a 2 m boat and a 320 m tanker: speed through the water in
U_0, turning in U_0/L, depth in draughts, propeller in the rate that drives it at U_0. Outside it the
certificate says nothing, and the twin says that.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import hypot, inf, isfinite, pi

from twin.errors import SettingsError
from twin.num import num
from twin.physics import core
from twin.physics.maths import clip
from twin.physics.model import Model
from twin.physics.state import Rates, Situation

NU = ("u", "v", "r")
MOTION = (*NU, "stream")
EVERYTHING = (-inf, inf)
TURNING = ("v", "r")
FARTHER = 1.6  # 0.4 U_0 aside, 0.8 U_0/L: hulls are tested to 20 or 25 deg of drift and to 0.9
WORDS = {
    "u": "surge speed through water",
    "v": "sway speed through water",
    "r": "rate of turn",
    "stream": "current",
    "delta": "rudder angle",
    "n": "propeller rate",
    "wind_speed": "wind",
    "depth": "water depth",
    "H_s": "wave height",
    "T_p": "wave period",
    "draught": "draught",
    "bank_port": "distance to the port bank",
    "bank_starboard": "distance to the starboard bank",
    "phi": "roll",
}
KNOT = 1852.0 / 3600.0  # [m/s]
BORDER_UNITS = {  # the unit in which a bridge reads it, and how much of it one in SI is; the others in metres
    "u": ("kn", 1.0 / KNOT),
    "v": ("kn", 1.0 / KNOT),
    "stream": ("kn", 1.0 / KNOT),
    "r": ("°/min", 60.0 * 180.0 / pi),
    "delta": ("°", 180.0 / pi),
    "phi": ("°", 180.0 / pi),
    "n": ("1/min", 60.0),
    "wind_speed": ("m/s", 1.0),
    "T_p": ("s", 1.0),
}


@dataclass(frozen=True)
class OperatingSet:
    """Field of Situation -> (least, greatest) in SI, u and v through the water, `stream` the speed of the
    current over ground.

    An angle that runs round the circle is always inside.
    """

    ranges: Mapping[str, tuple[float, float]]

    @property
    def whole(self) -> bool:
        """Whether every range is two finite numbers that do not fall, those of u, v, r among them; TypeError
        or ValueError where one is no pair of numbers."""
        return all(name in self.ranges for name in NU) and all(
            -inf < least <= greatest < inf for least, greatest in self.ranges.values()
        )

    @property
    def reach(self) -> Mapping[str, tuple[float, float]]:
        """The ranges to which a live bound may reach that goes by the slopes where the ship is: with the sway
        and turning of a hard turn, which need not make it wide at all other times."""
        wide = {name: self.ranges[name] for name in TURNING}
        return {**self.ranges, **{name: (FARTHER * lo, FARTHER * hi) for name, (lo, hi) in wide.items()}}

    def clip(self, nu: tuple[float, float, float]) -> tuple[float, float, float]:
        """The motion through water inside the set that is nearest (floats or arrays)."""
        (u, v, r), at = nu, self.ranges
        return clip(u, *at["u"]), clip(v, *at["v"]), clip(r, *at["r"])

    def outside(self, s: Situation, within: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> str | None:
        """The first thing that lies outside, in words; None when all is inside. s.u_r and s.v_r are set, as
        Model.known does.

        `within` widens the motion by its bound.
        """
        values = s.u_r, s.v_r, s.r, hypot(s.u - s.u_r, s.v - s.v_r)
        for (name, lo, hi), value, b in zip(self._motion, values, (*within, 0.0), strict=True):
            if not lo + b <= value <= hi - b:
                return outside_in_words(name, value, b, lo, hi)
        for name, lo, hi in self._inputs:
            value = getattr(s, name)
            if value is not None and not lo <= value <= hi:
                return outside_in_words(name, value, 0.0, lo, hi)
        return None

    def room(self, s: Situation, within: tuple[float, float, float]) -> tuple[float, float, float]:
        """How far a motion through the water that is known within that is from the nearer end of its range
        [m/s, m/s, rad/s]."""
        u, v, r = [
            min(value - lo, hi - value) - b
            for (_, lo, hi), value, b in zip(self._motion, (s.u_r, s.v_r, s.r), within, strict=False)
        ]
        return u, v, r

    @cached_property
    def _motion(self) -> list[tuple[str, float, float]]:
        return [(name, *self.ranges.get(name, EVERYTHING)) for name in MOTION]

    @cached_property
    def _inputs(self) -> list[tuple[str, float, float]]:
        return [(name, *self.ranges[name]) for name in WORDS if name in self.ranges and name not in MOTION]


def outside_in_words(name: str, value: float, bound: float, lo: float, hi: float) -> str:
    """That a number [SI] lies outside, or may within its bound, in the bridge's units."""
    how = f" ± {in_unit(name, bound)}" if bound else ""
    ends = f"{in_unit(name, lo, False)} to {in_unit(name, hi)}"
    return f"{WORDS[name]} = {in_unit(name, value, not bound)}{how}, outside {ends}"


def in_unit(name: str, value: float, unit: bool = True) -> str:
    """A number [SI] in the bridge's unit, with it or without."""
    words, factor = BORDER_UNITS.get(name, ("m", 1.0))
    return num(factor * value, 3) + (f" {words}" if unit else "")


@dataclass(frozen=True)
class Confined(Model):
    """The same physics with the motion clipped to the operating set wherever it is evaluated: what the
    observer integrates.

    Inside the set nothing changes; outside, forces are those of the nearest motion inside, so that their
    slopes stay bounded.
    """

    operating: OperatingSet | None = None

    @classmethod
    def to(cls, model: Model, operating: OperatingSet) -> "Confined":
        """The model, asked only within this set."""
        return cls(model.ship, model.effects, model.residual, operating)

    def nu_dot(self, s: Situation) -> Rates:
        assert self.operating is not None
        w = self.water(s)
        u, v, s.r = self.operating.clip((s.u - w.u, s.v - w.v, s.r))
        s.u, s.v = u + w.u, v + w.v
        return super().nu_dot(s)


def of_ship(model: Model, **ranges: tuple[float, float]) -> OperatingSet:
    """The set a ship is certified for unless told otherwise; named ranges replace those of the rule.
    SettingsError: a range is none, or nothing has that name."""
    ship = model.loaded
    U, L, T = ship.U_0, ship.L_pp, ship.T
    n = propeller_rate(model)
    rule = {
        "u": (0.15 * U, 1.1 * U),
        "v": (-0.25 * U, 0.25 * U),
        "r": (-0.5 * U / L, 0.5 * U / L),
        "psi": (-pi, pi),
        "stream": (0.0, 0.25 * U),
        "delta": (-35.0 * pi / 180.0, 35.0 * pi / 180.0),
        "n": (-0.6 * n, 1.25 * n),
        "t": (0.0, 3600.0),
        "wind_speed": (0.0, 22.0),
        "wind_to": (-pi, pi),
        "depth": (1.5 * T, 1e4 * T),
        "H_s": (0.0, min(8.0, 0.1 * L)),
        "T_p": (min(1.0, 0.25 * L**0.5), 25.0),
        "wave_to": (-pi, pi),
        "draught": (0.6 * T, 1.2 * T),
        "bank_port": (0.5 * ship.B, 1e4 * L),
        "bank_starboard": (0.5 * ship.B, 1e4 * L),
        "phi": (-0.35, 0.35),
    }
    for name, (lo, hi) in ranges.items():
        if name not in rule or not lo < hi or not (isfinite(lo) and isfinite(hi)):
            raise SettingsError(
                f"operating set: {name} = [{lo}, {hi}] is no range of {', '.join(rule)}. Correct it."
            )
    return OperatingSet(rule | ranges)


def propeller_rate(model: Model) -> float:
    """The propeller rate that drives the ship straight at U_0 [1/s], by bisection."""
    c, U = model.c, model.loaded.U_0

    def surplus(n: float) -> float:
        return core.propeller(core.thrust(U, n, c), c)[0] + core.damping(U, 0.0, 0.0, c)[0]

    low, high = 0.0, 2.0 * U / model.loaded.D_P
    while surplus(high) < 0.0 and high < 1e4:
        high *= 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if surplus(middle) > 0.0 else (middle, high)
    return high

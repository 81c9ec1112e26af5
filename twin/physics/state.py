"""Names, units and frames: what a ship is doing, what is done to it, and the force that results.

Earth axes are north-east-down, body axes x forward, y to starboard, origin at midship on the centreline
[Fossen 2021, ch. 2]. SI and radians throughout. Every number may be a float, an array, a tensor or a symbol.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

Number = Any
Growth = tuple[Number, Number]  # of the added mass in sway and of the added inertia in yaw, as shares of them
LIGHT: Growth = (0.0, 0.0)


class Force(NamedTuple):
    """Force and moment in body axes: X ahead [N], Y to starboard [N], N turning to starboard [N m]."""

    X: Number = 0.0
    Y: Number = 0.0
    N: Number = 0.0

    def __add__(self, other: "Force") -> "Force":  # type: ignore[override]
        return Force(self.X + other.X, self.Y + other.Y, self.N + other.N)


class Water(NamedTuple):
    """The water an effect makes the ship feel.

    (u, v): its velocity in body axes [m/s]. (k_u, k_v, k_r): by how much it holds the hull harder in surge,
    sway and yaw, as shares of the hull's damping, in yaw of the whole moment, Munk's included (a bottom
    squeezes the stream past it; propeller and rudder, in the wake, do not feel it). k_m, k_j: by how much
    more of it sways and turns with it, as shares of the added mass in sway and of the added inertia in yaw.
    k_t: share of the thrust that drives it by which it takes the ship back (thrust deduction).
    """

    u: Number = 0.0
    v: Number = 0.0
    k_u: Number = 0.0
    k_v: Number = 0.0
    k_r: Number = 0.0
    k_m: Number = 0.0
    k_j: Number = 0.0
    k_t: Number = 0.0


STILL_WATER = Water()


class Rates(NamedTuple):
    """d(nu)/dt in body axes [m/s2, m/s2, rad/s2]."""

    u: Number
    v: Number
    r: Number


@dataclass(slots=True)
class Situation:
    """A ship at one moment (or at many: every field may be an array over time).

    eta = (x, y, psi) [m, m, rad]; nu = (u, v, r) over ground, body axes [m/s, m/s, rad/s]; (u_r, v_r)
        through the water.
    A field that is None was not measured; an effect that needs it is switched off.
    """

    x: Number = 0.0
    y: Number = 0.0
    psi: Number = 0.0
    u: Number = 0.0
    v: Number = 0.0
    r: Number = 0.0
    u_r: Number = 0.0
    v_r: Number = 0.0
    k_m: Number = 0.0  # by how much the added mass in sway has grown, as a share of it
    k_j: Number = 0.0  # and the added inertia in yaw
    delta: Number = 0.0  # rudder [rad], positive turns to starboard
    n: Number = 0.0  # propeller [1/s], positive ahead
    # what is recorded of a ship's actuators, by `name.attribute` in SI; None: one propeller, one rudder
    orders: Any = None
    t: Number = 0.0  # time since the voyage began [s]
    wind_speed: Number = None  # over ground [m/s]
    wind_to: Number = None  # the direction it blows to [rad]
    depth: Number = None  # surface to bottom [m]
    H_s: Number = None  # significant wave height [m]
    T_p: Number = None  # peak period [s]
    wave_to: Number = None  # the direction the waves run to [rad]
    draught: Number = None  # mean draught [m]
    bank_port: Number = None  # from the ship's side to the bank [m]
    bank_starboard: Number = None
    phi: Number = None  # roll [rad], starboard side down positive
    p: Number = None  # and its rate [rad/s], where it was worked out: only a high antenna asks for it
    # acceleration over ground in body axes [m/s2], where it was worked out: only a late sensor asks for it
    u_dot: Number = 0.0
    v_dot: Number = 0.0
    r_dot: Number = 0.0  # and of the turning [rad/s2]

    @property
    def grown(self) -> Growth:
        """Shares by which the added mass in sway, and the added inertia in yaw, grow."""
        return self.k_m, self.k_j


WEATHER = (
    "wind_speed",
    "wind_to",
    "depth",
    "H_s",
    "T_p",
    "wave_to",
    "draught",
    "bank_port",
    "bank_starboard",
    "phi",
)

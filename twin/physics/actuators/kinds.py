"""The kinds of actuator: what each needs to be told, and the force it gives."""

from collections.abc import Callable, Mapping
from typing import NamedTuple, Protocol

from twin.physics import core
from twin.physics.maths import cos, positive, sin, sqrt
from twin.physics.ship_like import ShipLike
from twin.physics.state import Number

Orders = Mapping[str, Number]
STOP_US, SPAN_US = 1500.0, 400.0  # a controller's pulse at stop, and from there to full
TINY, NARROW = 1e-6, 1e-9  # nothing is divided by none


class OneActuator(Protocol):
    """What a kind reads of an actuator: its numbers, what is recorded of it, and the ship's with its own."""

    @property
    def kind(self) -> str:
        """One of KINDS."""

    @property
    def of_kind(self) -> "ForceOf":
        """What its kind gives."""

    @property
    def x(self) -> Number:
        """Ahead of midship [m]."""

    @property
    def y(self) -> Number:
        """To starboard of the centreline [m]."""

    @property
    def strength(self) -> Number:
        """Its own thrust over what its curve says [-]."""

    @property
    def zero(self) -> Number:
        """Command at which it gives nothing [-]."""

    @property
    def trim(self) -> Number:
        """True angle less the recorded one [rad]."""

    @property
    def ahead(self) -> Number:
        """Greatest thrust ahead at rest [N]."""

    @property
    def astern(self) -> Number:
        """Greatest thrust astern at rest [N]."""

    @property
    def dead(self) -> Number:
        """Command up to which it stands still [-]."""

    @property
    def linear(self) -> Number:
        """Share of the bollard curve that is a straight line."""

    @property
    def slow(self) -> Number:
        """Thrust lost at the service speed U_0, as a share of the greatest [-]."""

    @property
    def reverse(self) -> Number:
        """Thrust astern over what its curve says [-]."""

    @property
    def stall(self) -> Number:
        """How fast thrust is lost where the water runs against it [-]."""

    @property
    def sag(self) -> Number:
        """How far thrust over speed sags below its straight line [-]."""

    @property
    def drag(self) -> Number:
        """Drag where the water overruns the blades [-]."""

    @property
    def strut(self) -> Number:
        """Area of the leg that turns with it times the slope of its normal force, over D^2 [-]."""

    @property
    def D(self) -> Number:
        """Propeller diameter [m]."""

    @property
    def K_T0(self) -> Number:
        """Thrust coefficient at J = 0 [-]."""

    @property
    def K_T1(self) -> Number:
        """Slope of the thrust coefficient over J [-]."""

    @property
    def pitch_0(self) -> Number:
        """Pitch over diameter that K_T0 is of [-]."""

    @property
    def U_half(self) -> Number:
        """Speed at which half of a tunnel thruster's force is left [m/s]."""

    @property
    def keys(self) -> Mapping[str, str]:
        """The name under which each of its attributes is recorded."""

    def coefficients(self, ship: ShipLike) -> core.Coefficients:
        """The ship's numbers with this propeller and rudder in place of its own."""


ForceOf = Callable[[OneActuator, Orders, Number, Number, Number, ShipLike], core.Tau]


class Kind(NamedTuple):
    """`needs`: attributes that must be recorded beside one that says how hard it pushes; `legs`: whether what
    carries it turns with it; `reads`: the ship's derivatives on which its force depends; `noun`: what a
    seafarer calls it; `turned`: what its angle is of, where that is a part of its own; `all_round`: whether
    it turns all round, not to either side of amidships as a rudder does."""

    force: ForceOf
    needs: tuple[str, ...]
    may: tuple[str, ...]
    doc: str
    legs: bool = False
    reads: tuple[str, ...] = ()
    noun: str = "thruster"
    turned: str = ""
    all_round: bool = False


def push(a: OneActuator, orders: Orders, u_a: Number, ship: ShipLike) -> Number:
    """Thrust [N] along the actuator's own axis, with the water running along it at u_a [m/s]."""
    has = a.keys
    if "thrust" in has:
        return a.strength * orders[has["thrust"]]
    if "rate" in has:
        pitch = orders[has["pitch"]] / a.pitch_0 if "pitch" in has else 1.0
        return _by_turns(a, orders[has["rate"]], pitch, u_a, ship)
    c = orders[has["command"]] if "command" in has else (orders[has["pwm"]] - STOP_US) / SPAN_US
    return _by_command(a, c, u_a, ship)


def _by_turns(a: OneActuator, n: Number, pitch: Number, u_a: Number, ship: ShipLike) -> Number:
    drive = n * pitch  # negative where it pushes astern
    at_rest = a.K_T0 * n * pitch + a.K_T0 * (1.0 - a.reverse) * positive(-drive)
    water = a.K_T1 * u_a / a.D
    line = (at_rest + water) * (1.0 - a.sag * _nearing(-at_rest * water, at_rest * at_rest))
    T = a.strength * (ship.rho * a.D**4) * abs(n) * line
    nD = n * a.D
    T = T * _left(a, positive(-drive * a.D * u_a) ** 2, nD**4)
    over = positive(abs(u_a) - a.K_T0 / (TINY - a.K_T1) * abs(drive) * a.D)
    return T - a.strength * a.drag * (ship.rho * a.D**2) * _against(u_a, over)


def _by_command(a: OneActuator, c: Number, u_a: Number, ship: ShipLike) -> Number:
    ahead = positive(c - a.zero - a.dead, 1e-8) / (1.0 - a.dead)
    astern = positive(a.zero - c - a.dead, 1e-8) / (1.0 - a.dead)
    on, off, w = _curve(a, ahead), _curve(a, astern), u_a / ship.U_0  # shares of the greatest, at rest
    T_ahead = a.ahead * _left(a, positive(-w) ** 2, on)
    T_astern = a.reverse * a.astern * _left(a, positive(w) ** 2, off)
    at_rest = T_ahead * on - T_astern * off
    T = at_rest - a.slow * (T_ahead * ahead + T_astern * astern) * u_a / ship.U_0
    less_on, less_off = a.slow * ahead * w, -a.slow * astern * w
    sags = T_ahead * (on - less_on) * _nearing(less_on, on)
    sags = sags - T_astern * (off - less_off) * _nearing(less_off, off)
    over = positive(abs(w) - sqrt(on + off + 1e-9) / (a.slow + TINY))
    return a.strength * (T - a.sag * sags - a.drag * a.ahead * _against(w, over))


def _nearing(less: Number, at_rest: Number) -> Number:
    """J/J_0, how near the speed is to that of no thrust, 0 to 1: `less` is what the water takes of the thrust
    `at_rest`."""
    return positive(less, NARROW) / (at_rest + positive(less - at_rest, NARROW))


def _against(u_a: Number, over: Number) -> Number:
    """over |over|, against the motion: the square of the speed by which the water overruns the blades."""
    return over * over * u_a / (abs(u_a) + TINY)


def _curve(a: OneActuator, e: Number) -> Number:
    return (a.linear + (1.0 - a.linear) * e) * e


def _left(a: OneActuator, against: Number, turning: Number) -> Number:
    """Share of the thrust that is left where the water runs against it: 1/(1 + stall J^2), of which J^2 =
    against/turning."""
    stalled = a.stall * against
    return 1.0 - stalled / (turning + stalled + 1e-12)


def _at(a: OneActuator, X: Number, Y: Number) -> core.Tau:
    """A force where the actuator stands, with its moment about midship."""
    return X, Y, a.x * Y - a.y * X


def fixed(a: OneActuator, orders: Orders, u: Number, v: Number, r: Number, ship: ShipLike) -> core.Tau:
    """Its thrust pushes ahead, wherever it stands."""
    return _at(a, push(a, orders, u - a.y * r, ship), 0.0)


def azimuth(a: OneActuator, orders: Orders, u: Number, v: Number, r: Number, ship: ShipLike) -> core.Tau:
    """Its angle is where the thrust pushes the ship to: 0 ahead, positive to starboard."""
    angle = orders[a.keys["angle"]] + a.trim
    c, s = cos(angle), sin(angle)
    ahead, aside = u - a.y * r, v + a.x * r
    along = ahead * c + aside * s
    T, F = push(a, orders, along, ship), _leg(a, along, aside * c - ahead * s, ship)
    return _at(a, T * c - F * s, T * s + F * c)


def steered(a: OneActuator, orders: Orders, u: Number, v: Number, r: Number, ship: ShipLike) -> core.Tau:
    """Its angle is counted like a rudder's: positive turns the ship to starboard when the jet is astern."""
    angle = orders[a.keys["angle"]] + a.trim
    c, s = cos(angle), sin(angle)
    T = push(a, orders, u - a.y * r, ship)
    return _at(a, T * c, -T * s)


def outboard(a: OneActuator, orders: Orders, u: Number, v: Number, r: Number, ship: ShipLike) -> core.Tau:
    """As a waterjet's, and its leg turns with it as a rudder does."""
    angle = orders[a.keys["angle"]] + a.trim
    c, s = cos(angle), sin(angle)
    ahead, aside = u - a.y * r, v + a.x * r
    T, F = push(a, orders, ahead, ship), _leg(a, ahead * c - aside * s, ahead * s + aside * c, ship)
    return _at(a, T * c + F * s, F * c - T * s)


def _leg(a: OneActuator, along: Number, across: Number, ship: ShipLike) -> Number:
    """Force [N] across its own axis on the leg that carries it, a short fin in water that runs at (along,
    across) [m/s]: -1/2 rho strut D^2 across |.|, and T_ahead/(rho U_0^2) for D^2 where no diameter is
    known."""
    of_thrust = 0.0 if a.ahead is None else a.ahead / (ship.rho * ship.U_0**2)
    area = a.strut * (of_thrust if a.D is None else a.D * a.D)
    return -0.5 * ship.rho * area * across * sqrt(along * along + across * across + NARROW)


def tunnel(a: OneActuator, orders: Orders, u: Number, v: Number, r: Number, ship: ShipLike) -> core.Tau:
    """Pushes to starboard when told to go ahead, the less the faster the ship: half of it at U_half."""
    share = 1.0 if a.U_half is None else 1.0 / (1.0 + (u / a.U_half) ** 2)
    return _at(a, 0.0, share * push(a, orders, v + a.x * r, ship))


def propeller(a: OneActuator, orders: Orders, u: Number, v: Number, r: Number, ship: ShipLike) -> core.Tau:
    """As the ship's own propeller and rudder, with the hull's wake and thrust deduction."""
    c, along = a.coefficients(ship), u - a.y * r
    T = push(a, orders, c.wake_share * along, ship)
    X, Y, N = c.thrust_share * T, 0.0, 0.0
    if "angle" in a.keys:
        drag, Y, N = core.rudder(along, v, r, orders[a.keys["angle"]] + a.trim, T, c)
        X = X + drag
    return X, Y, N - a.y * X


OF_WAKE = ("t", "w", "epsilon", "kappa", "C_L", "t_R", "a_H", "x_H", "gamma_v", "gamma_r", "gamma_a")
IN_WAKE = "on a shaft, with or without a rudder in its slipstream"
KINDS: dict[str, Kind] = {
    "propeller": Kind(propeller, (), ("angle",), IN_WAKE, False, OF_WAKE, "propeller", "rudder"),
    "controllable_pitch": Kind(
        propeller, ("pitch",), ("angle",), "a shaft whose blades turn", False, OF_WAKE, "propeller", "rudder"
    ),
    "fixed_thruster": Kind(fixed, (), (), "pushes along the ship"),
    "azimuth": Kind(
        azimuth,
        ("angle",),
        (),
        "turns all round; its angle: where it pushes the ship to",
        True,
        noun="azimuth thruster",
        all_round=True,
    ),
    "waterjet": Kind(steered, ("angle",), (), "its angle is counted like a rudder's", noun="waterjet"),
    "outboard": Kind(outboard, ("angle",), (), "its angle is counted like a rudder's", True, noun="outboard"),
    "tunnel_thruster": Kind(tunnel, (), (), "pushes to starboard when told to go ahead"),
}

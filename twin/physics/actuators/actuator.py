# ruff: noqa: RUF009  (a number is declared by a call)
"""One actuator of a ship: what it is, where it stands, what is recorded of it, and its numbers.

A command c (a share of full, or a pulse width counted from 1500 us in spans of 400 us) gives at rest

    T_0 = T_ahead g(c - zero) - T_astern g(zero - c),   g(x) = linear e + (1 - linear) e^2,
    e = max(x - dead, 0)/(1 - dead)

and with the water running along it, u_a, T = k (T_0 - slow (T_ahead e_ahead + T_astern e_astern) u_a/U_0).
Turns n give T = k rho D^4 (K_T0 |n| n + K_T1 |n| u_a/D) [Fossen 2021, ch. 9],
k = gain own_gain: what the make gives over its curve, and what this one gives over its make.

Of the thrust at rest astern `reverse` is there (blades are cambered for going ahead), and where the water
runs against the thrust (second and fourth quadrant) the flow breaks down and 1/(1 + stall J^2) is left, with
J = u_a/(n D), or of a command J^2 = (u_a/U_0)^2/g. That thrust differs by quadrant: Fossen (2021), ch. 9;
the form of `stall` is this twin's own.

Between rest and the advance J_0 = -K_T0/K_T1 of no thrust (of a command: where `slow` leaves nothing) the
curve of a propeller is no straight line:

    K_T = K_T0 (1 - j) (1 - sag j),   j = J/J_0

(the parabola of MMG, K_T2 = sag K_T1^2/K_T0: KVLCC2 has sag = -0.28 [Yasukawa & Yoshimura 2015]). Beyond
J_0 the water overruns the blades, and a screw that stands still or is dragged along holds against the
motion: less drag rho D^2 (|u_a| - J_0 |n| D)^2, of a command less drag T_ahead (|u_a|/U_0 - sqrt(g)/slow)^2
[Carlton 2018, ch. 6, propellers in four quadrants: C_T at beta = 90 deg]. reverse = 1, stall = 0, sag = 0
and drag = 0 change nothing.

What carries the propeller of an azimuth or an outboard turns with it and is a short fin: water that runs at
(along, across) its axis pushes across it with -1/2 rho strut D^2 across |.| (of a command T_ahead/(rho U_0^2)
for D^2). On a ship with way on that is a rudder's force, and may be more than the thrust's own part across
the ship [Carlton 2018, ch. 15: azimuthing units in oblique flow]. strut = 0 changes nothing.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Self

from twin.physics.core import Coefficients, Tau, coefficients
from twin.physics.number import number
from twin.physics.ship_like import ShipLike
from twin.physics.state import Number

from .actuator_channels import CHANNELS_OF
from .kept_forces import KeptOrders
from .kinds import KINDS

# By how much the thrust of healthy actuators of one make usually differs (standard deviation): a propeller's
# pitch may be off by 3 % (ISO 484-2:2015, class III), and its thrust at rest goes with its pitch; and each
# has aged by 4.5 % (0.3 of the prior of ThrusterWear, as a diagnosis takes any healthy ship).
OF_ONE_MAKE = 0.05


@dataclass(frozen=True)
class Actuator:
    """Forces come from `force`; `channels` are what is recorded of it, such as ("rate_rpm", "angle_deg").

    The metadata of each number: unit, range, meaning, `sd` of its prior where reference voyages may tell it,
    `key` in the ship file, `of`: the attributes one of which must be recorded for it to matter, and `legs`:
    whether only kinds with a leg have it."""

    name: str
    kind: str
    channels: tuple[str, ...]
    x: Number = number(0.0, "m", -300.0, 300.0, "ahead of midship", key="x_m")
    y: Number = number(0.0, "m", -60.0, 60.0, "to starboard of the centreline", key="y_m")
    gain: Number = number(1.0, "-", 0.0, 5.0, "thrust over what its curve says", sd=0.2)
    own_gain: Number = number(1.0, "-", 0.0, 5.0, "its own thrust over that of its make", sd=OF_ONE_MAKE)
    zero: Number = number(0.0, "-", -0.5, 0.5, "command at which it gives nothing", sd=0.01, of="command pwm")
    trim: Number = number(
        0.0, "rad", -3.2, 3.2, "true angle less the recorded one", sd=0.03, key="trim_rad", of="angle"
    )
    ahead: Number = number(None, "N", 1e-3, 1e7, "greatest thrust ahead at rest", key="ahead_n")
    astern: Number = number(None, "N", 1e-3, 1e7, "greatest thrust astern at rest", key="astern_n")
    dead: Number = number(0.0, "-", 0.0, 0.5, "command up to which it stands still")
    linear: Number = number(
        0.0, "-", 0.0, 1.0, "share of the bollard curve that is a straight line", sd=0.3, of="command pwm"
    )
    slow: Number = number(
        0.2, "-", 0.0, 2.0, "thrust lost at service speed, of the greatest", sd=0.3, of="command pwm"
    )
    reverse: Number = number(
        1.0, "-", 0.05, 2.0, "thrust astern over what its curve says", sd=0.2, of="command pwm rate"
    )
    stall: Number = number(
        0.0, "-", 0.0, 20.0, "thrust lost where the water runs against it", sd=1.0, of="command pwm rate"
    )
    sag: Number = number(
        0.0, "-", -1.0, 1.2, "by how much thrust over speed sags below a line", sd=0.3, of="command pwm rate"
    )
    drag: Number = number(
        0.0, "-", 0.0, 2.0, "drag where the water overruns the blades", sd=0.2, of="command pwm rate"
    )
    strut: Number = number(
        0.0, "-", 0.0, 5.0, "leg's area times its normal force's slope, over D^2", sd=0.7, legs=True
    )
    D: Number = number(None, "m", 0.005, 15.0, "propeller diameter", key="diameter_m")
    K_T0: Number = number(0.32, "-", 0.02, 1.5, "thrust coefficient at J = 0")
    K_T1: Number = number(-0.32, "-", -1.5, 0.0, "slope of the thrust coefficient over J", sd=0.1, of="rate")
    pitch_0: Number = number(0.8, "-", 0.1, 2.0, "pitch over diameter that K_T0 is of", key="pitch_ratio")
    A_R: Number = number(None, "m2", 1e-5, 250.0, "area of the rudder behind it", key="rudder_area_m2")
    U_half: Number = number(
        None, "m/s", 0.05, 40.0, "speed at which half of a tunnel thruster's force is left", key="half_mps"
    )
    # the ship's own propeller and rudder with this one's numbers, made once
    _made: dict[Any, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    def but(self, **numbers: Number) -> Self:
        """The same with some of its numbers changed."""
        return replace(self, **numbers)

    @cached_property
    def strength(self) -> Number:
        """Its own thrust over what the curve of its make says."""
        return self.gain * self.own_gain

    @cached_property
    def attributes(self) -> tuple[str, ...]:
        """What is recorded of it, as physics calls it."""
        return tuple(CHANNELS_OF[c].attribute for c in self.channels)

    def called(self, turned: bool = False) -> str:
        """What a seafarer calls it: "port propeller", "bow thruster"; `turned`: what its angle is of, such as
        "port rudder"."""
        words, kind = self.name.replace("_", " "), KINDS[self.kind]
        noun = kind.turned if turned and kind.turned else kind.noun
        known = set(noun.split()) & set(words.lower().split())
        return words if known else f"{words} {noun}"

    def columns(self) -> tuple[str, ...]:
        """Its channels by their whole names, as a voyage has them."""
        return tuple(f"{self.name}.{c}" for c in self.channels)

    def estimated(self) -> tuple[str, ...]:
        """Its numbers that voyages can tell."""
        has = self.attributes
        legs = KINDS[self.kind].legs and not (self.D is None and self.ahead is None)
        return tuple(
            f.name
            for f in NUMBERS.values()
            if f.metadata["sd"]
            and (not f.metadata.get("of") or set(f.metadata["of"].split()) & set(has))
            and (legs or not f.metadata.get("legs"))
        )

    @property
    def make(self) -> tuple[object, ...]:
        """What actuators of one make have in common, wherever they stand and however they have aged."""
        return self.kind, self.channels, *(getattr(self, n) for n in BY_MAKE)

    def coefficients(self, ship: ShipLike) -> Coefficients:
        """The coefficients of the ship's propeller and rudder, with this one's numbers."""
        key = id(ship)
        if key not in self._made or self._made[key][0] is not ship:
            own: dict[str, Any] = {"K_T0": self.K_T0, "K_T1": self.K_T1, "x_R": self.x / ship.L_pp}
            made = replace(
                ship,
                D_P=self.D,
                A_R=0.0 if self.A_R is None else self.A_R,
                actuators=(),
                derivatives=replace(ship.derivatives, **own),
            )
            self._made.clear()
            self._made[key] = (ship, coefficients(made))
        return self._made[key][1]  # type: ignore[no-any-return]

    def force(self, orders: Mapping[str, Number], u: Number, v: Number, r: Number, ship: ShipLike) -> Tau:
        """(X [N], Y [N], N [N m]) in body axes; `orders`: what is recorded of all actuators, `name.attribute`
        in SI; (u, v, r): the ship through the water."""
        if type(orders) is KeptOrders:
            return orders.kept.force(self, orders, u, v, r, ship)
        return self.of_kind(self, orders, u, v, r, ship)

    @cached_property
    def of_kind(self) -> Any:
        """What its kind gives, whatever was given before."""
        return KINDS[self.kind].force

    @cached_property
    def keys(self) -> dict[str, str]:
        """Under which name each attribute is told."""
        return {attribute: f"{self.name}.{attribute}" for attribute in self.attributes}


NUMBERS = {f.name: f for f in fields(Actuator) if f.metadata}
BY_MAKE = ("ahead", "astern", "dead", "D", "K_T0", "pitch_0", "A_R", "U_half")  # as builders tell them
OWN = ("own_gain", "zero", "trim")  # found for each; what else voyages tell of it is its make's

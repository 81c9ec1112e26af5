# ruff: noqa: RUF009  (a number is declared by a call)
"""What is known of one ship in numbers: its particulars, its derivatives and its effects, frozen.

Each number is declared once: unit, the range outside which it is a mistake, meaning, and the width of its
prior."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Self

from twin.num import as_given

from .actuators import Actuator
from .core import Coefficients, coefficients
from .effect import Effect
from .number import number
from .state import Number


@dataclass(frozen=True)
class Derivatives:
    """Hydrodynamic derivatives in prime form (see core.py); the defaults are those of a full, single-screw
    hull.

    `sd` in the metadata is the width of the prior: how far a published regression is usually off.
    """

    X_udot: Number = number(-0.022, "-", -0.2, 0.0, "added mass, surge", sd=0.01)
    Y_vdot: Number = number(-0.223, "-", -0.8, 0.0, "added mass, sway", sd=0.04)
    Y_rdot: Number = number(0.0, "-", -0.1, 0.1, "added mass, sway from yaw", sd=0.01)
    N_vdot: Number = number(0.0, "-", -0.1, 0.1, "added moment, yaw from sway", sd=0.01)
    N_rdot: Number = number(-0.011, "-", -0.1, 0.0, "added moment of inertia, yaw", sd=0.004)
    X_u: Number = number(
        0.0, "-", -0.05, 0.0, "resistance, linear part (made non-dimensional by sqrt(g L))", sd=0.0003
    )
    X_uu: Number = number(-0.022, "-", -0.4, -0.001, "resistance", sd=0.005)
    X_uuu: Number = number(
        0.0, "-", -1.0, 0.1, "resistance that grows faster: waves (for u = sqrt(g L))", sd=0.05
    )
    X_vv: Number = number(-0.04, "-", -1.0, 1.0, "resistance of drift", sd=0.05)
    X_vr: Number = number(0.0, "-", -1.0, 1.0, "resistance of drift while turning, beyond C(nu)", sd=0.07)
    X_rr: Number = number(0.011, "-", -0.3, 0.3, "resistance of turning", sd=0.02)
    Y_v: Number = number(0.0, "-", -0.3, 0.0, "sway damping, linear at rest (sqrt(g L))", sd=0.002)
    Y_uv: Number = number(-0.315, "-", -2.0, 0.0, "sway damping, lift of the hull", sd=0.08)
    Y_ur: Number = number(0.083, "-", -0.5, 0.6, "side force of turning", sd=0.04)
    Y_vv: Number = number(-0.7, "-", -6.0, 0.5, "sway damping, cross-flow", sd=0.4)
    Y_vr: Number = number(0.0, "-", -3.0, 3.0, "|v| r", sd=0.15)
    Y_rv: Number = number(-0.2, "-", -3.0, 3.0, "|r| v", sd=0.15)
    Y_rr: Number = number(0.02, "-", -1.5, 1.5, "|r| r", sd=0.04)
    N_r: Number = number(0.0, "-", -0.1, 0.0, "yaw damping, linear at rest (sqrt(g L))", sd=0.0005)
    N_uv: Number = number(
        0.0, "-", -0.6, 0.6, "yaw moment of drift, beyond the Munk moment in C(nu)", sd=0.05
    )
    N_ur: Number = number(-0.049, "-", -0.4, 0.1, "yaw damping, lift of the hull", sd=0.015)
    N_vv: Number = number(0.0, "-", -1.0, 1.0, "|v| v", sd=0.06)
    N_vr: Number = number(-0.15, "-", -1.5, 1.5, "|v| r", sd=0.08)
    N_rv: Number = number(0.0, "-", -1.5, 1.5, "|r| v", sd=0.06)
    N_rr: Number = number(-0.03, "-", -0.6, 0.3, "|r| r", sd=0.02)
    K_T0: Number = number(0.32, "-", 0.02, 1.5, "thrust coefficient at J = 0", sd=0.04)
    K_T1: Number = number(-0.32, "-", -1.5, 0.0, "slope of the thrust coefficient over J", sd=0.06)
    t: Number = number(0.2, "-", 0.0, 0.5, "thrust deduction fraction")
    w: Number = number(0.35, "-", 0.0, 0.6, "wake fraction at the propeller")
    epsilon: Number = number(1.05, "-", 0.4, 2.5, "rudder inflow over propeller inflow", sd=0.1)
    kappa: Number = number(
        0.5, "-", 0.0, 1.5, "share of the slipstream's gain that the rudder feels", sd=0.15
    )
    C_L: Number = number(
        2.6, "-", 0.5, 10.0, "slope of the rudder's normal force [1/rad], on the area that is known", sd=0.8
    )
    t_R: Number = number(0.35, "-", -0.5, 0.9, "steering resistance deduction", sd=0.15)
    a_H: Number = number(0.3, "-", -0.2, 1.2, "increase of the side force by the hull", sd=0.1)
    x_R: Number = number(-0.5, "L", -0.65, 0.65, "rudder ahead of midship")
    x_H: Number = number(-0.46, "L", -0.7, 0.5, "where the hull's share of the side force acts", sd=0.1)
    gamma_v: Number = number(0.45, "-", -0.2, 1.5, "how much of the drift reaches the rudder", sd=0.12)
    gamma_r: Number = number(-0.35, "-", -1.2, 0.2, "how much of the turning reaches the rudder", sd=0.1)
    gamma_a: Number = number(
        0.0,
        "-",
        -0.9,
        0.9,
        "how much more of both while the stern drifts to starboard, less to port",
        sd=0.15,
    )


@dataclass(frozen=True)
class ShipNumbers:
    """Everything the model knows of one ship, but how its file is read and written (`ship.Ship`)."""

    name: str
    L_pp: Number = number(None, "m", 0.2, 500.0, "length between perpendiculars")
    B: Number = number(None, "m", 0.05, 90.0, "beam")
    T: Number = number(None, "m", 0.01, 40.0, "mean draught")
    m: Number = number(None, "kg", 0.05, 1e9, "mass (displacement)")
    C_b: Number = number(None, "-", 0.05, 1.0, "block coefficient")
    x_G: Number = number(0.0, "m", -60.0, 60.0, "centre of gravity ahead of midship")
    I_z: Number = number(None, "kg m2", 1e-4, 1e14, "moment of inertia in yaw about midship")
    rho: Number = number(1025.0, "kg/m3", 900.0, 1100.0, "density of the water")
    U_0: Number = number(None, "m/s", 0.05, 40.0, "service speed")
    D_P: Number = number(None, "m", 0.005, 15.0, "propeller diameter")
    A_R: Number = number(None, "m2", 1e-5, 250.0, "rudder area (moveable)")
    A_F: Number = number(None, "m2", 1e-4, 5000.0, "frontal area above the water")
    A_L: Number = number(None, "m2", 1e-4, 20000.0, "lateral area above the water")
    derivatives: Derivatives = field(default_factory=Derivatives, kw_only=True)
    effects: tuple[Effect, ...] = field(default=(), kw_only=True)
    # what drives and steers the ship; none: one propeller with a rudder behind it (D_P, A_R)
    actuators: tuple[Actuator, ...] = field(default=(), kw_only=True)
    # sources, sd, structural, history ...
    notes: Mapping[str, Any] = field(default_factory=dict, kw_only=True, compare=False)

    def __repr__(self) -> str:
        """One line: name, length, effects, and whether it is calibrated."""
        effects = ", ".join(type(e).__name__ for e in self.effects) or "no effects"
        calibrated = "calibrated" if "structural" in self.notes else "not calibrated"
        return f"<Ship {self.name!r}: {as_given(self.L_pp)} m, {effects}, {calibrated}>"

    @cached_property
    def c(self) -> Coefficients:
        """The ship's derivatives with their units."""
        return coefficients(self)

    def scale(self, of: str) -> Number:
        """The ship's own size of a quantity: 'force' is 1 % of 1/2 rho L T U_0^2, about half of its
        resistance.

        'moment' = force L, 'speed' = U_0, 'length' = L, 'time' = L/U_0.
        """
        force = 0.005 * self.rho * self.L_pp * self.T * self.U_0**2
        return {
            "force": force,
            "moment": force * self.L_pp,
            "speed": self.U_0,
            "length": self.L_pp,
            "time": self.L_pp / self.U_0,
        }[of]

    def actuator(self, name: str) -> Actuator:
        """The actuator of that name; KeyError when the ship has none."""
        for a in self.actuators:
            if a.name == name:
                return a
        raise KeyError(name)

    def derivative(self, name: str) -> Number:
        """A number that voyages can tell: a derivative, or that of an actuator (`port.gain`)."""
        owner, dot, own = name.rpartition(".")
        return getattr(self.actuator(owner), own) if dot else getattr(self.derivatives, name)

    def has(self, name: str) -> bool:
        """Whether there is a derivative, or a number of an actuator, of that name."""
        owner, dot, own = name.rpartition(".")
        if not dot:
            return hasattr(self.derivatives, name)
        return any(a.name == owner and getattr(a, own, None) is not None for a in self.actuators)

    def with_derivatives(self, **values: Number) -> Self:
        """The ship with some of these numbers changed (see `derivative`)."""
        own = {k: v for k, v in values.items() if "." in k}
        if not own:
            return replace(self, derivatives=replace(self.derivatives, **values))
        parts = []
        for a in self.actuators:
            mine = {k.partition(".")[2]: v for k, v in own.items() if k.partition(".")[0] == a.name}
            parts.append(a.but(**mine) if mine else a)
        plain = {k: v for k, v in values.items() if k not in own}
        return replace(self, actuators=tuple(parts), derivatives=replace(self.derivatives, **plain))

    def with_effects(self, *effects: Effect) -> Self:
        """The ship with these effects added; one of the same name is replaced."""
        names = {type(e) for e in effects}
        return replace(self, effects=(*(e for e in self.effects if type(e) not in names), *effects))

    def without_effects(self, *names: str) -> Self:
        """The same without the effects of these names."""
        return replace(self, effects=tuple(e for e in self.effects if type(e).__name__ not in names))


PARTICULARS = tuple(f for f in fields(ShipNumbers) if f.metadata)
DERIVATIVES = fields(Derivatives)
# without actuators of its own a ship has one propeller and one rudder, and these are theirs
ONE_SCREW = ("D_P", "A_R")

"""A ship's model: core + effects + residual -> nu_dot, and the one integrator."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from . import core
from .effect import Effect, Flow, Lag, SensorFault
from .effect import Force as ForceEffect
from .maths import cos, sin
from .ship import Ship
from .state import Force, Number, Rates, Situation, Water

Eta_nu = tuple[Number, Number, Number, Number, Number, Number]


@dataclass(frozen=True)
class Model:
    """What is known of a ship's motion; `residual`, if any, adds what was learned, and is kept apart.

    `effects` are those of the ship; those whose inputs a situation lacks must be left out (see `without_inputs`).
    """

    ship: Ship
    effects: tuple[Effect, ...] = ()
    residual: Callable[[Situation], Force] | None = None
    flows: tuple[Flow, ...] = field(init=False, repr=False)
    pushes: tuple[ForceEffect, ...] = field(init=False, repr=False)
    faults: tuple[SensorFault, ...] = field(init=False, repr=False)
    lags: tuple[Lag, ...] = field(init=False, repr=False)
    loaded: Ship = field(init=False, repr=False)
    c: core.Coefficients = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for name, kind in (("flows", Flow), ("pushes", ForceEffect), ("faults", SensorFault), ("lags", Lag)):
            object.__setattr__(self, name, tuple(e for e in self.effects if isinstance(e, kind)))
        ship = self.ship
        for push in self.pushes:
            ship = push.alter(ship)
        object.__setattr__(self, "loaded", ship)
        object.__setattr__(self, "c", ship.c)

    @classmethod
    def of(cls, ship: Ship) -> "Model":
        """The model a ship file describes."""
        return cls(ship, ship.effects)

    def but(self, *effects: Effect) -> "Model":
        """The same ship with these effects added (one of the same name is replaced)."""
        names = {type(e) for e in effects}
        return replace(self, effects=(*(e for e in self.effects if type(e) not in names), *effects))

    def without_inputs(self, missing: set[str]) -> tuple["Model", tuple[Effect, ...]]:
        """The model without the effects that need an input that is missing, and those effects."""
        off = tuple(e for e in self.effects if missing.intersection(e.needs))
        return (replace(self, effects=tuple(e for e in self.effects if e not in off)), off) if off else (self, ())

    def water(self, s: Situation) -> Water:
        """The water as all flows together make it."""
        total = Water()
        for flow in self.flows:
            total = Water(*(a + b for a, b in zip(total, flow.water(s, self.loaded), strict=True)))
        return total

    def known(self, s: Situation, water: Water | None = None) -> dict[str, Force]:
        """Every known force by its name: hull, Coriolis, propeller, rudder, and each effect. Sets s.u_r and s.v_r."""
        w = self.water(s) if water is None else water
        s.u_r, s.v_r = s.u - w.u, s.v - w.v
        c, u, v, r = self.c, s.u_r, s.v_r, s.r
        thrust = core.thrust(u, s.n, c)
        forces = {
            "hull": core.damping(u * (1.0 + w.k_u), v * (1.0 + w.k_v), r * (1.0 + w.k_r), c),
            "coriolis": core.coriolis(u, v, r, c),
            "propeller": core.propeller(thrust, c),
            "rudder": core.rudder(u, v, r, s.delta, thrust, c),
        }
        for push in self.pushes:
            forces[type(push).__name__] = push.force(s, self.loaded)
        return forces

    def nu_dot(self, s: Situation) -> Rates:
        """d(nu)/dt over ground; sets s.u_r and s.v_r."""
        w = self.water(s)
        X = Y = N = 0.0
        for f in self.known(s, w).values():
            X, Y, N = X + f.X, Y + f.Y, N + f.N
        if self.residual is not None:
            f = self.residual(s)
            X, Y, N = X + f.X, Y + f.Y, N + f.N
        u_dot, v_dot, r_dot = core.accelerations(Force(X, Y, N), self.c)
        return Rates(u_dot + s.r * w.v, v_dot - s.r * w.u, r_dot)  # the ship turns in a current that does not

    def derivative(self, state: Eta_nu, s: Situation) -> Eta_nu:
        """d/dt of (x, y, psi, u, v, r), with the inputs and weather of s."""
        s.x, s.y, s.psi, s.u, s.v, s.r = state
        rates = self.nu_dot(s)
        c, si = cos(s.psi), sin(s.psi)
        return (s.u * c - s.v * si, s.u * si + s.v * c, s.r, *rates)

    def step(self, state: Eta_nu, s: Situation, h: Number) -> Eta_nu:
        """h seconds on by the classical Runge-Kutta method, inputs held."""
        k1 = self.derivative(state, s)
        k2 = self.derivative(_along(state, k1, 0.5 * h), s)
        k3 = self.derivative(_along(state, k2, 0.5 * h), s)
        k4 = self.derivative(_along(state, k3, h), s)
        w = h / 6.0
        return tuple(  # type: ignore[return-value]
            x + w * (a + 2.0 * (b + c) + d) for x, a, b, c, d in zip(state, k1, k2, k3, k4, strict=True)
        )


def _along(state: Eta_nu, slope: Eta_nu, h: Number) -> Eta_nu:
    return tuple(x + h * k for x, k in zip(state, slope, strict=True))  # type: ignore[return-value]

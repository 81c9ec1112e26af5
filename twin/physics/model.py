"""A ship's model: core + effects + residual -> nu_dot, and the one integrator."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from . import core
from .effect import Effect, Flow, Lag, SensorFault
from .effect import Force as ForceEffect
from .maths import cos, sin, total
from .ship import Ship
from .state import STILL_WATER, Force, Number, Rates, Situation, Water

# of a ship with actuators of its own, propeller and rudder give nothing, and the actuators follow
CORE = ("hull", "coriolis", "propeller", "rudder")
NONE: core.Tau = (0.0, 0.0, 0.0)
Eta_nu = tuple[Number, Number, Number, Number, Number, Number]


@dataclass(frozen=True)
class Model:
    """What is known of a ship's motion; `residual`, if any, adds what was learned, and is kept apart.

    `effects` are those of the ship; those whose inputs a situation lacks must be left out (see
    `without_inputs`)."""

    ship: Ship
    effects: tuple[Effect, ...] = ()
    residual: Callable[[Situation], Force] | None = None
    flows: tuple[Flow, ...] = field(init=False, repr=False)
    pushes: tuple[ForceEffect, ...] = field(init=False, repr=False)
    faults: tuple[SensorFault, ...] = field(init=False, repr=False)
    lags: tuple[Lag, ...] = field(init=False, repr=False)
    loaded: Ship = field(init=False, repr=False)
    c: core.Coefficients = field(init=False, repr=False)
    names: tuple[str, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for name, kind in (("flows", Flow), ("pushes", ForceEffect), ("faults", SensorFault), ("lags", Lag)):
            object.__setattr__(self, name, tuple(e for e in self.effects if isinstance(e, kind)))
        # whatever order they were put in: an antenna's place before its receiver is late, and what is turned
        # by the compass last
        object.__setattr__(
            self, "faults", tuple(sorted(self.faults, key=lambda f: (f.attitude, type(f).__name__)))
        )
        ship = self.ship
        for push in self.pushes:
            ship = push.alter(ship)
        object.__setattr__(self, "loaded", ship)
        object.__setattr__(self, "c", ship.c)
        parts = tuple(a.name for a in ship.actuators)
        object.__setattr__(self, "names", (*CORE, *parts, *(type(push).__name__ for push in self.pushes)))

    @classmethod
    def of(cls, ship: Ship) -> "Model":
        """The model a ship file describes."""
        return cls(ship, ship.effects)

    def but(self, *effects: Effect) -> "Model":
        """The same ship with these effects added (one of the same name is replaced)."""
        names = {type(e) for e in effects}
        return replace(self, effects=(*(e for e in self.effects if type(e) not in names), *effects))

    def prompt(self) -> tuple[float, "Model"]:
        """How late place and speed over ground are shown in all [s], and the same model without that."""
        late = [fault.prompt() for fault in self.faults]
        late_s = float(total(seconds for seconds, _ in late))
        return late_s, self.but(*(fault for _, fault in late)) if late_s else self

    def without_inputs(self, missing: set[str]) -> tuple["Model", tuple[Effect, ...]]:
        """The model without the effects that need an input that is missing, and those effects."""
        off = tuple(e for e in self.effects if missing.intersection(e.needs))
        return (
            (replace(self, effects=tuple(e for e in self.effects if e not in off)), off)
            if off
            else (self, ())
        )

    def water(self, s: Situation) -> Water:
        """The water as all flows together make it."""
        total = STILL_WATER
        for flow in self.flows:
            water = flow.water(s, self.loaded)
            total = (
                water if total is STILL_WATER else Water(*[a + b for a, b in zip(total, water, strict=True)])
            )
        return total

    def forces(self, s: Situation, w: Water) -> list[core.Tau]:
        """Every known force, in the order of `names`. Sets s.u_r, s.v_r, s.k_m and s.k_j."""
        s.u_r, s.v_r = u, v = s.u - w.u, s.v - w.v
        s.k_m, s.k_j = w.k_m, w.k_j
        c, r, ship = self.c, s.r, self.loaded
        thrust = core.thrust(u, s.n, c)
        X, Y, N = core.damping(u, v, r, c)
        turning = core.coriolis(u, v, r, c)
        munk = turning[2] + c.mx_G * u * r
        if ship.actuators:
            return [
                (X * (1.0 + w.k_u), Y * (1.0 + w.k_v), N + w.k_r * (N + munk)),
                turning,
                NONE,
                NONE,
                *[a.force(s.orders, u, v, r, ship) for a in ship.actuators],  # type: ignore[arg-type]
                *[push.force(s, ship) for push in self.pushes],
            ]
        return [
            (X * (1.0 + w.k_u), Y * (1.0 + w.k_v), N + w.k_r * (N + munk)),
            turning,
            core.propeller(thrust * (1.0 - w.k_t), c),
            core.rudder(u, v, r, s.delta, thrust, c),
            *[push.force(s, ship) for push in self.pushes],
        ]

    def known(self, s: Situation, water: Water | None = None) -> dict[str, Force]:
        """Every known force by its name: hull, Coriolis, propeller, rudder, and each effect. Sets s.u_r and
        s.v_r."""
        forces = self.forces(s, self.water(s) if water is None else water)
        return {name: Force(*f) for name, f in zip(self.names, forces, strict=True)}

    def nu_dot(self, s: Situation) -> Rates:
        """d(nu)/dt over ground; sets s.u_r and s.v_r."""
        w = self.water(s)
        forces = self.forces(s, w)
        if self.residual is not None:
            forces.append(self.residual(s))
        X = Y = N = 0.0
        for x, y, n in forces:
            X, Y, N = X + x, Y + y, N + n
        u_dot, v_dot, r_dot = core.accelerations(X, Y, N, self.c, (w.k_m, w.k_j))
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
            [x + w * (a + 2.0 * (b + c) + d) for x, a, b, c, d in zip(state, k1, k2, k3, k4, strict=True)]
        )


def _along(state: Eta_nu, slope: Eta_nu, h: Number) -> Eta_nu:
    return tuple([x + h * k for x, k in zip(state, slope, strict=True)])  # type: ignore[return-value]

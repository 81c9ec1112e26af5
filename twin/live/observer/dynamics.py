"""What is known of the ship, kept true to the moment: its model with the current as it is now, the rudder
where it is now, and without those effects whose inputs nobody measures.

    nu_dot = M^-1 (sum of the known forces + the learned one) + r x nu_c
"""

from collections.abc import Sequence

from twin.live.observer.controls import at_rest, controls_of, nearest_turn, with_measured_controls
from twin.live.observer.estimate import Estimate
from twin.live.observer.steering import Gear, Steering, gears_of
from twin.live.signals.measured import Measured
from twin.physics import core
from twin.physics.effect import Effect, Flow
from twin.physics.maths import cos, sin, total
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import LIGHT, WEATHER, Force, Growth, Number, Rates, Situation, Water

__all__ = ["INPUTS", "Dynamics", "Forces", "Gear", "KnownDynamics", "Steering", "first_current"]

Forces = Sequence[core.Tau]
NONE = Force(0.0, 0.0, 0.0)
CONTROLS = ("delta", "n")
INPUTS = (*CONTROLS, *WEATHER)


class KnownDynamics:
    """The known physics of one moment: a model and the current; the predictor carries it ahead while the
    loop goes on."""

    def __init__(self, model: Model, current: tuple[Number, Number] = (0.0, 0.0)):
        self.model, self.current = model, current

    def water(self, s: Situation) -> Water:
        """The flows of the ship's effects and the current that the twin follows."""
        c, si = cos(s.psi), sin(s.psi)
        north, east = self.current
        u, v = north * c + east * si, east * c - north * si
        if not self.model.flows:
            return Water(u, v)
        w = self.model.water(s)
        return w._replace(u=w.u + u, v=w.v + v)

    def forces(self, s: Situation) -> Forces:
        """Every known force, in the order of `names`. Sets the speeds through water of s."""
        return self.model.forces(s, self.water(s))

    @property
    def names(self) -> tuple[str, ...]:
        """What the forces are called: hull, coriolis, propeller, rudder, and each effect."""
        return self.model.names

    def rates(self, s: Situation, learned: Force) -> Rates:
        """d(nu)/dt over ground; sets the speeds through water of s."""
        return self.rates_of(s, self.forces(s), learned)

    def rates_of(self, s: Situation, forces: Forces, learned: Force = NONE) -> Rates:
        """The same by known forces that were worked out before."""
        X, Y, N = learned
        for x, y, n in forces:
            X, Y, N = X + x, Y + y, N + n
        u_dot, v_dot, r_dot = core.accelerations(X, Y, N, self.model.c, s.grown)
        r = s.r
        return Rates(u_dot + r * (s.v - s.v_r), v_dot - r * (s.u - s.u_r), r_dot)

    def mean_rates(self, s: Situation, forces: Forces, learned: Force, h: float) -> Rates:
        """What takes nu over the next h seconds: a Runge-Kutta step of second order (midpoint), learned
        force and inputs held."""
        start = s.psi, s.u, s.v, s.r
        _along(s, start, s.r, self.rates_of(s, forces, learned), 0.5 * h)
        middle = self.rates(s, learned)
        s.psi, s.u, s.v, s.r = start
        return middle

    def far_rates(self, s: Situation, forces: Forces, learned: Force, h: float) -> Rates:
        """The same for long steps: the mean slope of a Runge-Kutta step of fourth order."""
        start = s.psi, s.u, s.v, s.r
        half = 0.5 * h
        k1 = self.rates_of(s, forces, learned)
        _along(s, start, start[3], k1, half)
        k2 = self.rates(s, learned)
        _along(s, start, start[3] + half * k1[2], k2, half)
        k3 = self.rates(s, learned)
        _along(s, start, start[3] + half * k2[2], k3, h)
        k4 = self.rates(s, learned)
        s.psi, s.u, s.v, s.r = start
        return Rates(
            (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0]) / 6.0,
            (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1]) / 6.0,
            (k1[2] + 2.0 * (k2[2] + k3[2]) + k4[2]) / 6.0,
        )

    def force_for(self, u_dot: Number, v_dot: Number, r_dot: Number, grown: Growth = LIGHT) -> Force:
        """The force that an acceleration takes, where its added mass has `grown`."""
        return Force(*core.force_for(u_dot, v_dot, r_dot, self.model.c, grown))


def _streams(ship: Ship) -> list[Flow]:
    """Its currents: the observer's filter follows all of them together."""
    return [e for e in ship.effects if isinstance(e, Flow) and e.stream]


def first_current(ship: Ship) -> tuple[float, float]:
    """The current that the ship file knows, towards north and east [m/s]."""
    north, east = (float(total(getattr(e, axis, 0.0) for e in _streams(ship))) for axis in ("north", "east"))
    return north, east


class Dynamics:
    """Which physics holds now: `now` is rebuilt by `situation` from what is measured."""

    def __init__(self, ship: Ship):
        streams = _streams(ship)
        self.first_current = first_current(ship)
        self.ship = ship
        self.full = Model(ship, tuple(e for e in ship.effects if e not in streams))
        self.off: tuple[Effect, ...] = ()  # effects without their inputs
        self.held: dict[str, float] = {}  # controls whose feedback is lost, at their last value [SI]
        self._names = controls_of(ship)
        self._controls: dict[str, float] = {}  # the last that was measured of each
        self.now = KnownDynamics(self.full, self.first_current)
        self._needed = sorted({need for e in self.full.effects for need in e.needs if need in WEATHER})
        self._models: dict[tuple[str, ...], tuple[Model, tuple[Effect, ...]]] = {}
        self._adopted: Sequence[Effect] = ship.effects
        self._rest = at_rest(ship)  # of actuators of which nothing was measured yet
        self._steering = gears_of(self.full.lags, self._rest)

    def adopt(self, effects: Sequence[Effect]) -> None:
        """The ship's effects with the numbers that act from now on (twin/live/learning/effect_numbers.py)."""
        if effects is not self._adopted:
            self._adopted, new = effects, {type(e): e for e in effects}
            self.full = Model(self.ship, tuple([new[type(e)] for e in self.full.effects]))
            self._models.clear()

    def known(self, e: Estimate, measured: Measured) -> tuple[Situation, KnownDynamics, Forces]:
        """The ship's situation, the physics that holds in it, and every known force."""
        s = self.situation(e, measured)
        return s, self.now, self.now.forces(s)

    def steering(self) -> Steering | None:
        """The gear as it is now, to be carried ahead; None when all is where it was ordered."""
        return self._steering.copy() if self._steering.late else None

    def ahead(self, s: Situation, forces: Forces, learned: Force, h: float) -> Rates:
        """What takes nu over the next h seconds."""
        return self.now.mean_rates(s, forces, learned, h)

    def situation(self, e: Estimate, measured: Measured) -> Situation:
        """The ship's state as estimated, with controls and weather as measured. Of a rudder, shaft or
        actuator whose feedback is lost the last value holds (see `held`), what gives nothing where there
        never was one."""
        si = measured.si
        self._hold(si)
        s = Situation(e.x, e.y, e.psi, e.u, e.v, e.r, t=measured.now_s)
        for name in INPUTS:
            if name in si:
                setattr(s, name, si[name])
        if self._rest:
            s.orders = self._rest
            with_measured_controls(s, self._controls)
        else:
            for name, value in self.held.items():
                setattr(s, name, value)
        self._steering.take(s.orders or {"delta": s.delta})
        self._steering.follow(s)
        missing = tuple([need for need in self._needed if need not in si])
        if missing not in self._models:
            self._models[missing] = self.full.without_inputs(set(missing))
        model, self.off = self._models[missing]
        self.now = KnownDynamics(model, (e.current_north, e.current_east))
        return s

    def _hold(self, si: dict[str, float]) -> None:
        """A lost feedback does not stop engine, rudder or actuator."""
        for name, channel in self._names.items():
            if name in si:
                before = self._controls.get(name, si[name])
                self._controls[name] = nearest_turn(channel, si[name], before)
                self.held.pop(name, None)
            elif name in self._controls:
                self.held[name] = self._controls[name]


def _along(s: Situation, start: tuple[Number, ...], r: Number, k: Rates, h: float) -> None:
    """Puts s where it is h seconds after the start at rates k, turning with r meanwhile."""
    psi0, u0, v0, r0 = start
    s.psi, s.u, s.v, s.r = psi0 + h * r, u0 + h * k[0], v0 + h * k[1], r0 + h * k[2]

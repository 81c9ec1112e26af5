"""What is known of the ship, kept true to the moment: her model with the current as it is now, the rudder where it is now,
and without those effects whose inputs nobody measures.

    nu_dot = M^-1 (sum of the known forces + the learned one) + r x nu_c
"""

from collections import deque
from dataclasses import replace

from twin.live.estimate import Estimate
from twin.live.sensors import Measured
from twin.physics import core
from twin.physics.effect import Effect, Lag
from twin.physics.effects.current import Current
from twin.physics.maths import cos, sin
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import WEATHER, Force, Number, Rates, Situation, Water

INPUTS = ("delta", "n", *WEATHER)


class Known:
    """The known physics of one moment: a model and the current; the predictor carries it ahead while the loop goes on."""

    def __init__(self, model: Model, current: tuple[Number, Number] = (0.0, 0.0)):
        self.model, self.current = model, current

    def water(self, s: Situation) -> Water:
        """The flows of the ship's effects and the current that the twin follows."""
        w = self.model.water(s)
        c, si = cos(s.psi), sin(s.psi)
        north, east = self.current
        return Water(w.u + north * c + east * si, w.v + east * c - north * si, w.k_u, w.k_v, w.k_r)

    def force(self, s: Situation) -> dict[str, Force]:
        """Every known force by its name, the core first. Sets the speeds through water of s."""
        return self.model.known(s, self.water(s))

    def rates(self, s: Situation, learned: Force) -> Rates:
        """d(nu)/dt over ground; sets the speeds through water of s."""
        w = self.water(s)
        X, Y, N = learned
        for x, y, n in self.model.forces(s, w):
            X, Y, N = X + x, Y + y, N + n
        u_dot, v_dot, r_dot = core.accelerations(X, Y, N, self.model.c)
        return Rates(u_dot + s.r * w.v, v_dot - s.r * w.u, r_dot)

    def rates_of(self, s: Situation, forces: dict[str, Force]) -> Rates:
        """The same by forces that were worked out before, the learned one left out."""
        X = Y = N = 0.0
        for x, y, n in forces.values():
            X, Y, N = X + x, Y + y, N + n
        u_dot, v_dot, r_dot = core.accelerations(X, Y, N, self.model.c)
        return Rates(u_dot + s.r * (s.v - s.v_r), v_dot - s.r * (s.u - s.u_r), r_dot)

    def mean_rates(self, s: Situation, learned: Force, h: float) -> Rates:
        """What takes nu over the next h seconds: the mean slope of one Runge-Kutta step, learned force and inputs held."""
        k1 = self.rates(s, learned)
        k2 = self.rates(_along(s, k1, s.r, 0.5 * h), learned)
        k3 = self.rates(_along(s, k2, s.r + 0.5 * h * k1.r, 0.5 * h), learned)
        k4 = self.rates(_along(s, k3, s.r + 0.5 * h * k2.r, h), learned)
        return Rates(*[(a + 2.0 * (b + c) + d) / 6.0 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)])

    def force_for(self, u_dot: Number, v_dot: Number, r_dot: Number) -> Force:
        """M times an acceleration: the force it takes."""
        c = self.model.c
        return Force(c.m_u * u_dot, c.m_v * v_dot + c.m_vr * r_dot, c.m_rv * v_dot + c.m_r * r_dot)


class Dynamics:
    """Which physics holds now: `now` is rebuilt by `situation` from what is measured."""

    def __init__(self, ship: Ship):
        steady = next((e for e in ship.effects if type(e) is Current), None)
        self.first_current = (steady.north, steady.east) if steady else (0.0, 0.0)
        self.ship = ship
        self.full = Model(ship, tuple(e for e in ship.effects if e is not steady))
        self.off: tuple[Effect, ...] = ()  # effects without their inputs
        self.now = Known(self.full, self.first_current)
        self._needed = sorted({need for e in self.full.effects for need in e.needs if need in WEATHER})
        self._models: dict[tuple[str, ...], tuple[Model, tuple[Effect, ...]]] = {}
        self._gears = [Gear(lag) for lag in self.full.lags]

    def situation(self, e: Estimate, measured: Measured) -> Situation:
        """The ship's state as estimated, with controls and weather as measured (rudder and shaft 0 when nobody says)."""
        si = measured.si
        s = Situation(e.x, e.y, e.psi, e.u, e.v, e.r, t=measured.now_s)
        for name in INPUTS:
            if name in si:
                setattr(s, name, si[name])
        for gear in self._gears:
            s.delta = gear.turn(s.delta, measured.now_s)
        missing = tuple([need for need in self._needed if need not in si])
        if missing not in self._models:
            self._models[missing] = self.full.without_inputs(set(missing))
        model, self.off = self._models[missing]
        self.now = Known(model, (e.current_north, e.current_east))
        return s


def _along(s: Situation, k: Rates, r: Number, h: float) -> Situation:
    """The situation h seconds on at these rates (place held: the water does not change over a ship's step)."""
    return replace(s, psi=s.psi + h * r, u=s.u + h * k.u, v=s.v + h * k.v, r=s.r + h * k.r)


class Gear:
    """A rudder that answers late: where it is, given what was ordered."""

    def __init__(self, lag: Lag):
        self.lag = lag
        self.actual: float | None = None
        self._orders: deque[tuple[float, float]] = deque(maxlen=1024)
        self._t = 0.0

    def turn(self, order: float, now_s: float) -> float:
        """Where the rudder is now [rad]."""
        dt, self._t = now_s - self._t, now_s
        self._orders.append((now_s, order))
        due = now_s - self.lag.dead_time()
        while len(self._orders) > 1 and self._orders[1][0] <= due:
            self._orders.popleft()
        if self.actual is None or not 0.0 <= dt < 5.0:
            self.actual = order
        self.actual = float(self.lag.step(self.actual, self._orders[0][1], dt))
        return self.actual

"""The observer: the ship's model runs along, and every measurement pulls it a little, with gain K.

    nu_hat+  = nu_hat + h nu_dot(model) + h K (nu - nu_hat)         (compared at the time nu was measured)
    eta_hat+ = eta_hat + h R(psi_hat) nu_hat + h K (eta - eta_hat)

K = 12 U_0/L unless settings or certificate say otherwise (0.3 1/s for a 320 m ship), less for a sensor too
    slow or too
late for that. A sample pulls until the next one is due; what comes late is compared with the corrected
estimate of its time, so that no pull is answered twice. What is not measured is predicted, and its
uncertainty grows."""

from collections import deque
from dataclasses import dataclass
from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING

from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship
from twin.physics.state import Force, Rates, Situation

if TYPE_CHECKING:
    from twin.live.observer.dynamics import KnownDynamics

STATES = ("x", "y", "psi", "u", "v", "r")
WATER = {"u": "u_r", "v": "v_r"}  # what stands in for a speed over ground
A_MAX = 0.5  # no sample pulls more than half way in one tick
HELD = 1.2  # of its usual interval a sample pulls until the next one comes
DELAYED = 0.6  # K times (delay + time that a sample pulls): above about 1 an observer swings
OUTLIER = 4.0  # usual deviations beyond which a sample pulls no more
MAX_GAP_S = 3.0  # the model is not carried over a longer pause of the machine
HISTORY = 256  # ticks remembered, to compare a late sample with its own time


@dataclass(slots=True)
class Estimate:
    """Where the ship is and how it moves [SI], `sigma` of each, and the current towards north and east
    [m/s]."""

    x: float = 0.0
    y: float = 0.0
    psi: float = 0.0
    u: float = 0.0
    v: float = 0.0
    r: float = 0.0
    sigma: tuple[float, ...] = (0.0,) * 6
    current_north: float = 0.0
    current_east: float = 0.0
    ready: bool = False

    def velocity_ned(self) -> tuple[float, float]:
        c, s = cos(self.psi), sin(self.psi)
        return self.u * c - self.v * s, self.u * s + self.v * c

    def current_body(self) -> tuple[float, float]:
        c, s = cos(self.psi), sin(self.psi)
        return self.current_north * c + self.current_east * s, self.current_east * c - self.current_north * s

    def state(self) -> tuple[float, ...]:
        return self.x, self.y, self.psi, self.u, self.v, self.r


class Observer:
    """Measured in, Estimate out; `steer(rates)` says how the model moves until the next tick."""

    def __init__(self, ship: Ship, gain: float = 0.0, current: tuple[float, float] = (0.0, 0.0)):
        self.gain = gain or gain_for(ship)
        self.estimate = Estimate(current_north=current[0], current_east=current[1])
        # measured less estimated of its time, by state, as corrected so far
        self.innovation: dict[str, float] = {}
        # which pulled in this tick, unclipped and by the whole of K
        self.received: dict[str, bool] = dict.fromkeys(STATES, False)
        # by how much each was pulled in this tick, received or not
        self.pulled: dict[str, float] = dict.fromkeys(STATES, 0.0)
        self.restarts = 0
        self.sigma = Sigma(ship)
        self.rates = Rates(0.0, 0.0, 0.0)
        self._now_s: float | None = None
        speed, turning = 4.0 * ship.U_0 + 5.0, 8.0 * ship.U_0 / ship.L_pp
        self.most = speed, speed, turning  # no ship moves faster, whatever its instruments and its model say
        self._past: deque[tuple[float, tuple[float, ...]]] = deque(maxlen=HISTORY)
        self._current = CurrentFilter(ship, *current)

    def steer(self, rates: Rates) -> None:
        """The model's accelerations from now on."""
        self.rates = rates

    def remember(self, physics: "KnownDynamics", s: Situation, learned: Force) -> None:
        """What drives the model until the next tick, for an observer that goes back to it (`RollBack`)."""

    def correct(self, measured: Measured) -> Estimate:
        """The model carried to now, then pulled by what is measured."""
        now_s = measured.now_s
        dt, self._now_s = now_s - (self._now_s if self._now_s is not None else now_s), now_s
        e = self.estimate
        if not e.ready or not 0.0 <= dt <= MAX_GAP_S:
            self._begin(measured)
            return e
        self._move(dt)
        self._past.append((now_s, e.state()))
        self._compare(measured)
        for state in STATES:
            self._pull(state, dt, measured)
        e.psi %= 2.0 * pi
        self._past[-1] = (now_s, e.state())
        e.sigma = self.sigma.all()
        e.current_north, e.current_east = self._current.feed(measured, e)
        return e

    def _begin(self, measured: Measured) -> None:
        """Start, or start again after a pause: from what is measured now, as soon as heading and speed or
        place are."""
        si, e = measured.si, self.estimate
        self.restarts += e.ready
        self.innovation.clear()
        self.received, self.pulled = dict.fromkeys(STATES, False), dict.fromkeys(STATES, 0.0)
        if "psi" not in si or not ("u" in si or "u_r" in si or "x" in si):
            e.ready = False
            return
        drift = e.current_body()
        speeds = {"u": si.get("u_r", 0.0) + drift[0], "v": si.get("v_r", 0.0) + drift[1], "r": 0.0}
        start = {"x": e.x, "y": e.y} | speeds | {s: si[s] for s in STATES if s in si}
        for state in STATES:
            setattr(e, state, start[state])
        self.sigma.begin(si)
        self._past.clear()
        self._past.append((measured.now_s, e.state()))
        self.rates = Rates(0.0, 0.0, 0.0)
        e.sigma, e.ready = self.sigma.all(), True

    def _move(self, dt: float) -> None:
        """Model: nu by the rates of the last tick, eta along the mean of old and new nu."""
        e, rates = self.estimate, self.rates
        speed, _, turning = self.most
        u = min(max(e.u + rates.u * dt, -speed), speed)
        v = min(max(e.v + rates.v * dt, -speed), speed)
        r = min(max(e.r + rates.r * dt, -turning), turning)
        psi = e.psi + 0.25 * (e.r + r) * dt  # heading half way
        c, s, mean_u, mean_v = cos(psi), sin(psi), 0.5 * (e.u + u), 0.5 * (e.v + v)
        e.x += (mean_u * c - mean_v * s) * dt
        e.y += (mean_u * s + mean_v * c) * dt
        e.psi += 0.5 * (e.r + r) * dt
        e.u, e.v, e.r = u, v, r
        self.sigma.grow(dt, abs(u) + abs(v))

    def _compare(self, measured: Measured) -> None:
        """The innovation of what is fresh, at the time it was measured; water speed stands in for a
        missing ground speed."""
        si, fresh = measured.si, measured.fresh
        if not fresh:
            return
        for i, state in enumerate(STATES):
            if state in fresh and state in si:
                if state in measured.steps:
                    self._take_over(i, state, si[state])
                else:
                    self._innovate(i, state, si[state], measured.age_s(state))
            elif state not in si and WATER.get(state) in fresh:
                water = WATER[state]
                drift = self.estimate.current_body()["uv".index(state)]
                self._innovate(i, state, si[water] + drift, measured.age_s(water))

    def _innovate(self, i: int, state: str, value: float, age_s: float) -> None:
        gap = value - self._at(i, age_s)
        self.innovation[state] = turn(gap) if state == "psi" else gap

    def _at(self, i: int, age_s: float) -> float:
        """One number of the estimate, `age_s` seconds ago, on the line between the ticks around it."""
        past = self._past
        after_t, after = past[-1]
        if age_s < 1e-6:
            return after[i]
        want = after_t - age_s
        for k in range(len(past) - 2, -1, -1):
            t, state = past[k]
            if t <= want:
                step = after[i] - state[i]
                return state[i] + (want - t) / (after_t - t) * (turn(step) if i == 2 else step)
            after_t, after = t, state
        return after[i]

    def _take_over(self, i: int, state: str, value: float) -> None:
        """A step that lasted: the estimate jumps, and so does its past."""
        step = value - getattr(self.estimate, state)
        setattr(self.estimate, state, value)
        self._past = deque(((t, (*p[:i], p[i] + step, *p[i + 1 :])) for t, p in self._past), maxlen=HISTORY)
        self.innovation[state] = 0.0
        self.sigma.begin_one(state)

    def _pull(self, state: str, dt: float, measured: Measured) -> None:
        """The last innovation pulls until the next is due; an outlier pulls as much as four usual
        deviations do."""
        gap, si = self.innovation.get(state), measured.si
        source = state if state in si else WATER.get(state, state)
        self.received[state], self.pulled[state] = False, 0.0
        if gap is None or source not in si:
            return
        heard_s, hold_s = measured.heard[source], measured.hold_s[source]
        if measured.now_s - heard_s > hold_s + 1e-9:
            return
        doubt = self.sigma.of[state]
        limit = doubt.limit()
        waits_s = max(hold_s + heard_s - measured.time[source], dt)
        a = min(self.gain * dt, DELAYED * dt / waits_s, A_MAX)
        a *= measured.weights.get(source, 1.0)
        usual = -limit <= gap <= limit
        self.received[state] = usual and a >= self.gain * dt  # the certificate is that of K, not of less
        pull = gap if usual else limit if gap > 0.0 else -limit
        e, self.pulled[state] = self.estimate, a * abs(pull)
        setattr(e, state, getattr(e, state) + a * pull)
        if source in measured.fresh:
            doubt.learn(pull)
            # of its own time the estimate is corrected as well; on the line to the tick before, in part
            if measured.age_s(source) < dt:
                self.innovation[state] = gap - (1.0 - measured.age_s(source) / dt) * a * pull
        doubt.shrink(a)


class Doubt:
    """How sure one state is: `sigma` grows while the model runs alone and shrinks with every sample."""

    __slots__ = ("floor", "sigma", "spread", "usual")

    def __init__(self, usual: float):
        self.usual, self.floor = usual, 0.01 * usual * usual
        self.sigma = 0.0
        self.spread = usual * usual  # mean squared innovation

    def limit(self) -> float:
        """Beyond this an innovation is an outlier."""
        return OUTLIER * sqrt(self.spread + self.sigma * self.sigma)

    def learn(self, gap: float) -> None:
        """What innovations are usual, from one that is within the limit."""
        self.spread += 0.02 * (1.2 * gap * gap + self.floor - self.spread)

    def shrink(self, a: float) -> None:
        """A sample pulled by the share a."""
        kept, noise = (1.0 - a) * self.sigma, max(self.spread - self.sigma * self.sigma, self.floor)
        self.sigma = sqrt(kept * kept + a * a * noise)


class Sigma:
    """The doubt of all states."""

    def __init__(self, ship: Ship):
        speed, rate, push = 0.03 * ship.U_0, 0.05 * ship.U_0 / ship.L_pp, 0.015 * ship.U_0**2 / ship.L_pp
        # an innovation, to begin with
        usual = {"x": 3.0, "y": 3.0, "psi": 0.01, "u": speed, "v": speed, "r": rate}
        self.of = {state: Doubt(usual[state]) for state in STATES}
        # how fast the model alone goes astray in speed and in turning
        self._astray = push, 1.5 * push / ship.L_pp

    def all(self) -> tuple[float, ...]:
        return tuple([doubt.sigma for doubt in self.of.values()])

    def begin(self, measured: dict[str, float]) -> None:
        for state, doubt in self.of.items():
            doubt.sigma = doubt.usual * (1.0 if state in measured else 10.0)

    def begin_one(self, state: str) -> None:
        self.of[state].sigma = self.of[state].usual

    def grow(self, dt: float, speed: float) -> None:
        """The model alone for dt seconds at this speed."""
        x, y, psi, u, v, r = self.of.values()
        moving = (u.sigma + v.sigma + speed * psi.sigma) * dt
        push, twist = self._astray
        x.sigma += moving
        y.sigma += moving
        psi.sigma += r.sigma * dt
        u.sigma += push * dt
        v.sigma += push * dt
        r.sigma += twist * dt


class CurrentFilter:
    """The current over three ship lengths: speed over ground less speed through water, bounded."""

    def __init__(self, ship: Ship, north: float, east: float):
        self.north, self.east = north, east
        self.time_s = 3.0 * ship.L_pp / ship.U_0
        self.bound = min(max(0.6 * ship.U_0, 1.0), 5.0)  # [m/s]

    def feed(self, measured: Measured, e: Estimate) -> tuple[float, float]:
        """Only along those axes of the ship on which both speeds are measured."""
        si, fresh = measured.si, measured.fresh
        if "u_r" not in fresh and "v_r" not in fresh:
            return self.north, self.east
        c, s = cos(e.psi), sin(e.psi)
        for ground, water, axis_north, axis_east in (("u", "u_r", c, s), ("v", "v_r", -s, c)):
            if water in fresh and ground in si:
                a = min(fresh[water] / self.time_s, 0.1)
                gap = si[ground] - si[water] - (self.north * axis_north + self.east * axis_east)
                self.north += a * gap * axis_north
                self.east += a * gap * axis_east
        size = sqrt(self.north * self.north + self.east * self.east)
        if size > self.bound:
            self.north, self.east = self.north * self.bound / size, self.east * self.bound / size
        return self.north, self.east


def gain_for(ship: Ship) -> float:
    """K [1/s] by the ship's own time."""
    return float(12.0 * ship.U_0 / ship.L_pp)


def fastest_gain(h: float, samples: int) -> float:
    """The greatest K [1/s] that acts in full at a period of h seconds, with an instrument heard in each tick
    and as late as that."""
    return min(DELAYED / (HELD + samples), A_MAX) / h

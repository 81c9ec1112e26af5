"""The observer: the ship's model runs along, and every measurement pulls it a little, with gain K.

    nu_hat+  = nu_hat + h nu_dot(model) + h K (nu - nu_hat)         (compared at the time nu was measured)
    eta_hat+ = eta_hat + h R(psi_hat) nu_hat + h K (eta - eta_hat)

K = 12 U_0/L unless settings or certificate say otherwise (0.3 1/s for a 320 m ship), less for a sensor too
    slow or too
late for that. A sample pulls until the next one is due; what comes late is compared with the corrected
estimate of its time, so that no pull is answered twice. What is not measured is predicted, and its
uncertainty grows."""

from collections import deque
from math import cos, pi, sin

from twin.live.observer.dynamics import KnownDynamics
from twin.live.observer.estimate import A_MAX, DELAYED, STATES, CurrentFilter, Estimate, Sigma, gain_for
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship
from twin.physics.state import Force, Rates, Situation

WATER = {"u": "u_r", "v": "v_r"}  # what stands in for a speed over ground
MAX_GAP_S = 3.0  # the model is not carried over a longer pause of the machine
HISTORY = 256  # ticks remembered, to compare a late sample with its own time


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

    def remember(self, physics: KnownDynamics, s: Situation, learned: Force) -> None:
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

"""Where the ship will be in 10, 60 and 120 seconds if helm, engine and weather stay as they are, and how
sure that is.

The model is carried ahead by Runge-Kutta steps of 0.15 L/U_0, a few in each tick, so that no tick is long.
How far predictions were off is learned for each horizon: the 68 % quantile of past errors,  log q += eta
(1[error > q] - 0.32).
"""

from collections import deque
from collections.abc import Callable
from dataclasses import replace
from math import ceil, exp, hypot, log, pi
from typing import NamedTuple

from twin.live.observer.dynamics import Forces, KnownDynamics
from twin.live.observer.estimate import Estimate
from twin.live.observer.observer import MAX_GAP_S
from twin.live.observer.steering import Steering
from twin.live.signals.derive import turn
from twin.physics.maths import cos, sin
from twin.physics.ship import Ship
from twin.physics.state import Force, Situation

MOST_STEPS = 8.0  # in one tick
STEP_LENGTHS = 0.15  # of L/U_0
RAYLEIGH = 1.51  # the 68 % quantile of a distance in the plane, in deviations along one axis
ABSURD_MPS, ABSURD_RADPS = 100.0, 10.0  # faster than any ship: a helm or engine signal that cannot be
LEARNED = 20  # errors seen before the uncertainty counts as learned
LearnedAt = Callable[[Situation, Forces], Force]


class Region(NamedTuple):
    """Where the ship will be with probability `level` (0: no promise) if helm and engine are held: an ellipse
    around the predicted place with half axes along and across the predicted course [m, m, rad], and the
    heading to either side [rad]. `voyages`, `regime`: what that rests on; status: "calibrated", or why not.
    """

    along_m: float
    across_m: float
    heading: float
    course: float
    level: float
    voyages: int
    regime: str
    status: str


class Prediction(NamedTuple):
    """eta and nu `horizon_s` after the tick that says it [SI], one sigma of each, from an estimate `age_s`
    old.

    status: "prior" until past errors have taught the uncertainty, then "learned".
    """

    horizon_s: float
    state: tuple[float, ...]
    sigma: tuple[float, ...]
    age_s: float
    status: str
    region: Region | None = None  # where the ship file has a [tube]


class Predictor:
    """`advance(...)` each tick; gives the predictions when a round is done, [] otherwise."""

    def __init__(
        self,
        ship: Ship,
        horizons_s: tuple[float, ...] = (10.0, 60.0, 120.0),
        refresh_s: float = 2.0,
        rate_hz: float = 10.0,
    ):
        self.horizons_s = tuple(sorted(set(horizons_s)))
        first = self.horizons_s[0]
        self.step_s = first / ceil(first / (STEP_LENGTHS * ship.L_pp / ship.U_0))
        steps = ceil(self.horizons_s[-1] / self.step_s) + len(self.horizons_s) + 1
        # not whole: some ticks have one more than others
        self.steps_a_tick = min(steps / (refresh_s * rate_hz), MOST_STEPS)
        self.lead_s = ceil(steps / self.steps_a_tick) / rate_hz  # what a round says is for when it is done
        self._credit = 0.0
        self.sureness = {h: Sureness(ship, h) for h in self.horizons_s}
        self._round: Round | None = None
        self._last_s = float("-inf")
        self._due: dict[float, deque[tuple[float, tuple[float, ...]]]] = {
            h: deque(maxlen=1024) for h in self.horizons_s
        }

    def advance(
        self,
        now_s: float,
        e: Estimate,
        s: Situation,
        physics: KnownDynamics,
        learned: LearnedAt,
        good: bool,
        steering: Callable[[], Steering | None] = lambda: None,
    ) -> list[Prediction]:
        """Check what fell due, then carry the present round on by a few steps; `steering` gives the gear as a
        new round finds it."""
        paused, self._last_s = not 0.0 <= now_s - self._last_s <= MAX_GAP_S, now_s
        if paused or not (e.ready and good):
            self._forget()
        if not (e.ready and good):
            return []
        self._check(now_s, e)
        if self._round is None:
            self._round = Round(
                now_s,
                e,
                replace(s),
                physics,
                self.step_s,
                [h + self.lead_s for h in self.horizons_s],
                steering(),
            )
        self._credit += self.steps_a_tick
        try:
            done = self._round.run(int(self._credit), learned)
        except Lost:
            self._round = None
            return []
        finally:
            self._credit %= 1.0
        if len(done) < len(self.horizons_s) or now_s < self._round.start_s + self.lead_s - 1e-6:
            return []
        made = self._round
        self._round = None
        return [self._finished(made, h, state, now_s) for h, state in zip(self.horizons_s, done, strict=True)]

    def _forget(self) -> None:
        """What was begun or foretold before is of another estimate."""
        self._round, self._credit = None, 0.0
        for waiting in self._due.values():
            waiting.clear()

    def _finished(
        self, made: "Round", horizon_s: float, state: tuple[float, ...], now_s: float
    ) -> Prediction:
        due_s = made.start_s + self.lead_s + horizon_s
        self._due[horizon_s].append((due_s, state))
        sure = self.sureness[horizon_s]
        return Prediction(
            round(due_s - now_s, 6), state, sure.sigma(made.sigma), now_s - made.start_s, sure.status
        )

    def _check(self, now_s: float, e: Estimate) -> None:
        """Predictions for this moment against the estimate."""
        for horizon_s, waiting in self._due.items():
            while waiting and waiting[0][0] <= now_s:
                due_s, state = waiting.popleft()
                if now_s - due_s < 0.5:
                    self.sureness[horizon_s].feed(state, e.state())


class Lost(Exception):
    """The model ran away: nothing is foretold."""


class Round:
    """One prediction under way, to a few moments ahead of its start."""

    def __init__(
        self,
        start_s: float,
        e: Estimate,
        s: Situation,
        physics: KnownDynamics,
        step_s: float,
        moments_s: list[float],
        steering: Steering | None = None,
    ):
        self.start_s, self.sigma, self.step_s = start_s, e.sigma, step_s
        self._s, self._physics, self._moments_s = s, physics, moments_s
        self._ahead_s, self._steering = 0.0, steering
        self._middle = Middle()
        self._done: list[tuple[float, ...]] = []

    def run(self, steps: int, learned: LearnedAt) -> list[tuple[float, ...]]:
        """A few steps on; the states at the moments reached so far."""
        for _ in range(steps):
            if len(self._done) == len(self._moments_s):
                break
            left_s = self._moments_s[len(self._done)] - self._ahead_s
            step_s = min(self.step_s, left_s)
            carry(self._s, self._physics, learned, step_s, self._middle, self._steering)
            if not (abs(self._s.u) + abs(self._s.v) < ABSURD_MPS and abs(self._s.r) < ABSURD_RADPS):
                raise Lost
            self._ahead_s += step_s
            if left_s - step_s < 1e-9:
                s = self._s
                self._done.append((s.x, s.y, s.psi % (2.0 * pi), s.u, s.v, s.r))
        return self._done


class Middle:
    """The learned force of a step's middle, by a line through its beginning and that of the step before
    (Adams-Bashforth): the network is asked once a step."""

    def __init__(self) -> None:
        self._last: tuple[Force, float] | None = None

    def of(self, force: Force, h: float) -> Force:
        """From the force at the beginning of a step of h seconds."""
        before, length = self._last or (force, h)
        self._last, by = (force, h), 0.5 * h / length
        return Force(*[f + by * (f - b) for f, b in zip(force, before, strict=True)])


def carry(
    s: Situation,
    physics: KnownDynamics,
    learned: LearnedAt,
    h: float,
    middle: Middle,
    steering: Steering | None = None,
) -> None:
    """Puts s h seconds on: nu by one Runge-Kutta step, eta along the mean of old and new nu; learned force
    that of the step's middle, the rudder where a slow gear has it by then."""
    if steering:
        steering.follow(s)
    forces = physics.forces(s)
    rates = physics.far_rates(s, forces, middle.of(learned(s, forces), h), h)
    u, v, r = s.u + h * rates.u, s.v + h * rates.v, s.r + h * rates.r
    psi = s.psi + 0.25 * h * (s.r + r)
    c, si, mean_u, mean_v = cos(psi), sin(psi), 0.5 * (s.u + u), 0.5 * (s.v + v)
    s.x, s.y = s.x + h * (mean_u * c - mean_v * si), s.y + h * (mean_u * si + mean_v * c)
    s.psi, s.u, s.v, s.r, s.t = s.psi + 0.5 * h * (s.r + r), u, v, r, s.t + h


def usual_error(ship: Ship, horizon_s: float) -> tuple[float, ...]:
    """A prior of the error in place [m], heading [rad], u, v [m/s] and r [rad/s] after that time."""
    push = 0.015 * ship.U_0**2 / ship.L_pp
    psi = min(0.75 * push / ship.L_pp * horizon_s**2 + 0.01, 1.0)
    place = 0.5 * push * horizon_s**2 + 0.3 * ship.U_0 * horizon_s * psi + 1.0
    speed = push * horizon_s + 0.01
    return place, psi, speed, speed, 1.5 * push / ship.L_pp * horizon_s + 1e-5


class Sureness:
    """How far predictions of one horizon were off: a 68 % quantile for place, heading, u, v and r."""

    def __init__(self, ship: Ship, horizon_s: float):
        first = usual_error(ship, horizon_s)
        self._log_q = [log(q) for q in first]
        self.seen = 0

    @property
    def status(self) -> str:
        """Whether it is learned by now, or still the prior."""
        return "learned" if self.seen >= LEARNED else "prior"

    def feed(self, predicted: tuple[float, ...], true: tuple[float, ...]) -> None:
        """One prediction and what came."""
        place = hypot(predicted[0] - true[0], predicted[1] - true[1]) / RAYLEIGH
        errors = (
            place,
            abs(turn(predicted[2] - true[2])),
            *(abs(p - t) for p, t in zip(predicted[3:], true[3:], strict=True)),
        )
        self.seen += 1
        eta = max(1.0 / (1.0 + 0.1 * self.seen), 0.1)
        self._log_q = [q + eta * ((e > exp(q)) - 0.32) for q, e in zip(self._log_q, errors, strict=True)]

    def sigma(self, start: tuple[float, ...]) -> tuple[float, ...]:
        """One sigma of (x, y, psi, u, v, r), never below that of the state it started from."""
        place, *rest = [exp(q) for q in self._log_q]
        return tuple([max(q, s) for q, s in zip((place, place, *rest), start, strict=True)])


def ensemble(
    s: Situation, physics: KnownDynamics, learned: LearnedAt, horizon_s: float, step_s: float
) -> Situation:
    """Many ships at once (fields of s may be arrays), `horizon_s` ahead."""
    s, steps, middle = replace(s), ceil(horizon_s / step_s), Middle()
    for _ in range(steps):
        carry(s, physics, learned, horizon_s / steps, middle)
    return s

"""The observer of a ship that is fast for its loop: every sample corrects the estimate of its own time, once,
and the model runs on from there to now in inner steps.

    nu_hat(t_s)+ = nu_hat(t_s) + a (y - nu_hat(t_s)),     then q steps of h/q to now, inputs as they were

A correction at its own time cannot be answered twice, so no swing limits its share a. What was corrected
since is corrected again on the way. `path` says what was done, for the certificate goes the same way.
"""

from collections import deque
from copy import copy
from math import ceil, cos, hypot, pi, sin
from typing import NamedTuple

from twin.live.observer.dynamics import KnownDynamics
from twin.live.observer.estimate import A_MAX, DELAYED, HELD, STATES, Estimate
from twin.live.observer.observer import MAX_GAP_S, WATER, Observer
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship
from twin.physics.state import Force, Rates, Situation

KEPT_S = 1.0  # how far back a sample may correct
FULL_GAIN = 0.8  # share of an error that a sample takes away
PLACE = min(DELAYED * HELD / (1.0 + HELD), A_MAX)  # the same of positions, which no certificate covers
LENGTH = 0.008  # of L/U_0: an inner step, about
FROM = 2.0 * LENGTH  # a longer period asks for inner steps
ROUNDING = 1e-6

State = tuple[float, ...]
Motion = tuple[float, float, float, float]  # (u, v, r) through the water, and the current's speed


def inner_steps(ship: Ship, period_s: float) -> int:
    """Into how many steps a period of the loop is cut for this ship; 1: none, and samples pull as usual."""
    share = period_s * ship.U_0 / ship.L_pp
    return ceil(share / LENGTH - ROUNDING) if share > FROM else 1


class LateSample(NamedTuple):
    """A measurement of one state at its own time; beyond `limit` it pulls no further. `counts`: measured by
    its own instrument."""

    time_s: float
    state: int
    value: float
    limit: float
    share: float
    counts: bool


class Pull(NamedTuple):
    """How a sample acted: in full, or by `moved` only."""

    state: int
    full: bool
    moved: float


class Stretch(NamedTuple):
    """The motion through the water as each inner step to this time began, what was corrected there, and the
    estimate after that."""

    time_s: float
    motions: list[Motion]
    pulls: list[Pull]
    after: State


class Path(NamedTuple):
    """The estimate's way to now: from a moment whose estimate stood, stretch by stretch."""

    start_s: float
    start: State
    stretches: list[Stretch]


class Inputs(NamedTuple):
    """What moves the model from a tick to the next."""

    time_s: float
    physics: KnownDynamics
    situation: Situation
    learned: Force


class RollBack(Observer):
    """As Observer; `remember` says what drives the model until the next tick."""

    def __init__(
        self, ship: Ship, inner_s: float, gain: float = 0.0, current: tuple[float, float] = (0.0, 0.0)
    ):
        """inner_s: the longest inner step [s]."""
        super().__init__(ship, gain, current)
        self.inner_s = inner_s
        self.path = Path(0.0, self.estimate.state(), [])
        self._nodes: deque[tuple[float, State]] = deque()
        self._drives: deque[Inputs] = deque()
        self._samples: list[LateSample] = []  # by time

    def remember(self, physics: KnownDynamics, s: Situation, learned: Force) -> None:
        self._drives.append(Inputs(s.t, physics, copy(s), learned))  # type: ignore[arg-type]

    def correct(self, measured: Measured) -> Estimate:
        """What is fresh corrects its own time, and the model runs on to now."""
        now_s = measured.now_s
        dt, self._now_s = now_s - (self._now_s if self._now_s is not None else now_s), now_s
        e = self.estimate
        if not e.ready or not 0.0 <= dt <= MAX_GAP_S or not self._drives:
            self._begin(measured)
            self._nodes = deque([(now_s, e.state())])
            self._samples.clear()
            self._drives.clear()
            self.path = Path(now_s, e.state(), [])
            return e
        self.sigma.grow(dt, abs(e.u) + abs(e.v))
        self.received, self.pulled = dict.fromkeys(STATES, False), dict.fromkeys(STATES, 0.0)
        self._forget(now_s)
        self._again(now_s, self._heard(measured))
        e.psi %= 2.0 * pi
        e.sigma = self.sigma.all()
        e.current_north, e.current_east = self._current.feed(measured, e)
        return e

    def _forget(self, now_s: float) -> None:
        """What is older than the kept time; of nodes and drives the last before it stays."""
        oldest_s = now_s - KEPT_S
        for kept in (self._nodes, self._drives):
            while len(kept) > 1 and kept[1][0] <= oldest_s:
                kept.popleft()
        self._samples = [s for s in self._samples if s.time_s > self._nodes[0][0]]

    def _heard(self, measured: Measured) -> list[LateSample]:
        """This tick's samples; a step that lasted is taken over by the whole past."""
        si, fresh, heard = measured.si, measured.fresh, []
        for i, state in enumerate(STATES):
            source = state if state in si else WATER.get(state, state)
            if source not in fresh or source not in si:
                continue
            if state in measured.steps:
                self._leap(i, state, si[state])
                continue
            drift = 0.0 if source == state else self.estimate.current_body()["uv".index(state)]
            taken_s = min(max(measured.time[source], self._nodes[0][0]), measured.now_s)
            own, weight = source == state and state not in measured.derived, measured.weights.get(source, 1.0)
            counts = own and taken_s == measured.time[source] and weight == 1.0
            share = weight * (PLACE if i < 2 else FULL_GAIN)
            limit = self.sigma.of[state].limit()
            heard.append(LateSample(taken_s, i, si[source] + drift, limit, share, counts))
        return heard

    def _leap(self, i: int, state: str, value: float) -> None:
        step = value - getattr(self.estimate, state)
        self._nodes = deque((t, (*x[:i], x[i] + step, *x[i + 1 :])) for t, x in self._nodes)
        self._samples = [s for s in self._samples if s.state != i]
        self.innovation[state] = 0.0
        self.sigma.begin_one(state)

    def _again(self, now_s: float, new: list[LateSample]) -> None:
        """From the last estimate that no new sample changes, through every sample since, to now."""
        nodes, back_s = self._nodes, min((s.time_s for s in new), default=now_s)
        while len(nodes) > 1 and nodes[-1][0] > back_s:
            nodes.pop()
        start_s, start = nodes[-1]
        x = start
        due = sorted([s for s in self._samples if s.time_s > start_s] + new)
        self._samples = [s for s in self._samples if s.time_s <= start_s] + due
        fresh, t = set(new), start_s
        stretches: list[Stretch] = []
        while due or t < now_s or not stretches:
            to_s = due[0].time_s if due else now_s
            x, motions = self._run(x, t, to_s)
            pulls = []
            while due and due[0].time_s == to_s:
                sample = due.pop(0)
                x, pull = self._pulled(x, sample)
                pulls.append(pull)
                if sample in fresh:
                    self._learn(sample, pull)
            nodes.append((to_s, x))
            stretches.append(Stretch(to_s, motions, pulls, x))
            t = to_s
        e = self.estimate
        e.x, e.y, e.psi, e.u, e.v, e.r = x
        self.path = Path(start_s, start, stretches)

    def _pulled(self, x: State, sample: LateSample) -> tuple[State, Pull]:
        i = sample.state
        gap = sample.value - x[i]
        gap = self._gap = turn(gap) if i == 2 else gap
        usual = -sample.limit <= gap <= sample.limit
        pull = gap if usual else sample.limit if gap > 0.0 else -sample.limit
        moved = sample.share * pull
        full = usual and sample.counts
        return (*x[:i], x[i] + moved, *x[i + 1 :]), Pull(i, full, abs(moved))

    def _learn(self, sample: LateSample, pull: Pull) -> None:
        """A new sample tells how far off samples usually are."""
        state = STATES[sample.state]
        self.innovation[state], self.received[state] = self._gap, pull.full
        self.pulled[state] = pull.moved
        doubt = self.sigma.of[state]
        doubt.learn(min(max(self._gap, -sample.limit), sample.limit))
        doubt.shrink(sample.share)

    def _run(self, x: State, t: float, to_s: float) -> tuple[State, list[Motion]]:
        """The model from t to to_s, under what drove it then."""
        motions: list[Motion] = []
        drives = self._drives
        for k, drive in enumerate(drives):
            until_s = min(drives[k + 1].time_s if k + 1 < len(drives) else to_s, to_s)
            if until_s > t:
                count = max(ceil((until_s - t) / self.inner_s - ROUNDING), 1)
                h = (until_s - t) / count
                for _ in range(count):
                    x, motion = self._one(x, drive, h)
                    motions.append(motion)
                t = until_s
        return x, motions

    def _one(self, x: State, drive: Inputs, h: float) -> tuple[State, Motion]:
        """One inner step, and the motion through the water as it began."""
        north, east, psi, u0, v0, r0 = x
        s = drive.situation
        s.x, s.y, s.psi, s.u, s.v, s.r = x
        forces = drive.physics.forces(s)
        motion: Motion = (s.u_r, s.v_r, r0, hypot(u0 - s.u_r, v0 - s.v_r))  # type: ignore[operator, assignment]
        rates: Rates = drive.physics.mean_rates(s, forces, drive.learned, h)
        speed, _, turning = self.most
        u = min(max(u0 + rates.u * h, -speed), speed)
        v = min(max(v0 + rates.v * h, -speed), speed)
        r = min(max(r0 + rates.r * h, -turning), turning)
        along = psi + 0.25 * (r0 + r) * h
        c, si, mean_u, mean_v = cos(along), sin(along), 0.5 * (u0 + u), 0.5 * (v0 + v)
        return (
            north + (mean_u * c - mean_v * si) * h,
            east + (mean_u * si + mean_v * c) * h,
            psi + 0.5 * (r0 + r) * h,
            u,
            v,
            r,
        ), motion

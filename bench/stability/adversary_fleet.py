"""Many ships at once, each with an observer and an adversary of its own that breaks the bound if it can."""

import time
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.certificate import Certificate, Confined
from twin.live.certificate.observer_tube import look_back
from twin.live.learning.movable import Movable, movable, moved
from twin.physics import core
from twin.physics.model import Model
from twin.physics.state import Force, Situation

HEADING_NOISE = 0.005  # rad


@dataclass(frozen=True)
class AdversaryOutcome:
    """What became of the runs of a case; ratios are error over bound, by axis (surge, sway, yaw)."""

    runs: int
    left: int
    steps: int
    samples: int  # inside the operating set, of runs x steps
    violations: int
    of_tube: tuple[float, ...]
    of_bound: tuple[float, ...]
    error: tuple[float, ...]
    seconds: float


class AdversaryFleet:
    """Many ships of one kind at once, each with an observer and an adversary of its own."""

    def __init__(
        self,
        model: Model,
        c: Certificate,
        runs: int,
        seed: int,
        H_s: float = 0.0,
        dropouts: bool = False,
        moving: bool = False,
    ) -> None:
        self.c, self.runs, self.rng, self.h = c, runs, np.random.default_rng(seed), c.h
        self.H_s, self.dropouts = H_s, dropouts
        self.numbers = movable(model.effects, model.ship) if moving else ()
        self.time = model.ship.scale("time")  # L/U_0 [s]
        self.limit = np.array(c.disturbance.at(H_s))[:, None]
        self.stated = c.disturbance.noise(c.noise, H_s)
        self.noise = np.array(self.stated)[:, None]
        self.heading_noise = c.disturbance.heading_noise(HEADING_NOISE, H_s)
        self.inverse = np.array([core.accelerations(*row, model.c) for row in c3.IDENTITY]).T  # M^-1
        self.true = replace(model, residual=lambda s: Force(*self.push))
        self.twin = Confined.to(replace(model, residual=lambda s: Force(*self.learned)), c.operating)
        self._start()

    def _start(self) -> None:
        n, rng, ranges = self.runs, self.rng, self.c.operating.ranges
        through = [rng.uniform(*_inner(ranges[a], s), n) for a, s in (("u", 0.5), ("v", 0.2), ("r", 0.2))]
        zero, psi = np.zeros(n), rng.uniform(-np.pi, np.pi, n)
        w = self.true.water(Situation(psi=psi))
        nu = np.array([through[0] + w.u, through[1] + w.v, through[2]])
        self.truth = (zero, zero, psi, *nu)
        self.estimate = nu + self.noise * rng.uniform(-1, 1, (3, n))
        self.past = deque(maxlen=self.c.delay_samples + 1)
        self.tube = np.repeat(np.array(self.stated)[:, None], n, axis=1)
        window = look_back(self.c.delay_samples)
        self.before, self.after = deque([self.tube], maxlen=window), deque([self.tube], maxlen=window)
        self.alive = np.ones(n, bool)
        self.policy = rng.integers(0, 4, n)
        self.corner = rng.choice([-1.0, 1.0], (3, n))
        self.period = self.time * rng.uniform(0.05, 2.0, n)
        self.share = rng.random(n)  # of the disturbance that is the ship's; the rest is the hostile network's
        self.gentle = rng.uniform(0.1, 1.0, n)
        self.silent = np.zeros((3, n))  # samples for which a row stays silent
        # the end of its box at which each number is held
        self.held = rng.integers(0, 2, (len(self.numbers), n))
        self._helm()

    def _helm(self) -> None:
        """New orders and new weather for some of the ships, within the operating set."""
        n, rng, ranges = self.runs, self.rng, self.c.operating.ranges
        ahead = ranges["n"][1] / 1.25
        fresh = {
            "delta": self.gentle * rng.uniform(*ranges["delta"], n),
            "n": ahead * np.minimum(rng.uniform(0.5, 1.2, n), 1.25),
            "wind_speed": self.gentle * rng.uniform(*ranges["wind_speed"], n),
            "wind_to": rng.uniform(-np.pi, np.pi, n),
        }
        change = rng.random(n) < (1.0 if not hasattr(self, "inputs") else self.h / (0.5 * self.time))
        self.inputs = {k: np.where(change, x, getattr(self, "inputs", fresh)[k]) for k, x in fresh.items()}

    def _against(self, k: int) -> np.ndarray:
        """(3, runs) the direction in which the adversary drives the error."""
        error = np.sign(self.estimate - np.array(self.truth[3:]))
        square = self.corner * np.sign(np.sin(2 * np.pi * k * self.h / self.period))
        white = self.rng.uniform(-1, 1, (3, self.runs))
        return np.choose(self.policy, [error, self.corner, square, white])

    def _twin(self, k: int, before: tuple[Any, ...], side: np.ndarray) -> Confined:
        """What the observer integrates: the ship's equations, with every number of its effects where the
        adversary wants it."""
        if not self.numbers:
            return self.twin
        worst = [self._worse(i, before, side) for i in range(len(self.numbers))]
        square = (self.held + (np.sin(2 * np.pi * k * self.h / self.period) > 0.0)) % 2
        share = np.choose(self.policy, [worst, self.held, square, self.rng.random(self.held.shape)])
        return self._with(
            self.numbers, [m.low + x * (m.high - m.low) for m, x in zip(self.numbers, share, strict=True)]
        )

    def _worse(self, i: int, before: tuple[Any, ...], side: np.ndarray) -> np.ndarray:
        """(runs,) 1 where the upper end of a number's box drives the error further than the lower one, else
        0."""
        m, weight = self.numbers[i], side / np.array(self.c.bound)[:, None]
        low, high = (
            np.array(self._with((m,), [x]).step(before, Situation(**self.inputs), self.h)[3:])
            for x in (m.low, m.high)
        )
        return ((weight * (high - low)).sum(0) > 0.0).astype(int)

    def _with(self, numbers: Sequence[Movable], values: Sequence[object]) -> Confined:
        return replace(self.twin, effects=moved(self.twin.effects, numbers, values))

    def _received(self) -> np.ndarray:
        """(3, runs) which rows were measured: all, or one in ten lost and now and then all of an axis for a
        while.
        """
        if not self.dropouts:
            return np.ones((3, self.runs), bool)
        burst = self.rng.random((3, self.runs)) < self.h / (2.0 * self.time)
        length = self.time * self.rng.uniform(0.02, 0.3, (3, self.runs)) / self.h
        self.silent = np.where(burst, length, self.silent - 1.0)
        return (self.rng.random((3, self.runs)) > 0.1) & (self.silent <= 0.0)

    def step(self, k: int) -> np.ndarray:
        """One tick of all ships: truth, prediction, correction; (3, runs) the error after it."""
        self._helm()
        side = self._against(k)
        force = np.sign(self.inverse.T @ (side / np.array(self.c.bound)[:, None])) * self.limit
        self.push, self.learned = -self.share * force, (1.0 - self.share) * force
        heading = self.truth[2] + self.heading_noise * side[2]
        before = (0.0, 0.0, heading, *self.estimate)
        self.estimate = np.array(
            self._twin(k, before, side).step(before, Situation(**self.inputs), self.h)[3:]
        )
        for _ in range(2):
            self.truth = self.true.step(self.truth, Situation(**self.inputs), 0.5 * self.h)
        self.past.append((np.array(self.truth[3:]), self.estimate))
        self.received = self._received()
        self.estimate = self.estimate + np.where(self.received, self._pull(k, side), 0.0)
        # what comes late is compared with the corrected estimate of its time
        self.past[-1] = (self.past[-1][0], self.estimate)
        self._grow()
        low, high = np.array([self.c.operating.ranges[a] for a in ("u", "v", "r")]).T
        nu, w = np.array(self.truth[3:]), self.true.water(Situation(psi=self.truth[2]))
        through = nu - np.array([w.u, w.v, 0.0 * w.u])
        self.alive = self.alive & np.all((through >= low[:, None]) & (through <= high[:, None]), axis=0)
        return self.estimate - nu

    def _pull(self, k: int, side: np.ndarray) -> np.ndarray:
        """h K times a late and noisy measurement less the estimate of its own time; the age changes now and
        then.
        """
        measured = []
        for axis, oldest in enumerate(self.c.delays):
            age = min(len(self.past) - 1, oldest if k % 3 else int(self.rng.integers(0, oldest + 1)))
            was, thought = self.past[-1 - age]
            measured.append(was[axis] - thought[axis])
        return np.array(self.c.step.pull)[:, None] * (np.array(measured) + self.noise * side)

    def _grow(self) -> None:
        """The same bound as `Tube`, for all runs at once."""
        c, step = self.c, self.c.step
        V, drift, now, again = (np.array(x) for x in (step.V, step.drift, step.now, step.again))
        turned = np.array([c.h * p + row[3] for p, row in zip(c.plant.heading, c.plant.bend, strict=False)])
        d = np.array(c.push) @ self.limit[:, 0] + c.calm + turned * (self.heading_noise - c.heading_noise)
        E = V @ self.tube + d[:, None]
        self.before.append(E)
        told = np.array(step.left_by(tuple(d.tolist()), self.stated))
        seen = (
            now @ self.tube
            + again[:, None] * np.max(self.before, axis=0)
            + drift @ np.max(self.after, axis=0)
            + told[:, None]
        )
        self.tube = np.where(self.received, seen, E)
        self.after.append(self.tube)


def trial(fleet: AdversaryFleet, seconds: float | None = None) -> AdversaryOutcome:
    """Let a fleet sail until old errors have faded five times over, at least two ship lengths (at most 1500
    samples).
    """
    begin, c = time.perf_counter(), fleet.c
    steps = min(int((seconds or max(5.0 / c.rate, 2.0 * fleet.time)) / c.h), 1500)
    bound = np.array(c.bound_in(fleet.H_s))[:, None]
    of_tube = of_bound = error = np.zeros(3)
    violations = samples = 0
    for k in range(steps):
        e = np.abs(fleet.step(k))
        inside = fleet.alive
        if not inside.any():
            continue
        samples += int(inside.sum())
        violations += int(np.any(e > fleet.tube * (1.0 + 1e-9), axis=0)[inside].sum())
        of_tube = np.maximum(of_tube, (e / fleet.tube)[:, inside].max(axis=1))
        of_bound = np.maximum(of_bound, (e / bound)[:, inside].max(axis=1))
        error = np.maximum(error, e[:, inside].max(axis=1))
    took = time.perf_counter() - begin
    ratios = (tuple(x.tolist()) for x in (of_tube, of_bound, error))
    return AdversaryOutcome(fleet.runs, int((~fleet.alive).sum()), steps, samples, violations, *ratios, took)


def _inner(span: tuple[float, float], share: float) -> tuple[float, float]:
    middle, half = 0.5 * (span[0] + span[1]), 0.5 * (span[1] - span[0])
    return middle - share * half, middle + share * half

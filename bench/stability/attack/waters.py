"""The ships of one batch: their true motion, and the observers' model of it, under orders."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from bench.stability.attack.cases import GAPS, SHORT, Group
from bench.stability.attack.orders import PLACES, Orders, hidden_age
from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.certificate import Certificate, Confined
from twin.physics import core
from twin.physics.model import Model
from twin.physics.state import Force, Situation

ROUGH = 0.2  # a step times the steepest slope: the truth takes longer ones in parts
SHORTEST = 0.9  # of a period, where ticks are short
SAMPLES_LOST = 0.15  # of the samples, where there are gaps

State = tuple[np.ndarray, ...]


class Waters:
    """Groups of `runs` ships each. Arrays by run are (..., N) with N = runs x groups."""

    def __init__(
        self, model: Model, c: Certificate, groups: Sequence[Group], runs: int, ticks: int, seed: int
    ) -> None:
        self.c, self.groups, self.runs, self.ticks = c, list(groups), runs, ticks
        rng = np.random.default_rng([seed, 7])
        self.inverse = np.array([core.accelerations(*row, model.c) for row in c3.IDENTITY]).T  # M^-1
        self.true = replace(model, residual=lambda s: Force(*self._push))
        told = replace(model, residual=lambda s: Force(*self._learned))
        # the loop does not clip, and what goes part by part of the set counts on that
        self.twin = told if c.inner > 1 else Confined.to(told, c.operating)
        self.known = model
        self.limit = np.array(c.disturbance.at(0.0))[:, None] * self._by_run(lambda g: g.excess.force)
        self.stated = np.array([*c.noise, c.heading_noise])[:, None]  # and where errors begin
        self.noise = self.stated * self._by_run(lambda g: g.excess.noise)
        # samples that are older than they are said to be (an observer that corrects at their own time)
        self.hidden_age = self._by_run(lambda g: hidden_age(c, g))
        # share of a period that each tick lasts, and whether each row is measured, by group
        self.lasts = np.ones((ticks, len(groups)))
        self.comes = np.ones((ticks, 4, len(groups)), bool)
        for i, group in enumerate(groups):
            if group.pattern == SHORT:
                self.lasts[:, i] = rng.uniform(SHORTEST, 1.0, ticks)
            if group.pattern == GAPS:
                self.comes[:, :3, i] = rng.random((ticks, 3)) > SAMPLES_LOST
            self.lasts[:, i] *= group.excess.tick
        steepest = max(c.plant.magnitude()[i][i] for i in (0, 1, 2))
        # steps in which half a tick of the truth is made; 0: one for the whole of it
        self.cut = int(np.ceil(0.5 * c.h * steepest / ROUGH)) if c.h * steepest > ROUGH else 0

    def _by_run(self, of: Callable[[Group], float]) -> np.ndarray:
        return np.repeat([float(of(g)) for g in self.groups], self.runs)

    def dt(self, k: int) -> np.ndarray:
        """(N,) how long the tick from k to k + 1 lasts [s]."""
        return self.c.h * np.repeat(self.lasts[k], self.runs)

    def received(self, k: int) -> np.ndarray:
        """(4, N) which rows are measured at the end of that tick."""
        return np.repeat(self.comes[k], self.runs, axis=1)

    def inputs(self, orders: Orders, k: int) -> dict[str, np.ndarray]:
        first = k < orders.turn
        low, high = np.array([self.c.operating.ranges[name] for name in PLACES]).T[:, :, None]
        x = low + (high - low) * orders.place
        return {"delta": np.where(first, x[3], x[5]), "n": np.where(first, x[4], x[6])}

    def begin(self, orders: Orders) -> State:
        """(u, v, r, psi) of the ships."""
        low, high = np.array([self.c.operating.ranges[name] for name in PLACES[:3]]).T[:, :, None]
        u, v, r = low + (high - low) * orders.place[:3]
        w = self.known.water(Situation(psi=orders.psi))
        return u + w.u, v + w.v, r, orders.psi

    def push(self, force: np.ndarray, share: np.ndarray) -> None:
        """`force` (3, N) acts on the error: in part as the hostile network's, in part, backwards, as what
        the ship feels."""
        self._learned, self._push = (1.0 - share) * force, -share * force

    def sailed(self, x: State, inputs: dict[str, np.ndarray], dt: np.ndarray) -> tuple[State, State]:
        """The ships half a tick and a tick on, by the classical Runge-Kutta method."""
        if not self.cut:
            return self._step(x, inputs, dt)
        halves = []
        for _ in range(2):
            for _ in range(self.cut):
                x = self._step(x, inputs, 0.5 * dt / self.cut)[1]
            halves.append(x)
        return halves[0], halves[1]

    def _step(self, x: State, inputs: dict[str, np.ndarray], h: np.ndarray) -> tuple[State, State]:
        """Half a step on (by its dense output of third order), and a step on."""
        k1 = self._rates(x, inputs)
        k2 = self._rates(_along(x, k1, 0.5 * h), inputs)
        k3 = self._rates(_along(x, k2, 0.5 * h), inputs)
        k4 = self._rates(_along(x, k3, h), inputs)
        slopes = list(zip(x, k1, k2, k3, k4, strict=True))
        half = tuple(z + h * (5.0 * a + 4.0 * (b + c) - d) / 24.0 for z, a, b, c, d in slopes)
        return half, tuple(z + h * (a + 2.0 * (b + c) + d) / 6.0 for z, a, b, c, d in slopes)

    def _rates(self, x: State, inputs: dict[str, np.ndarray]) -> State:
        u, v, r, psi = x
        return (*self.true.nu_dot(Situation(u=u, v=v, r=r, psi=psi, **inputs)), r)

    def predicted(self, x: np.ndarray, inputs: dict[str, np.ndarray], h: np.ndarray) -> np.ndarray:
        """(4, N) the observers' model a step of h seconds on, as the loop takes it: midpoint, the heading
        along the mean of old and new rate of turn."""
        u, v, r, psi = x
        first = self.twin.nu_dot(Situation(u=u, v=v, r=r, psi=psi, **inputs))
        a, b, c = (z + 0.5 * h * rate for z, rate in zip((u, v, r), first, strict=True))
        middle = self.twin.nu_dot(Situation(u=a, v=b, r=c, psi=psi + 0.5 * h * r, **inputs))
        turned = r + h * middle.r
        return np.array([u + h * middle.u, v + h * middle.v, turned, psi + 0.5 * h * (r + turned)])

    def through_water(self, x: np.ndarray) -> np.ndarray:
        """(4, N) of (u, v, r, psi): the motion through the water, and the current's speed."""
        water = self.known.water(Situation(psi=x[3]))
        return np.array([x[0] - water.u, x[1] - water.v, x[2], np.hypot(water.u, water.v)])

    def kept_inside(self, motions: np.ndarray | None) -> np.ndarray:
        """(K + 1, N) whether estimates of such motions (K, steps, 4, N) have been in the operating set."""
        assert motions is not None
        low, high = np.array([self.c.operating.ranges[name] for name in PLACES[:3]]).T[:, None, :, None]
        good = np.all((low <= motions[:, :, :3]) & (motions[:, :, :3] <= high), axis=(1, 2))
        return np.concatenate((good[:1], np.logical_and.accumulate(good, axis=0)))

    def within(self, *states: State) -> np.ndarray:
        """(N,) whether all of these motions lie in the operating set."""
        good = np.ones(len(states[0][0]), bool)
        for u, v, r, psi in states:
            w = self.known.water(Situation(psi=psi))
            for name, x in (("u", u - w.u), ("v", v - w.v), ("r", r)):
                low, high = self.c.operating.ranges[name]
                good &= (low <= x) & (x <= high)
        return good


def _along(x: State, slope: State, h: np.ndarray) -> State:
    return tuple(z + h * rate for z, rate in zip(x, slope, strict=True))

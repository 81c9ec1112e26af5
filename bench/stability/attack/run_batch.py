"""A batch of runs under orders: the ships sail, their observers follow, and errors are kept tick by tick."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from bench.stability.attack.orders import Orders, ages_of
from bench.stability.attack.waters import Waters

AXES = range(4)  # u, v, r, psi


class RunBatch(NamedTuple):
    """error (K + 1, 4, N) of the published estimate, [0] as it began; inside (K + 1, N): in the operating set
    until then; truth (K + 1, 4, N); orders: as they were carried out; motions (K, steps, 4, N): through the
    water, and the current's speed, as each inner step of the estimate's way began."""

    error: np.ndarray
    inside: np.ndarray
    truth: np.ndarray
    orders: Orders
    motions: np.ndarray | None = None


def sail(w: Waters, orders: Orders, greedy: bool = False) -> RunBatch:
    """All ticks. `greedy`: each tick everything pushes the way that the error then has, and the sample that
    corrects it least is the one that comes; else as ordered."""
    follow = RolledObservers(w, orders) if w.c.inner > 1 else LateObservers(w, orders)
    x, n = w.begin(orders), len(orders.psi)
    truth = np.empty((2 * w.ticks + 1, 4, n))  # by half ticks
    truth[0] = x
    error, inside = np.empty((w.ticks + 1, 4, n)), np.empty((w.ticks + 1, n), bool)
    error[0], inside[0] = w.stated * orders.start, w.within(x)
    follow.begin(truth[0] + error[0])
    if greedy:
        orders = replace(orders, force=orders.force.copy(), noise=orders.noise.copy(), age=orders.age.copy())
    weight = np.array(w.c.bound)[:, None]
    for k in range(w.ticks):
        inputs, dt = w.inputs(orders, k), w.dt(k)
        if greedy:
            side = np.where(error[k] < 0.0, -1.0, 1.0)
            orders.force[k], orders.noise[k] = np.sign(w.inverse.T @ (side[:3] / weight)), side
        w.push(w.limit * orders.force[k], orders.share)
        half, x = w.sailed(x, inputs, dt)
        truth[2 * k + 1], truth[2 * k + 2] = half, x
        if greedy and isinstance(follow, LateObservers):
            orders.age[k] = follow.least(truth, k, side, error[k])
        error[k + 1] = follow.step(k, inputs, dt, truth, orders) - truth[2 * k + 2]
        inside[k + 1] = inside[k] & w.within(half, x)
    motions = follow.motions if isinstance(follow, RolledObservers) else None
    return RunBatch(error, inside, truth[::2], orders, motions)


def along(path: np.ndarray, at: np.ndarray, axis: int, last: int) -> np.ndarray:
    """(N,) one row of a path at these places (N,) along it, on the straight line between its points."""
    at = np.clip(at, 0.0, last)
    low, row = at.astype(int), 4 * at.size
    first = row * low + axis * at.size + np.arange(at.size)
    flat = path.reshape(-1)
    before, after = flat.take(first), flat.take(first + np.where(low < last, row, 0))
    return before + (at - low) * (after - before)


class LateObservers:
    """Each sample is compared with the corrected estimate of its own time, and pulls now (Theorem 2)."""

    def __init__(self, w: Waters, orders: Orders) -> None:
        self.w, self.path = w, np.empty((w.ticks + 1, 4, orders.psi.size))
        self.gain = np.array([*w.c.K, w.c.K[2]])

    def begin(self, estimate: np.ndarray) -> None:
        self.path[0] = estimate

    def step(
        self, k: int, inputs: dict[str, np.ndarray], dt: np.ndarray, truth: np.ndarray, orders: Orders
    ) -> np.ndarray:
        w, now, received = self.w, k + 1, self.w.received(k)
        self.path[now] = w.predicted(self.path[k], inputs, dt)
        pulled = self.path[now].copy()
        for i in AXES:
            when = now - orders.age[k, i]
            measured = along(truth, 2.0 * when, i, 2 * now) + w.noise[i] * orders.noise[k, i]
            gap = measured - along(self.path, when, i, now)
            pulled[i] += np.where(received[i], self.gain[i] * dt * gap, 0.0)
        if not w.c.estimated_heading:  # the compass's
            pulled[3] = truth[2 * now, 3] + w.noise[3] * orders.noise[k, 3]
        self.path[now] = pulled
        return pulled

    def least(self, truth: np.ndarray, k: int, side: np.ndarray, error: np.ndarray) -> np.ndarray:
        """(4, N) the age whose sample pulls an error of this side back the least."""
        ages = by_group(self.w)
        age, best = np.empty_like(error), np.full(error.shape, np.inf)
        for choice in ages:
            for i in AXES:
                when = np.maximum(k + 1 - choice, 0.0)
                was = along(self.path, when, i, k) - along(truth, 2.0 * np.minimum(when, k), i, 2 * k)
                lower = side[i] * was < best[i]
                age[i] = np.where(lower, choice, age[i])
                best[i] = np.where(lower, side[i] * was, best[i])
        return age


def by_group(w: Waters) -> np.ndarray:
    """(ages, N) the ages that each run may choose from, repeated where there are fewer."""
    ages = [ages_of(w.c, g) for g in w.groups]
    grids = [np.resize(x, max(map(len, ages))) for x in ages]
    return np.repeat(np.array(grids).T, w.runs, axis=1)


class RolledObservers:
    """Each sample corrects its own time, once, and the model runs on to now in inner steps (Theorem 3).

    Samples are no more than one tick old, by half ticks, so the way begins anew at the tick before."""

    def __init__(self, w: Waters, orders: Orders) -> None:
        self.w, self.half_steps = w, int(np.ceil(0.5 * w.c.inner))
        n = orders.psi.size
        self.share = w.c.K[0] * w.c.h
        self.before = np.empty((w.ticks + 1, 4, n))  # the estimate of each tick, none of whose samples came
        self.motions = np.empty((w.ticks, 2 * self.half_steps, 4, n))
        # samples by half ticks, NaN where none came
        self.samples = np.full((2 * w.ticks + 1, 4, n), np.nan)

    def begin(self, estimate: np.ndarray) -> None:
        self.before[0] = estimate

    def step(
        self, k: int, inputs: dict[str, np.ndarray], dt: np.ndarray, truth: np.ndarray, orders: Orders
    ) -> np.ndarray:
        w, received, run = self.w, self.w.received(k), np.arange(orders.psi.size)
        for i in AXES:
            said = np.minimum(orders.age[k, i], 1.0)
            place = np.rint(2.0 * (k + 1 - said)).astype(int)
            value = along(truth, place - 2.0 * w.hidden_age, i, 2 * k + 2)
            value = value + w.noise[i] * orders.noise[k, i]
            kept = self.samples[place, i, run]
            self.samples[place, i, run] = np.where(received[i] & (place > 0), value, kept)
        x = self._pulled(self.before[k], 2 * k)
        for half in (1, 2):
            for j in range(self.half_steps):
                self.motions[k, (half - 1) * self.half_steps + j] = w.through_water(x)
                x = w.predicted(x, inputs, 0.5 * dt / self.half_steps)
            if half == 2:
                self.before[k + 1] = x
            x = self._pulled(x, 2 * k + half)
        return x

    def _pulled(self, x: np.ndarray, place: int) -> np.ndarray:
        gap = self.samples[place] - x
        return x + np.where(np.isfinite(gap), self.share * gap, 0.0)

"""The steepest way to a great error: along the run that was sailed, the error is linear in what the adversary
may choose, so the worst choice lies on the ends (bang-bang), by the sign of the adjoint.

    mu_K = side e_axis,   mu_k-1 = (Phi - h K at the samples' own times)^T mu_k
    force = sign((M^-1)^T h mu),   noise = sign(h K mu),   start = sign(mu_0),   age: the least mu e(t - a)

Phi = I + h A + (h A)^2/2, A the slopes of the physics where the ship was."""

from dataclasses import replace

import numpy as np

from bench.stability.attack.orders import Orders
from bench.stability.attack.run_batch import AXES, RunBatch, along, by_group
from bench.stability.attack.waters import Waters
from twin.physics.dual import Dual
from twin.physics.state import Situation

NODES = 12  # places along a run at which the slopes are taken


def worse(w: Waters, was: RunBatch) -> Orders:
    """Orders that drive each run's error further, to first order."""
    return _rolled(w, was) if w.c.inner > 1 else _late(w, was)


def _target(orders: Orders) -> np.ndarray:
    """(4, N) the error that is to become great."""
    mu = np.zeros((4, orders.psi.size))
    mu[orders.axis, np.arange(orders.psi.size)] = orders.side
    return mu


def _late(w: Waters, was: RunBatch) -> Orders:
    o, run = was.orders, np.arange(was.orders.psi.size)
    steep, gain = AttackSlopes(w, was), np.array([*w.c.K, w.c.K[2]])
    mu = np.zeros_like(was.error)
    mu[-1] = _target(o)
    force, noise, age = (np.empty_like(x) for x in (o.force, o.noise, o.age))
    choices = by_group(w)
    for k in range(w.ticks - 1, -1, -1):
        now, dt, received = k + 1, w.dt(k), w.received(k)
        ahead = mu[now].copy()  # what the prediction's error does
        for i in AXES:
            pull = np.where(received[i], gain[i] * dt * mu[now, i], 0.0)
            noise[k, i] = _side(pull)
            age[k, i] = _oldest(was.error, choices, now, i, mu[now, i], o.age[k, i])
            when = np.maximum(now - o.age[k, i], 0.0)
            low = when.astype(int)
            share = when - low
            for place, part in ((low, 1.0 - share), (np.minimum(low + 1, now), share)):
                newest = place == now
                ahead[i] -= np.where(newest, part * pull, 0.0)
                mu[np.where(newest, 0, place), i, run] -= np.where(newest, 0.0, part * pull)
        if not w.c.estimated_heading:
            noise[k, 3], ahead[3] = _side(mu[now, 3]), 0.0
        back, force[k] = steep.back(k, dt, ahead)
        mu[k] += back
    return replace(o, force=force, noise=noise, age=age, start=_side(mu[0]))


def _oldest(
    error: np.ndarray, choices: np.ndarray, now: int, i: int, mu: np.ndarray, age: np.ndarray
) -> np.ndarray:
    """(N,) the age at which the error was the least on the side that it is driven to."""
    best = np.full(mu.size, np.inf)
    for choice in choices:
        effect = mu * along(error, now - choice, i, now)
        age = np.where(effect < best, choice, age)
        best = np.minimum(best, effect)
    return age


def _rolled(w: Waters, was: RunBatch) -> Orders:
    """As above where a sample takes its share of the error of its own time; each row's ages stay."""
    o, steep, share = was.orders, AttackSlopes(w, was), w.c.K[0] * w.c.h
    force, noise = np.zeros_like(o.force), np.empty_like(o.noise)
    age = np.minimum(o.age[0], 1.0)
    mu = _target(o)
    noise[:] = o.noise
    for k in range(w.ticks - 1, -1, -1):
        dt, received = w.dt(k), w.received(k)
        mu = _answered(mu, noise, k, received & (age == 0.0), share)
        if k + 1 < w.ticks:  # what comes with the next tick and was taken now
            mu = _answered(mu, noise, k + 1, w.received(k + 1) & (age == 1.0), share)
        mu, _ = steep.back(k, 0.5 * dt, mu)
        mu = _answered(mu, noise, k, received & (age == 0.5), share)
        force[k] = steep.back(k, 0.5 * dt, mu)[1]
        mu, _ = steep.back(k, 0.5 * dt, mu)
    return replace(o, force=force, noise=noise, start=_side(mu))


def _answered(mu: np.ndarray, noise: np.ndarray, k: int, there: np.ndarray, share: float) -> np.ndarray:
    """Through a sample, backwards."""
    noise[k] = np.where(there, _side(mu), noise[k])
    return np.where(there, (1.0 - share) * mu, mu)


def _side(x: np.ndarray) -> np.ndarray:
    return np.where(x < 0.0, -1.0, 1.0)


class AttackSlopes:
    """A of the physics along the runs that were sailed."""

    def __init__(self, w: Waters, was: RunBatch) -> None:
        self.w, self.inverse = w, w.inverse
        self.every = max(w.ticks // NODES, 1)
        self.at = [self._at(was, k) for k in range(0, w.ticks, self.every)]

    def _at(self, was: RunBatch, k: int) -> np.ndarray:
        """(4, 4, N), the fourth row that of the heading."""
        n = was.orders.psi.size
        seeds = (Dual(x, tuple(float(i == j) for j in AXES)) for i, x in enumerate(was.truth[k]))
        u, v, r, psi = seeds
        rates = self.w.known.nu_dot(Situation(u=u, v=v, r=r, psi=psi, **self.w.inputs(was.orders, k)))
        A = np.zeros((4, 4, n))
        for i, rate in enumerate(rates):
            for j, slope in enumerate(rate.slopes):
                A[i, j] = slope
        A[3, 2] = 1.0
        return A

    def back(self, k: int, dt: np.ndarray, mu: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Phi^T mu over tick k, and the force that drives mu the most in it."""
        A = self.at[min(k // self.every, len(self.at) - 1)]
        once = dt * np.einsum("ijn,in->jn", A, mu)
        twice = dt * np.einsum("ijn,in->jn", A, once)
        return mu + once + 0.5 * twice, _side(self.inverse.T @ (mu + 0.5 * once)[:3])

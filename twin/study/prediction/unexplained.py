"""Which share of the force that moves the ship the model misses, axis by axis, and how much of it is learned.

missing force = M (measured acceleration - the model's), both averaged over half a ship length of sailing
share = (energy of the missing force - energy that sensor noise gives it) / (that + energy of every known
    force)
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.physics import core
from twin.physics.model import Model
from twin.physics.state import Growth
from twin.study.estimation.respond import steered
from twin.study.estimation.start import noisy, true_motion
from twin.study.track.track import STATE, Track

AXES = ("surge", "sway", "yaw")


@dataclass(frozen=True)
class Energy:
    """Sums of squared forces (3,): X, Y [N2] and N [N2 m2]."""

    missing: np.ndarray
    known: np.ndarray
    learned: np.ndarray

    def unexplained(self) -> dict[str, float]:
        """By axis, the share of all force that is missing."""
        share = self.missing / np.maximum(self.missing + self.known + self.learned, 1e-12)
        return dict(zip(AXES, share.tolist(), strict=True))

    def learned_share(self) -> float:
        """Mean over the axes of what the learned force has of all force."""
        return float(np.mean(self.learned / np.maximum(self.missing + self.known + self.learned, 1e-12)))


def energy(tracks: Sequence[Track], models: Sequence[Model]) -> Energy:
    """Over all voyages, each with the model that its recordings can feed."""
    parts = [_energy(t, m) for t, m in zip(tracks, models, strict=True)]
    missing = np.maximum(np.sum([p[0] for p in parts], axis=0), 0.0)
    return Energy(missing, np.sum([p[1] for p in parts], axis=0), np.sum([p[2] for p in parts], axis=0))


@dataclass(frozen=True)
class Missing:
    """The force that the model misses over time: `t` (N,) [s], `force` and what sensor noise gives it,
    `noise`, (N, 3): X, Y [N], N [N m]; `whole` (N,): where it is known; each a mean over `width` steps."""

    t: np.ndarray
    force: np.ndarray
    noise: np.ndarray
    whole: np.ndarray
    width: int
    known: np.ndarray  # (3,): energy of all known forces
    learned: np.ndarray  # (3,): of the learned one


def missing_force(track: Track, model: Model) -> Missing:
    """M (measured acceleration - the model's), averaged over half a ship length of sailing; `model`
    must be one that the track can feed (`reference.sailed.fed`)."""
    width = max(2, round(0.5 * float(model.ship.scale("time")) / track.h))
    state, wind_to = true_motion(track, model)
    s = track.situation(**steered(track, model), **dict(zip(STATE, state.T, strict=True)))
    s.wind_to = wind_to
    physics = replace(model, residual=None)
    known = physics.known(s)
    rates = np.column_stack([np.broadcast_to(a, track.t.shape) for a in physics.nu_dot(s)])
    grown = float(np.mean(s.grown[0])), float(np.mean(s.grown[1]))
    learned = np.zeros_like(rates)
    if model.residual is not None:
        learned = np.column_stack([np.broadcast_to(f, track.t.shape) for f in model.residual(s)])
    noise = noisy(track, model, np.random.default_rng(0))[:, 3:]
    missing = _force(_slope(state[:, 3:], track.h, width) - _mean(rates, width), model, grown) - _mean(
        learned, width
    )
    shaken = _force(_slope(noise, track.h, width), model, grown)
    whole = _mean(track.whole[:, None].astype(float), width) > 0.999
    each = np.array(
        [
            sum(np.broadcast_to(np.square(f[i]), track.t.shape)[track.whole].sum() for f in known.values())
            for i in range(3)
        ]
    )
    middle = track.t[:-width] + 0.5 * width * track.h
    return Missing(middle, missing, shaken, whole[:, 0], width, each, np.square(learned)[track.whole].sum(0))


def _energy(track: Track, model: Model) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    m = missing_force(track, model)
    square = np.where(m.whole[:, None], np.square(m.force) - np.square(m.noise), 0.0)
    return square.sum(0), m.known, m.learned


def _slope(values: np.ndarray, h: float, width: int) -> np.ndarray:
    return (values[width:] - values[:-width]) / (width * h)


def _mean(values: np.ndarray, width: int) -> np.ndarray:
    """Mean over `width` steps between grid points k and k + width, by trapezes."""
    steps = 0.5 * (values[1:] + values[:-1])
    total = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])
    return (total[width:] - total[:-width]) / width


def _force(a: np.ndarray, model: Model, grown: Growth) -> np.ndarray:
    u, v, r = a.T
    return np.column_stack(core.force_for(u, v, r, model.c, grown))

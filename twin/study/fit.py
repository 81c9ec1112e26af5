"""Fit unknown numbers to tracks: Gauss-Newton on the filter's innovations, with priors, inside boxes.

Each unknown is z = (value - centre)/sd, so that its prior is N(0, 1) whatever its unit. Evidence is tempered by `temper`: what a
model leaves over is not white, and a likelihood taken at face value believes itself too much.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model

from .columns import Unknown, with_values
from .innovations import Floor, Linear, Normal, innovate, linearise
from .track import Track

Catalogue = dict[str, type[Effect]]
TRIES = 3  # times the steps that are asked for
POOR = 0.1  # share of the gain that a step promised, below which it went too far
LEVEL = 0.5  # by which a step may seem worse: the filter is linearised anew
SHORTER = 0.1  # of the information, added to it when a step made things worse
STANDS = 0.02  # prior widths that a step may still move


@dataclass(frozen=True)
class Fit:
    """What a fit found: `model` holds the values; `value`, `sd` (P,) in the unknowns' units; `gained` (P,): 1 - posterior/prior variance."""

    model: Model
    unknowns: tuple[Unknown, ...]
    value: np.ndarray
    covariance: np.ndarray
    lines: tuple[Linear, ...]
    normal: Normal

    @property
    def sd(self) -> np.ndarray:
        return np.sqrt(np.diag(self.covariance))

    @property
    def gained(self) -> np.ndarray:
        prior = np.array([u.sd for u in self.unknowns])
        return 1.0 - (self.sd / prior) ** 2


def fit(
    tracks: Sequence[Track], model: Model, unknowns: Sequence[Unknown], catalogue: Catalogue, floor: Floor, *,
    temper: float = 1.0, rounds: int = 4, reach: float = np.inf, smooth: bool = False,
) -> Fit:  # fmt: skip
    """The most probable values of the unknowns, given the tracks and their priors, after so many steps that made them more probable,
    none of which moves a number by more than `reach` prior widths.
    A step too far is taken back and made shorter (Levenberg & Marquardt), so that a fit of many numbers does not end in a corner of their boxes;
    the last one is not judged. `smooth`: faults of instruments are judged along the smooth motion alone, as long as the core that the filter
    follows is not found yet, and errs by more than they do."""
    centre, sd = np.array([u.centre for u in unknowns]), np.array([u.sd for u in unknowns])
    value = np.array([_present(model, u) for u in unknowns])
    least, promised, damping, steps = np.inf, 0.0, 0.0, 0
    for _ in range(TRIES * rounds):
        model = with_values(model, unknowns, value.tolist(), catalogue)
        here = {u.label: float(v) for u, v in zip(unknowns, value, strict=True)}
        about = [replace(u, centre=here[u.label]) if u.owner == "core" else u for u in unknowns]
        trial = [linearise(t, model, about, catalogue, here, smooth=smooth) for t in tracks]
        told = innovate(trial, [floor])[0]
        z = (value - centre) / sd
        cost = float((told.ee + told.logdet).sum()) / temper + float(z @ z)
        if least - cost >= POOR * promised - LEVEL:
            least, damping, steps = cost, 0.1 * damping, steps + 1
            at, lines, normal = value, trial, told
            A, b, _ = normal.total()
            H, pull = A / temper * np.outer(sd, sd) + np.eye(sd.size), b / temper * sd - z
        else:
            damping = max(10.0 * damping, SHORTER)
        step = np.linalg.solve(H + damping * np.diag(np.diag(H)), pull)
        step *= min(1.0, reach / max(float(np.max(np.abs(step))), STANDS))
        value = np.clip(at + sd * step, [u.lo for u in unknowns], [u.hi for u in unknowns])
        step = (value - at) / sd
        promised = max(0.0, float(2.0 * pull @ step - step @ H @ step))
        if np.max(np.abs(step)) < STANDS or steps == rounds:
            break
    else:
        value = at
    model = with_values(model, unknowns, value.tolist(), catalogue)
    covariance = np.linalg.inv(H) * np.outer(sd, sd)
    return Fit(model, tuple(unknowns), value, covariance, tuple(lines), normal)


def _present(model: Model, unknown: Unknown) -> float:
    """The unknown's value in the model as it stands; its centre where the effect is not there."""
    if unknown.owner == "core":
        return float(getattr(model.ship.derivatives, unknown.name))
    for effect in model.effects:
        if type(effect).__name__ == unknown.owner:
            return float(getattr(effect, unknown.name))
    return unknown.centre


def evidence(normal: Normal, sd: np.ndarray, offset: np.ndarray | None = None) -> float:
    """Log probability of the innovations with the unknowns integrated out over N(offset, sd^2)."""
    A, b, ee = normal.total()
    A, b = A * np.outer(sd, sd), b * sd
    if offset is not None:
        z = offset / sd
        ee, b = ee - 2.0 * float(b @ z) + float(z @ A @ z), b - A @ z
    L = np.linalg.cholesky(A + np.eye(sd.size))
    half = np.linalg.solve(L, b)
    return -0.5 * (ee - float(half @ half) + float(normal.logdet.sum())) - float(np.log(np.diag(L)).sum())

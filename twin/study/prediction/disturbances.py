"""The slow disturbances that a calibrated model of a ship is known to miss, drawn for every window of an
open-loop prediction."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from twin.physics import core
from twin.physics.model import Model
from twin.physics.state import Force
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.linear import MEMORY_B, busy
from twin.study.estimation.respond import standard
from twin.study.track.track import Track


@dataclass
class SlowDisturbances:
    """Of the third run of each window, and of one more for each further noise model (F of them): an
    acceleration that wanders (b), and water that moves (c)."""

    size: np.ndarray  # (F, N, 3) how large b usually is at each step of the track
    b: np.ndarray  # (3, W) in units of it
    keep: float  # what is left of b after a step
    water: tuple[np.ndarray, np.ndarray]  # ((2 + F) W,) toward north and east [m/s]
    rng: np.random.Generator

    def force(self, model: Model, step: np.ndarray) -> Force:
        """((2 + F) W,) the force [N, N, N m] that gives this acceleration at these grid steps (W,) of each
        window; none on the first two runs. Each call goes on by a step."""
        self.b = self.keep * self.b + np.sqrt(1.0 - self.keep**2) * self.rng.standard_normal(self.b.shape)
        none, each = np.zeros(2 * step.size), self.b * self.size[:, step].swapaxes(1, 2)
        u, v, r = (each[:, axis].ravel() for axis in range(3))
        return Force(*(np.append(none, f) for f in core.force_for(u, v, r, model.c)))


def disturbances(
    track: Track,
    model: Model,
    noise_models: Sequence[NoiseModel],
    start: np.ndarray,
    rng: np.random.Generator,
) -> SlowDisturbances | None:
    """Those that these noise models describe (see innovations.py), drawn by `rng` for every window and alike
    for each of them, in SI; `start` (W,): grid steps at which they begin [-]. None where no noise model is
    known."""
    if not noise_models:
        return None
    moved, usual = busy(track, model), standard(model)
    size = np.array([np.array(m.share) * np.hypot(moved, m.calm * usual) for m in noise_models])
    flows, none = (
        [m.flow * float(model.ship.scale("speed")) for m in noise_models],
        np.zeros(2 * start.size),
    )
    drawn = [rng.standard_normal(start.size) for _ in "ne"]
    water = [np.concatenate([none, *(flow * x for flow in flows)]) for x in drawn]
    keep = float(np.exp(-track.h / (MEMORY_B * float(model.ship.scale("time")))))
    return SlowDisturbances(size, rng.standard_normal((3, start.size)), keep, (water[0], water[1]), rng)

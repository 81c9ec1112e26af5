"""How much of what old numbers promised has come true: what lets learned numbers act.

    g = [beta - its deviation]/ENOUGH in [0, 1],   beta = sum_r <d_r p_r>/s_r^2 / sum_r <p_r^2>/s_r^2

p_r is what the numbers of a while ago (HINDSIGHT) promise for now, d_r what is wanted now, s_r its usual
error. All three rows are asked together, each by its own scatter: what changes a ship shows in all of them,
and is seen first in the one that is least noisy. Of what was only noise nothing comes true."""

from math import sqrt

from twin.live.learning.ridge import GATE, NOISE_S
from twin.physics.maths import total

SAMPLES = 2.0 * GATE / NOISE_S  # that the means count as
ENOUGH = 0.5  # share of what was promised that must surely have come true for all of it to act


class Proof:
    """`gate` is how far the numbers may act, 0 to 1."""

    def __init__(self) -> None:
        self.gate = 0.0
        # of each row: means of wanted times promised, promised^2, wanted^2
        self._kept = [[0.0, 0.0, 0.0] for _ in range(3)]
        self._spread = [1.0] * 3

    def weigh(self, r: int, wanted: float, promised: float, spread: float, h: float) -> None:
        """One row's word: both in units of the force scale, its usual error squared, the time since it last
        spoke [L/U_0]."""
        kept, g, self._spread[r] = self._kept[r], min(h / GATE, 0.2), spread
        limit = 3.0 * sqrt(kept[2] + spread)
        cut = min(max(wanted, -limit), limit)
        for i, x in enumerate((cut * promised, promised * promised, cut * cut)):
            kept[i] += g * (x - kept[i])
        came, size = (total(k[i] / s for k, s in zip(self._kept, self._spread, strict=True)) for i in (0, 1))
        least = (came - sqrt(size / SAMPLES)) / size if size > 0.0 else 0.0  # less one deviation of its noise
        self.gate = min(max(least / ENOUGH, 0.0), 1.0)

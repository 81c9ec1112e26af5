"""Does a change of the model make measurements likelier that it was not fitted to?

Both models predict every window of the held-out part open loop, from the same measured state, with the stream
that the voyage had shown by then (prediction/own_water.py). What they promise is judged by the density of a
healthy ship's errors (reference/path_error.py), in all readings together, at every horizon:

    log LR = mean over horizons of  sum over voyages of  n_eff  mean over windows of
             log p(e_after) - log p(e_before)

n_eff is the number of independent windows that a voyage's windows count as. Under the model without the
change exp(log LR) is expected to be at most one (the geometric mean of likelihood ratios, each of which is
expected to be one), so that it exceeds 20 by chance on one voyage in twenty at most (Markov's inequality): a
change is proved when log LR >= log 20 and its 95 % interval, by resampling blocks, lies above zero. Metres
and degrees beside it illustrate; no horizon decides alone.

Source: Vovk & Wang (2021) E-values: calibration, combination and applications, Ann. Statist. 49, 1736-1754;
    blocks: Kuensch (1989) The jackknife and the bootstrap for general stationary observations, Ann. Statist.
    17, 1217-1241.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import stdtrit

from twin.errors import DataError
from twin.num import as_given
from twin.study.diagnosis.horizon import where_read
from twin.study.estimation.rarity import P95
from twin.study.prediction.envelope import widening
from twin.study.prediction.error_vectors import vectors
from twin.study.prediction.openloop import HORIZONS_S, MODEL, Windows
from twin.study.reference.path_error import PathError

LEAST_PROOF_WINDOWS = 2.0  # windows that do not overlap, below which nothing can be said
LENGTHS = 3.0  # that a ship must be predicted ahead, at least: nearer than that it hardly moves
LEVEL = 0.05  # of all changes that are none, the share that may be taken for one
BLOCKS = 6.0  # into how many blocks the voyages are cut for the interval, at least
RESAMPLES = 2000
UNCHANGED = 1e-9  # log probability


@dataclass(frozen=True)
class HeldOutProof:
    """The log likelihood ratio of held-out measurements, after over before, with its 95 % interval, and how
    it is made up."""

    log_ratio: float
    low95: float
    high95: float
    by_horizon: tuple[dict[str, float], ...]
    held_out_s: float  # how long a voyage it rests on
    idle: bool  # whether nothing at all is predicted otherwise

    @property
    def needed(self) -> float:
        """The log likelihood ratio that a change that is none reaches with probability LEVEL at most."""
        return -float(np.log(LEVEL))

    @property
    def proved(self) -> bool:
        """Whether the change makes held-out measurements likelier, beyond chance."""
        return not self.idle and self.log_ratio >= self.needed and self.low95 > 0.0

    @property
    def more_s(self) -> float | None:
        """How much more of such voyages would prove it, if it goes on as it does [s]; None where it does not
        go the right way. The ratio grows with their length, its interval with the root of it."""
        if self.proved or self.idle or self.log_ratio <= 0.0:
            return None
        times = max(self.needed / self.log_ratio, ((self.log_ratio - self.low95) / self.log_ratio) ** 2)
        return (times - 1.0) * self.held_out_s

    def entry(self) -> dict[str, Any]:
        """The numbers, for JSON and the ship file."""
        return {
            "log_likelihood_ratio": self.log_ratio,
            "low95": self.low95,
            "high95": self.high95,
            "needed": self.needed,
            "proved": self.proved,
            "by_horizon": list(self.by_horizon),
            "held_out_s": self.held_out_s,
            "more_needed_s": self.more_s,
        }


def prove(
    before: Sequence[Windows],
    after: Sequence[Windows],
    errors: PathError,
    horizons_s: Sequence[float],
    time_s: float,
) -> HeldOutProof:
    """Judge the change from one set of predictions to the other, of the same windows. DataError when they are
    too few to say anything.

    `time_s`: L/U_0, in which the ship sails its length."""
    asked = [h for h in horizons_s if sum(independent(w, h) for w in before) >= LEAST_PROOF_WINDOWS]
    least = min(max(HORIZONS_S), LENGTHS * time_s)
    if max(asked, default=0.0) < 0.99 * min([least, *where_read([w.track for w in before], [least])]):
        raise DataError(
            f"{', '.join(w.track.name for w in before)}: what is left to judge by does not hold "
            f"{as_given(LEAST_PROOF_WINDOWS)} windows of {least:.0f} s that do not overlap. Give a longer "
            "voyage, or another one with --held-out."
        )
    pairs = list(zip(before, after, strict=True))
    gains = [[_gain(b, a, errors, h) for h in asked] for b, a in pairs]
    weights = [[_weight(b, errors, h) for h in asked] for b, _ in pairs]
    each = [
        np.sum([g * w for g, w in zip(mine, by, strict=True)], axis=0) / len(asked)
        for mine, by in zip(gains, weights, strict=True)
    ]
    rows = tuple(
        {
            "horizon_s": h,
            "log_likelihood_ratio": float(
                sum((g[i] * w[i]).sum() for g, w in zip(gains, weights, strict=True))
            ),
            "windows": float(sum(independent(b, h) for b in before)),
        }
        for i, h in enumerate(asked)
    )
    total, length = float(sum(e.sum() for e in each)), sum(_length(w) for w in before)
    low, high = block_interval(each, before, max(asked))
    idle = all(np.abs(g).max(initial=0.0) < UNCHANGED for mine in gains for g in mine)
    return HeldOutProof(total, low, high, rows, length, idle)


def _gain(before: Windows, after: Windows, errors: PathError, horizon_s: float) -> np.ndarray:
    """(W,) log p(after) - log p(before) of every window; nothing where one cannot be judged."""
    k, width = before.at(horizon_s), widening(before, horizon_s, errors.sailed)
    b, a = (
        errors.log_density(_bounded(vectors(w, MODEL)[k], errors.at(horizon_s)), horizon_s, width)
        for w in (before, after)
    )
    return np.where(before.valid[k], np.nan_to_num(a - b), 0.0)


def _bounded(error: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """The same, of a model that ran away as wrong as can be written down."""
    most = 1e3 * np.sqrt(np.diag(covariance))
    return np.clip(error, -most, most)


def _weight(windows: Windows, errors: PathError, horizon_s: float) -> float:
    """What every window of a voyage counts for, so that all together count as the voyage's effective
    number."""
    count = windows.valid[windows.at(horizon_s)].sum()
    return errors.effective(independent(windows, horizon_s), horizon_s) / float(count) if count else 0.0


def independent(windows: Windows, horizon_s: float) -> float:
    """How many windows of a track do not overlap; none at a horizon that was not asked."""
    k = windows.at(horizon_s)
    if abs(windows.lead[k] * windows.track.h - horizon_s) > windows.track.h:
        return 0.0
    return float(windows.valid[k].sum()) * min(1.0, _stride(windows) / horizon_s)


def _stride(windows: Windows) -> float:
    """From the begin of one window to the next [s]; of a single one, its length."""
    begins = windows.track.t[windows.start]
    alone_s = float(windows.lead.max()) * windows.track.h
    return float(np.median(np.diff(begins))) if begins.size > 1 else alone_s * begins.size


def _length(windows: Windows) -> float:
    """How long the voyage is that the windows were taken from [s]."""
    valid = windows.valid.any(0)
    return float(valid.sum()) * _stride(windows)


def block_interval(
    each: Sequence[np.ndarray], before: Sequence[Windows], longest_s: float
) -> tuple[float, float]:
    """95 % about the sum of what the windows of each track say (W,), by resampling blocks as long as the
    longest horizon, or shorter ones where there would be too few; widened as Student's t is for so few."""
    total = float(sum(e.sum() for e in each))
    length = sum(_length(w) for w in before)
    block_s = min(longest_s, length / BLOCKS)
    sums, blocks = np.zeros(RESAMPLES), 0.0
    rng = np.random.default_rng(0)
    for gain, windows in zip(each, before, strict=True):
        there = gain[windows.valid.any(0)] if gain.size == windows.start.size else gain
        if not there.size:
            continue
        block = max(1, round(block_s / max(_stride(windows), 1e-9)))
        sums += _resampled(there, block, rng)
        blocks += there.size / block
    wider = float(stdtrit(max(blocks - 1.0, 1.0), 0.975)) / P95
    low, high = np.quantile(sums, [0.025, 0.975])
    return total + wider * (float(low) - total), total + wider * (float(high) - total)


def _resampled(gain: np.ndarray, block: int, rng: np.random.Generator) -> np.ndarray:
    """(RESAMPLES,) totals of a voyage's gains, drawn in blocks (its end joined to its beginning)."""
    block = min(block, gain.size)
    sums = np.cumsum(np.concatenate([[0.0], gain, gain[: block - 1]]))
    runs = sums[block:] - sums[:-block]
    needed = int(np.ceil(gain.size / block))
    drawn = runs[rng.integers(0, runs.size, (RESAMPLES, needed))].sum(1)
    return np.asarray(drawn * gain.size / (needed * block))

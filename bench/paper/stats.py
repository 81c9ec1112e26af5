"""Intervals and sizes of effect for Tables 4 to 6: bootstrap by single errors as in the paper, and by whole
voyages, as it should be."""

import numpy as np

from bench.paper.lab import Errors

RESAMPLES = 2_000_000  # numbers drawn at a time


def bootstrap(values: np.ndarray, group: np.ndarray, resamples: int, seed: int = 1) -> tuple[float, float]:
    """95 % interval of the mean when whole groups are drawn; give every value its own group for the naive
    one."""
    blocks, index = np.unique(group, return_inverse=True)
    total, count = np.bincount(index, values), np.bincount(index)
    rng, means = np.random.default_rng(seed), []
    for _ in range(0, resamples, step := max(1, RESAMPLES // blocks.size)):
        drawn = rng.integers(blocks.size, size=(min(step, resamples - step * len(means)), blocks.size))
        means.append(total[drawn].sum(1) / count[drawn].sum(1))
    low, high = np.quantile(np.concatenate(means), (0.025, 0.975))
    return float(low), float(high)


def r2(off: np.ndarray, true: np.ndarray) -> float:
    """Pooled over all windows and moments."""
    return float(1.0 - (off**2).sum() / ((true - true.mean()) ** 2).sum())


def r2_interval(
    off: np.ndarray, true: np.ndarray, group: np.ndarray, resamples: int, seed: int = 1
) -> tuple[float, float]:
    """95 % interval of R2 when whole groups are drawn."""
    blocks, index = np.unique(group, return_inverse=True)
    parts = [np.bincount(index, x.sum(1)) for x in (off**2, true**2, true)]
    n = np.bincount(index) * off.shape[1]
    drawn = np.random.default_rng(seed).integers(blocks.size, size=(resamples, blocks.size))
    e, t2, t1, m = (x[drawn].sum(1) for x in (*parts, n))
    low, high = np.quantile(1.0 - e / (t2 - t1**2 / m), (0.025, 0.975))
    return float(low), float(high)


def wilcoxon(ours: np.ndarray, theirs: np.ndarray, group: np.ndarray) -> tuple[float, float]:
    """One-sided p that ours is smaller: of single windows, and of voyage means; 1 where both are the same
    (learning that never acted)."""
    from scipy import stats

    if np.array_equal(ours, theirs):
        return 1.0, 1.0
    _, index = np.unique(group, return_inverse=True)
    means = [np.bincount(index, x) / np.bincount(index) for x in (ours, theirs)]
    alone, together = (
        float(stats.wilcoxon(a, b, alternative="less").pvalue) for a, b in ((ours, theirs), means)
    )
    return alone, together


def cliff(ours: np.ndarray, theirs: np.ndarray) -> float:
    """P(theirs > ours) - P(theirs < ours) over all pairs."""
    order = np.sort(ours)
    below, upto = np.searchsorted(order, theirs, "left"), np.searchsorted(order, theirs, "right")
    return float((below.sum() + upto.sum() - ours.size * theirs.size) / (ours.size * theirs.size))


def summary(e: Errors) -> dict[str, float]:
    return {
        "heading_mae_deg": float(e.heading_deg.mean()),
        "lateral_mae_m": float(e.lateral_m.mean()),
        "r2_heading": r2(e.heading, e.true_heading),
        "r2_lateral": r2(e.lateral, e.true_lateral),
    }

"""Where a normal density is most probable inside a box."""

import numpy as np


def stopped(
    mean: np.ndarray, covariance: np.ndarray, lo: np.ndarray, hi: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(R,) the most probable place of a normal density inside a box, and which numbers stand at its edge: one
    that would leave it stays there, and the others are what they then would be (two that do for each other
    may not stand far out, one inside its box and one outside)."""
    z, held, sd = mean, np.zeros(0, dtype=int), np.sqrt(np.diag(covariance))
    for _ in mean:
        beyond = np.abs(z - np.clip(z, lo, hi)) / sd
        if not beyond.any():
            break
        held = np.append(held, np.argmax(beyond))
        edge = np.clip(z, lo, hi)[held]
        z = mean + covariance[:, held] @ np.linalg.solve(covariance[np.ix_(held, held)], edge - mean[held])
        z[held] = edge
    return z, held

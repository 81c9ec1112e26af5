"""Where a normal density is most probable inside a box, and inside half-spaces."""

import numpy as np
from scipy.optimize import nnls

INSIDE = 1e-9  # by which a half-space may seem left, in widths of priors


def stopped(
    mean: np.ndarray, covariance: np.ndarray, lo: np.ndarray, hi: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(R,) the most probable place of a normal density inside a box, and which numbers stand at its edge:
    one that would leave it stays there, and the others are what they then would be (two that do for each
    other may not stand far out, one inside its box and one outside). All in one unit: `mean`, `lo`, `hi`
    (R,), covariance (R, R)."""
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


def within(
    mean: np.ndarray,
    covariance: np.ndarray,
    box: np.ndarray,
    hull: tuple[np.ndarray, np.ndarray],
) -> np.ndarray:
    """(R,) the same inside the box (2, R) and where rows @ z >= least, of `hull`: (C, R), (C,).

    The least distance in the density's own measure [Lawson & Hanson 1974, ch. 23: LDP by non-negative
    least squares]; where nothing lies inside all of them, the box alone. All in one unit, as in `stopped`."""
    lo, hi = box
    rows, least = hull
    z, _ = stopped(mean, covariance, lo, hi)
    if np.all(rows @ z >= least - INSIDE):
        return z
    A = np.concatenate([rows, np.eye(mean.size), -np.eye(mean.size)])
    b = np.concatenate([least, lo, -hi])
    keep = np.isfinite(b)
    A, b = A[keep], b[keep]
    L = np.linalg.cholesky(covariance)
    G, h = A @ L, b - A @ mean
    size = np.linalg.norm(G, axis=1)
    G, h = G / size[:, None], h / size
    E = np.vstack([G.T, h])
    f = np.zeros(mean.size + 1)
    f[-1] = 1.0
    weight, _ = nnls(E, f, maxiter=30 * E.shape[1])
    rest = E @ weight - f
    if abs(rest[-1]) < 1e-12:
        return z
    return np.clip(mean + L @ (-rest[:-1] / rest[-1]), lo, hi)

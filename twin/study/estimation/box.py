"""Where a normal density is most probable inside a box, and inside half-spaces."""

from collections.abc import Iterator

import numpy as np

INSIDE = 1e-9  # by which a half-space may seem left, in widths of priors
EDGE = 1e-6  # of a box: what is nearer than this to its end was stopped by it


def at_an_end(value: float, lo: float, hi: float, none: float = 0.0, sd: float = 0.0) -> bool:
    """Whether a box stopped a number, or does not hold it; at an end where it is `none` it is only not
    there, and one within two prior widths `sd` of that is as much of an answer as what lies before it."""
    stops = (end for end in (lo, hi) if abs(end - none) > 2.0 * sd)
    return not lo <= value <= hi or any(abs(value - end) <= EDGE * (hi - lo) for end in stops)


def stopped(
    mean: np.ndarray, covariance: np.ndarray, lo: np.ndarray, hi: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(R,) the most probable place of a normal density inside a box, and which numbers stand at its edge:
    one that would leave it stays there, and the others are what they then would be (two that do for each
    other may not stand far out, one inside its box and one outside). All in one unit: `mean`, `lo`, `hi`
    (R,), covariance (R, R)."""
    ((_, z, held),) = stopped_each(mean[None], covariance[None], lo[None], hi[None])
    return z[0], held[0]


def stopped_each(
    mean: np.ndarray, covariance: np.ndarray, lo: np.ndarray, hi: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """The same of S densities of as many numbers each, of each in one unit: `mean`, `lo`, `hi` (S, R),
    covariance (S, R, R).

    Yields them by how many numbers E stand at an edge: which densities (K,), their most probable places
    (K, R) and the numbers that stand there (K, E)."""
    open_, z = np.arange(len(mean)), mean
    held = np.zeros((len(mean), 0), dtype=int)
    sd = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    for _ in range(mean.shape[1]):
        beyond = np.abs(z - np.clip(z, lo[open_], hi[open_])) / sd[open_]
        leaves = beyond.any(axis=1)
        if not leaves.all():
            yield open_[~leaves], z[~leaves], held[~leaves]
        open_, z = open_[leaves], z[leaves]
        held = np.concatenate([held[leaves], beyond[leaves].argmax(axis=1)[:, None]], axis=1)
        if not open_.size:
            return
        z = _held_at_edges(mean[open_], covariance[open_], np.clip(z, lo[open_], hi[open_]), held)
    yield open_, z, held


def _held_at_edges(
    mean: np.ndarray, covariance: np.ndarray, inside: np.ndarray, held: np.ndarray
) -> np.ndarray:
    """(K, R) the most probable place when the numbers `held` (K, E) stand where `inside` (K, R) has them."""
    one, edge = np.arange(len(mean))[:, None], np.take_along_axis(inside, held, axis=1)
    among = covariance[one[:, :, None], held[:, :, None], held[:, None, :]]
    on_all = np.take_along_axis(covariance, held[:, None, :], axis=2)
    off = (edge - np.take_along_axis(mean, held, axis=1))[:, :, None]
    z = mean + (on_all @ np.linalg.solve(among, off))[:, :, 0]
    np.put_along_axis(z, held, edge, axis=1)
    return z


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
    from scipy.optimize import nnls  # heavy, and few voyages ask for it

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

"""How much of a normal density lies inside a box, beside how much of its prior does: for many densities side
by side, of as many numbers each."""

import numpy as np
from scipy.special import log_ndtr

from twin.study.estimation.box import stopped_each


def log_shares_inside(mean: np.ndarray, covariance: np.ndarray, lo: np.ndarray, hi: np.ndarray) -> np.ndarray:
    """(S,) log of (posterior mass inside the box) / (prior mass inside it).

    Of numbers that stand at an edge, what falls off behind it, each by itself (exact for one); of the others
    what is inside one at a time, given those. All in prior widths from where the prior is centred: mean, lo,
    hi (S, R), covariance (S, R, R)."""
    out = -_log_mass(lo, hi).sum(axis=1)
    for some, z, held in stopped_each(mean, covariance, lo, hi):
        if held.shape[1]:
            box = lo[some], hi[some]
            out[some] += _behind_edges(mean[some], covariance[some], *box, z, held)
        else:
            sd = np.sqrt(np.diagonal(covariance[some], axis1=1, axis2=2))
            out[some] += _log_mass((lo[some] - z) / sd, (hi[some] - z) / sd).sum(axis=1)
    return out


def _behind_edges(
    mean: np.ndarray,
    covariance: np.ndarray,
    lo: np.ndarray,
    hi: np.ndarray,
    z: np.ndarray,
    held: np.ndarray,
) -> np.ndarray:
    """(S,) the log mass inside when the numbers `held` (S, E) of each stand at an edge and z (S, R) is the
    most probable place."""
    within, standing = np.arange(len(z))[:, None], held[:, :, None]
    inner = np.linalg.inv(covariance[within[:, :, None], standing, held[:, None, :]])
    off = z[within, held] - mean[within, held]
    cross = covariance[within[:, :, None], np.arange(z.shape[1])[:, None], held[:, None, :]]
    root = np.sqrt(np.diagonal(inner, axis1=1, axis2=2))
    pull = (inner @ off[:, :, None])[:, :, 0]
    fall = np.where(z[within, held] == lo[within, held], 1.0, -1.0) * pull / root
    mass = 0.5 * np.linalg.slogdet(inner)[1] - 0.5 * (off * pull).sum(axis=1)
    mass += (0.5 * fall**2 + log_ndtr(-fall) - np.log(root)).sum(axis=1)
    left = covariance - cross @ inner @ cross.swapaxes(-1, -2)
    free = _others(held, z.shape[1])
    sd = np.sqrt(np.diagonal(left, axis1=1, axis2=2)[within, free])
    ends = [(end[within, free] - z[within, free]) / sd for end in (lo, hi)]
    return mass + _log_mass(*ends).sum(axis=1)


def _others(held: np.ndarray, size: int) -> np.ndarray:
    """(S, size - E) all but the numbers `held` (S, E), in order."""
    standing = np.zeros((len(held), size), dtype=bool)
    np.put_along_axis(standing, held, True, axis=1)
    return np.argsort(standing, axis=1, kind="stable")[:, : size - held.shape[1]]


def _log_mass(lo: np.ndarray, hi: np.ndarray) -> np.ndarray:
    """log of the standard normal's mass between lo and hi, safe far out in either tail."""
    flip = lo > 0.0
    lo, hi = np.where(flip, -hi, lo), np.where(flip, -lo, hi)
    upper, lower = log_ndtr(hi), log_ndtr(lo)
    return upper + np.log1p(-np.exp(np.minimum(lower - upper, -1e-12)))

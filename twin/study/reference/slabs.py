"""Spikes that become slabs: what a posterior becomes when some of its parameters may be something after all,
for many sets of parameters side by side (sets of as many parameters at a time)."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Slabs:
    """Of each of S sets, in prior widths: the posterior of its M parameters and those that were slabs
    before."""

    rows: np.ndarray  # (S, M) which parameters, those of the set first
    mean: np.ndarray  # (S, M)
    covariance: np.ndarray  # (S, M, M)
    change: np.ndarray  # (S,) of the log evidence, without the boxes


def slabs_for(
    z: np.ndarray, covariance: np.ndarray, spike: np.ndarray, at: np.ndarray, own: np.ndarray
) -> Slabs:
    """When the spikes of each set become slabs, a low-rank step away: with D = 1 - 1/spike^2 the change of
    their prior precisions (below zero where a slab is wider), K = I + C D, the mean is z - C D K^-1 z and the
    covariance (C^-1 + D)^-1 = C - C D K^-1 C.

    z (Q,), covariance C (Q, Q): the posterior before; spike (Q,): widths of "not there", in prior widths;
    at (S, R): the parameters of each set; own (H,): those that are slabs already.
    Source: Woodbury's identity, Golub & Van Loan (2013) Matrix computations, sec. 2.1.4."""
    both = np.concatenate([at, np.broadcast_to(own, (len(at), own.size))], axis=1)
    D = 1.0 - 1.0 / spike[at] ** 2
    K = np.eye(at.shape[1]) + _block(covariance, at, at) * D[:, None, :]
    there = z[at][:, :, None]
    pulled = D[:, :, None] * np.linalg.solve(K, there)
    cross = _block(covariance, both, at)
    change = (
        -0.5 * (there.swapaxes(-1, -2) @ pulled)[:, 0, 0]
        - 0.5 * np.linalg.slogdet(K)[1]
        + np.log(spike[at]).sum(axis=1)
    )
    lost = cross @ (D[:, :, None] * np.linalg.solve(K, cross.swapaxes(-1, -2)))
    return Slabs(both, z[both] - (cross @ pulled)[:, :, 0], _block(covariance, both, both) - lost, change)


def _block(M: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """(S, R, C) of M (Q, Q) the block of each set."""
    return M[rows[:, :, None], columns[:, None, :]]

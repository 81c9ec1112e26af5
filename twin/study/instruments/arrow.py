"""A least-squares problem of many states in the order of time and a few numbers that all of them share (an
arrow matrix).

    [ H_ss  H_sp ] [ds]   [g_s]        A = H_pp - H_ps H_ss^-1 H_sp,   g = g_p - H_ps H_ss^-1 g_s
    [ H_ps  H_pp ] [dp] = [g_p]        dp = (A + prior)^-1 (g - prior's pull),   ds = H_ss^-1 (g_s - H_sp dp)
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve, cho_solve_banded, cholesky_banded
from scipy.sparse import csr_array, vstack

RIDGE = 1e-13  # of its own diagonal: what a state gets of which too little is known for the arithmetic


@dataclass(frozen=True)
class Block:
    """Readings or priors of one kind: residuals r (n,), what a unit of each state (n, S) and of each shared
    number (n, P) does to what is predicted, and the weight of each row in its kind (1, or 0 of an
    outlier)."""

    name: str
    r: np.ndarray
    J: csr_array
    G: np.ndarray
    weight: np.ndarray


@dataclass(frozen=True)
class ArrowReduced:
    """The states eliminated: A (P, P), g (P,), and what finds them again. Fast states (a band) come first,
    the few slow ones behind them."""

    A: np.ndarray
    g: np.ndarray
    log_det: float
    solve: Callable[[np.ndarray], np.ndarray]  # H_ss^-1 b
    cross: np.ndarray  # H_ss^-1 H_sp
    mean: np.ndarray  # H_ss^-1 g_s

    def states(self, step: np.ndarray) -> np.ndarray:
        """(S,) the step of the states that goes with this step of the shared numbers."""
        return self.mean - self.cross @ step


def reduce(blocks: Sequence[Block], sd: dict[str, float], fast: int) -> ArrowReduced:
    """Normal equations of all blocks, each with its scatter, and the states (`fast` of them in a band) taken
    out of them."""
    J, whole = vstack([b.J for b in blocks], "csr"), np.concatenate([b.G for b in blocks])
    at = np.flatnonzero(whole.any(axis=0))  # the others change nothing
    G, P = whole[:, at], whole.shape[1]
    w = np.concatenate([b.weight / sd[b.name] ** 2 for b in blocks])
    scaled, r = J.copy(), np.concatenate([b.r for b in blocks])
    scaled.data *= np.repeat(w, np.diff(J.indptr))
    cross, g_s = scaled.T @ G, scaled.T @ r
    H_pp, g_p = G.T @ (w[:, None] * G), G.T @ (w * r)
    solve, log_det = _solver((scaled.T @ J).tocsr(), fast)
    solved = solve(np.column_stack([cross, g_s]))
    A, g, inner, mean = np.zeros((P, P)), np.zeros(P), np.zeros((J.shape[1], P)), solved[:, -1]
    inner[:, at] = solved[:, :-1]
    A[np.ix_(at, at)] = H_pp - cross.T @ inner[:, at]
    g[at] = g_p - cross.T @ mean
    return ArrowReduced(0.5 * (A + A.T), g, log_det, solve, inner, mean)


def _solver(H: csr_array, fast: int) -> tuple[Callable[[np.ndarray], np.ndarray], float]:
    """What solves H x = b, and log |H|: the band first, then the slow states that are tied to all of it."""
    band = _cholesky(H[:fast, :fast].tocoo())
    beside = H[:fast, fast:].toarray()
    reach = cho_solve_banded((band, True), beside, check_finite=False)
    slow = H[fast:, fast:].toarray() - beside.T @ reach
    slow[np.diag_indices_from(slow)] *= 1.0 + RIDGE
    factor = cho_factor(slow, lower=True)

    def solve(b: np.ndarray) -> np.ndarray:
        y = cho_solve_banded((band, True), b[:fast], check_finite=False)
        z = cho_solve(factor, b[fast:] - beside.T @ y)
        return np.concatenate([y - reach @ z, z])

    return solve, 2.0 * float(np.log(band[0]).sum() + np.log(np.diag(factor[0])).sum())


def _cholesky(H: Any) -> np.ndarray:
    row, col, data = H.row, H.col, H.data
    low = row >= col
    row, col, data = row[low], col[low], data[low]
    width = int((row - col).max()) + 1
    band = np.zeros((width, H.shape[0]))
    np.add.at(band, (row - col, col), data)
    try:
        return np.asarray(cholesky_banded(band, lower=True, check_finite=False))
    except LinAlgError:
        band[0] *= 1.0 + RIDGE
        return np.asarray(cholesky_banded(band, lower=True, check_finite=False))


def freedom(
    blocks: Sequence[Block],
    sd: dict[str, float],
    found: ArrowReduced,
    covariance: np.ndarray,
    rng: np.random.Generator,
) -> dict[str, float]:
    """How many numbers each block was bent to: the trace of its share of what is known (Hutchinson's
    estimate; exact in small blocks). `sd`: scatter of each kind, in the units of its residuals; `found`:
    these blocks, reduced; `covariance` (P, P) of the shared numbers, in their own units; `rng` draws the
    signs."""
    names, forms = [], []
    for b in blocks:
        n = b.r.size
        z = np.eye(n) if n <= 48 else rng.choice([-1.0, 1.0], (n, 4))
        forms.append((b, z * (np.sqrt(b.weight) / sd[b.name])[:, None], 1.0 if n <= 48 else 4.0))
        names.append(b.name)
    states = np.column_stack([b.J.T @ z for b, z, _ in forms])
    shared = np.column_stack([b.G.T @ z for b, z, _ in forms])
    shared -= found.cross.T @ states
    each = (states * found.solve(states)).sum(axis=0) + (shared * (covariance @ shared)).sum(axis=0)
    ends = np.cumsum([z.shape[1] for _, z, _ in forms])
    return {
        name: float(part.sum()) / form[2]
        for name, part, form in zip(names, np.split(each, ends[:-1]), forms, strict=True)
    }

"""What one voyage, or some of a fit's voyages, say of each number of the instruments: the fit's normal
equations of these alone, without another fit.

The stream of each voyage is its own and is eliminated; what the ship drifts in a turn stays beside the
faults. In prior widths W, log likelihood = b z - z A z/2 from none, K = A + 1:
    mean = K^-1 b,   log evidence = (b K^-1 b - log|K|)/2
and of one number, its own prior taken off again: 1/sd^2 = 1/s^2 - 1, value = (m/s^2) sd^2.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from twin.study.instruments.kinematic_fit import MINE, SHARED, KinematicFit, columns
from twin.study.instruments.unknowns import FAULTS, UNKNOWNS
from twin.study.reference.between import BetweenVoyages

BESIDE = "drift"  # what is never left out and is the ship's, beside the stream, which is a voyage's


@dataclass(frozen=True)
class KinematicEquations:
    """Of the numbers in rows `at` of UNKNOWNS: prior widths (k,), A (k, k) and b (k,) in these."""

    at: tuple[int, ...]
    width: np.ndarray
    A: np.ndarray
    b: np.ndarray

    def rows(self, fault: str) -> list[int]:
        """Where the numbers of a fault stand."""
        return [i for i, j in enumerate(self.at) if UNKNOWNS[j].fault == fault]

    def between(self) -> BetweenVoyages:
        """The same, as what differs between voyages is found (reference/between.py)."""
        return BetweenVoyages(self.A, self.b, 0.0)

    def number(self, i: int) -> tuple[float, float] | None:
        """(value, sd) of one number as the readings alone have it, beside the others; None where they say
        less of it than what was believed before."""
        covariance = np.linalg.inv(self.A + np.eye(self.b.size))
        s2, m = float(covariance[i, i]), float(covariance[i] @ self.b)
        if s2 > 0.5:
            return None
        sd2 = 1.0 / (1.0 / s2 - 1.0)
        return m / s2 * sd2 * float(self.width[i]), float(np.sqrt(sd2) * self.width[i])

    def log_bayes_factor(self, fault: str) -> float:
        """Of the fault being there, the others of this set being there either way."""
        own = self.rows(fault)
        return self._evidence(range(self.b.size)) - self._evidence(
            [i for i in range(self.b.size) if i not in own]
        )

    def _evidence(self, rows: Collection[int]) -> float:
        k = np.array(list(rows), int)
        K, b = self.A[np.ix_(k, k)] + np.eye(k.size), self.b[k]
        return 0.5 * float(b @ np.linalg.solve(K, b)) - 0.5 * float(np.linalg.slogdet(K)[1])


def equations(fit: KinematicFit, voyages: Sequence[int], faults: Collection[str]) -> KinematicEquations:
    """Of these voyages of the fit together, with these faults open and every other one not there."""
    named = [i for i in SHARED if UNKNOWNS[i].fault in (*faults, BESIDE)]
    size = len(named)
    A, b = np.zeros((size, size)), np.zeros(size)
    for v in voyages:
        W, theta, red = fit.width[columns(v)], fit.theta[v], fit.reduced[v]
        free = [*named, *MINE]
        scale = W[free]
        H = red.A[np.ix_(free, free)] * np.outer(scale, scale)
        pull = (red.g[free] + red.A[free] @ theta) * scale
        own = slice(size, None)
        reach = np.linalg.solve(H[own, own] + np.eye(len(MINE)), np.column_stack([H[own, :size], pull[own]]))
        A += H[:size, :size] - H[:size, own] @ reach[:, :size]
        b += pull[:size] - H[:size, own] @ reach[:, size]
    return KinematicEquations(tuple(named), fit.prior()[named], _positive(A), b)


def _positive(A: np.ndarray) -> np.ndarray:
    size, axes = np.linalg.eigh(0.5 * (A + A.T))
    return np.asarray((axes * np.maximum(size, 0.0)) @ axes.T)


def tellable(faults: Collection[str]) -> tuple[str, ...]:
    """Faults in the order of their table."""
    return tuple(f for f in FAULTS if f in faults)

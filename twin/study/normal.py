"""Normal equations of whitened innovations: what is kept of a voyage once it has been filtered."""

from dataclasses import dataclass

import numpy as np

FOLD = 16  # steps whose innovations are multiplied out together


@dataclass(frozen=True)
class Normal:
    """One for each segment: epsilon = e - G theta, A = G'G, b = G'e."""

    A: np.ndarray  # (S, P, P)
    b: np.ndarray  # (S, P)
    ee: np.ndarray  # (S,)
    logdet: np.ndarray  # (S,) sum of log det of the innovations' covariance
    count: np.ndarray  # (S,) readings
    energy: np.ndarray  # (S, 8) sum of squares by reading
    where: tuple[tuple[int, int, int], ...]  # (track, first step, last step)

    def total(self) -> tuple[np.ndarray, np.ndarray, float]:
        return self.A.sum(0), self.b.sum(0), float(self.ee.sum())

    def only(self, keep: np.ndarray) -> "Normal":
        """Some of the segments."""
        rows = np.flatnonzero(keep)
        return Normal(
            self.A[rows], self.b[rows], self.ee[rows], self.logdet[rows], self.count[rows], self.energy[rows],
            tuple(self.where[i] for i in rows),
        )  # fmt: skip


class Sums:
    """Running sums of whitened innovations by segment."""

    def __init__(self, S: int, P: int) -> None:
        self.M = np.zeros((S, 1 + P, 1 + P))
        self.logdet, self.count, self.energy = np.zeros(S), np.zeros(S), np.zeros((S, 8))
        self.held: list[np.ndarray] = []

    def add(self, white: np.ndarray, L: np.ndarray, here: np.ndarray) -> None:
        """One step: innovations with their tangents (S, 8, 1 + P), the root of their covariance, and which readings there were (S, 8)."""
        self.held.append(white)
        if len(self.held) == FOLD:
            self._fold()
        self.logdet += 2.0 * np.log(np.diagonal(L, axis1=1, axis2=2)).sum(1)
        self.count += here.sum(1)
        self.energy += white[:, :, 0] ** 2 * here

    def _fold(self) -> None:
        if self.held:
            W = np.concatenate(self.held, axis=1, dtype=float)
            self.M += W.transpose(0, 2, 1) @ W
            self.held = []

    def normal(self, where: tuple[tuple[int, int, int], ...]) -> Normal:
        self._fold()
        M = self.M
        return Normal(M[:, 1:, 1:], -M[:, 1:, 0], M[:, 0, 0], self.logdet, self.count, self.energy, where)

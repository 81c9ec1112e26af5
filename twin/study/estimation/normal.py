"""Normal equations of whitened innovations: what is kept of a voyage once it has been filtered."""

from dataclasses import dataclass, replace

import numpy as np

from twin.study.estimation.filters import LIGHT

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
        """A (P, P), b (P,) and ee of all segments together, per unit of the unknowns."""
        return self.A.sum(0), self.b.sum(0), float(self.ee.sum())

    def voyages(self) -> np.ndarray:
        """(S,) to which voyage each segment belongs, by its place [count]; of a single one, to which half."""
        of = np.array([track for track, _, _ in self.where])
        return of if np.unique(of).size > 1 else (np.arange(of.size) * 2) // max(of.size, 1)

    def in_terms_of(self, B: np.ndarray) -> "Normal":
        """The same in other unknowns (Q,), in prior widths, of which these are B (P, Q) times them."""
        return replace(self, A=B.T @ self.A @ B, b=self.b @ B)

    def only(self, keep: np.ndarray) -> "Normal":
        """Some of the segments. `keep` (S,): mask."""
        rows = np.flatnonzero(keep)
        return Normal(
            self.A[rows],
            self.b[rows],
            self.ee[rows],
            self.logdet[rows],
            self.count[rows],
            self.energy[rows],
            tuple(self.where[i] for i in rows),
        )


class Sums:
    """Running sums of whitened innovations by noise model and segment: W and S of them, with P unknowns.
    `rows` (K,): which of the READINGS there are."""

    def __init__(self, W: int, S: int, P: int, rows: np.ndarray) -> None:
        self.M, self.logdet, self.energy = (
            np.zeros((W, S, 1 + P, 1 + P)),
            np.zeros((W, S)),
            np.zeros((W, S, 8)),
        )
        # the last steps with readings, so many; of a segment without one, nothing
        self.held, self.count = np.zeros((W, S, FOLD, rows.size, 1 + P), LIGHT), 0
        self.roots = np.ones((W, S, FOLD, rows.size))
        self.rows = rows

    def add(self, white: np.ndarray, root: np.ndarray, some: np.ndarray | slice) -> None:
        """One step of some segments (R,): innovations with their tangents (W, R, K, 1 + P) in units of their
        standard deviations, and the diagonal of the root of their covariance (W, R, K)."""
        if not white.size:
            return
        self.held[:, some, self.count], self.roots[:, some, self.count] = white, root
        self.count += 1
        if self.count == FOLD:
            self._fold()

    def _fold(self) -> None:
        white = self.held.reshape(*self.logdet.shape, -1, self.held.shape[-1])
        self.M += white.swapaxes(-1, -2) @ white
        self.logdet += 2.0 * np.log(self.roots).sum((2, 3))
        self.energy[..., self.rows] += np.square(self.held[..., 0]).sum(2)
        self.held[...], self.roots[...], self.count = 0.0, 1.0, 0

    def normals(self, here: np.ndarray, where: tuple[tuple[int, int, int], ...]) -> list[Normal]:
        """One for each noise model; `here` (T, S, K): which readings there were. In units of the unknowns."""
        self._fold()
        count = here.sum((0, 2)).astype(float)
        told = zip(self.M, self.logdet, self.energy, strict=True)
        return [
            Normal(M[:, 1:, 1:], -M[:, 1:, 0], M[:, 0, 0], logdet, count, energy, where)
            for M, logdet, energy in told
        ]

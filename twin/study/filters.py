"""Many Kalman filters side by side, each with its tangents: every segment of every track, under every floor.

The state is delta = (x, y, psi, u, v, r), b and c as in innovations.py, and in a sea that was seen to work the waves' accelerations with
what carries them on. X holds its mean and how that depends on each unknown, C its covariance; both are corrected by the readings of a
step, and carried on to the next.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

MOTION, PLACE, SPEEDS, SLOW, FLOW = slice(0, 6), slice(0, 2), slice(3, 6), slice(6, 9), slice(9, 11)  # places in the state
BENDS = [2, 3, 4, 5, 9, 10]  # what accelerations depend on: heading, velocities, the water's own
WAVE = slice(11, 14)  # of each axis; behind it what carries the waves on
STATES, AT_SEA = 11, 23
DIAGONAL = np.arange(AT_SEA)
SWINGING = tuple(product(enumerate(slice(a, a + 3) for a in range(STATES, AT_SEA, 3)), repeat=2))  # pairs of waves' states: number, place of all axes
LIGHT = np.float32  # of the many tangents; covariances and sums need more


@dataclass(frozen=True)
class Stretches:
    """Segments begun together, of T steps and S of them; what is not there (a reading, a segment's end) is NaN in e."""

    F: np.ndarray  # (T, S, n, n): n is STATES, or AT_SEA
    H: np.ndarray  # (T, S, 8, n)
    e: np.ndarray  # (T, S, 8)
    defect: np.ndarray  # (T, S, 6)
    turn: np.ndarray  # (T, S, 3, 3) body velocities to d(x, y, psi)/dt
    A: np.ndarray  # (T, S, 3, P)
    R: np.ndarray  # (T, S, 8, P)
    turns: dict[int, np.ndarray]  # column -> (T, S, 8, 8)
    bends: np.ndarray | None = None  # (T, S, 3, 6, P)
    fresh: np.ndarray | None = None  # (T, S, 3, 4, 4) of each axis' waves, the share of variance that is new after a step


@dataclass(frozen=True)
class Noise:
    """Of each filter: its segment, its step [s], and variances; of b and c also the share that is renewed in one step."""

    row: np.ndarray  # (K,) places among the segments
    h: np.ndarray  # (K,)
    reading: np.ndarray  # (T, K, 8)
    fast: np.ndarray  # (K, 3) of velocity, in one step
    slow: np.ndarray  # (T, K, 3) of b
    flow: np.ndarray  # (K,) of c
    wander: np.ndarray  # (K,) of the place shown, in one step
    new_b: np.ndarray  # (K,)
    new_c: np.ndarray  # (K,)
    wave: np.ndarray | None = None  # (T, K, 3) of the waves' accelerations


class Filters:
    """K filters at the same step of their segments."""

    def __init__(self, told: Stretches, noise: Noise, C: np.ndarray) -> None:
        self.told, self.noise, self.C = told, noise, C
        self.X = np.zeros((*C.shape[:2], 1 + told.A.shape[-1]), LIGHT)
        self.F, self.H, self.turn = (x.astype(LIGHT) for x in (told.F, told.H, told.turn))

    def correct(self, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """By the readings of step k; gives the whitened innovations with their tangents (K, 8, 1 + P), the root of their covariance, and
        which readings there were (K, 8)."""
        told, row = self.told, self.noise.row
        here = np.isfinite(told.e[k])[row]
        E = -(self.H[k][row] @ self.X)
        shown = E[:, :, :1].copy()
        for column, turn in told.turns.items():
            E[:, :, 1 + column] += (turn[k][row] @ shown)[:, :, 0]
        E[:, :, 0] += np.where(here, told.e[k][row], 0.0)
        E[:, :, 1:] -= told.R[k][row]
        E *= here[:, :, None]
        H = told.H[k][row] * here[:, :, None]
        HC = H @ self.C
        S = HC @ H.transpose(0, 2, 1)
        S[:, DIAGONAL[:8], DIAGONAL[:8]] += np.where(here, self.noise.reading[k], 1.0)
        L = np.linalg.cholesky(S)
        inverse = np.linalg.inv(L)
        white, V = inverse.astype(LIGHT) @ E, inverse @ HC
        self.X += V.transpose(0, 2, 1).astype(LIGHT) @ white
        self.C -= V.transpose(0, 2, 1) @ V
        return white, L, here

    def advance(self, k: int) -> None:
        """From step k to the next: by the linear ship, what the unknowns push, and noise."""
        told, noise, row = self.told, self.noise, self.noise.row
        F, h = told.F[k][row], noise.h[:, None, None].astype(LIGHT)
        push = told.A[k][row]
        if told.bends is not None:
            push = push + np.einsum("kaip,ki->kap", told.bends[k][row], self.X[:, BENDS, 0])
        push = h * push
        self.X = self.F[k][row] @ self.X
        self.X[:, MOTION, 0] += told.defect[k][row]
        self.X[:, SPEEDS, 1:] += push
        self.X[:, 0:3, 1:] += 0.5 * h * (self.turn[k][row] @ push)
        self.C = F @ self.C @ F.transpose(0, 2, 1)
        slow, flow = noise.new_b[:, None] * noise.slow[k], (noise.new_c * noise.flow)[:, None]
        for part, variance in ((PLACE, noise.wander[:, None]), (SPEEDS, noise.fast), (SLOW, slow), (FLOW, flow)):
            self.C[:, DIAGONAL[part], DIAGONAL[part]] += variance
        if told.fresh is not None and noise.wave is not None:
            for (i, a), (j, b) in SWINGING:
                self.C[:, DIAGONAL[a], DIAGONAL[b]] += told.fresh[k][row][:, :, i, j] * noise.wave[k]

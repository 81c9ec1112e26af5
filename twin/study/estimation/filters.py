"""Many Kalman filters side by side, each with its tangents: every segment of every track, under every noise
model.

The state is delta = (x, y, psi, u, v, r), b and c as in innovations.py, and in a sea that was seen to work
the waves' accelerations with what carries them on. X holds its mean and how that depends on each unknown, C
its covariance; both are corrected by the readings of a step, and carried on to the next. All that is the same
at every step is made ready before the first."""

from dataclasses import dataclass

import numpy as np

from twin.errors import DataError
from twin.num import num

# places in the state
MOTION, PLACE, SPEEDS, SLOW, FLOW = slice(0, 6), slice(0, 2), slice(3, 6), slice(6, 9), slice(9, 11)
BENDS = [2, 3, 4, 5, 9, 10]  # what accelerations depend on: heading, velocities, the water's own
STATES = 11
# in a sea; WAVE is what pushes it in each axis
SHIP, WAVE, WAVES = slice(0, STATES), slice(11, 14), slice(11, 23)
ERROR = slice(-2, None)  # behind all others, where a receiver errs: north, east
HEADING = 2
GROUND = slice(3, 5)  # readings of velocity over ground
IN_BLOCKS_FROM = 12  # triangles: of fewer, a general inverse is faster
LIGHT = np.float32  # of the many tangents; covariances and sums need more


@dataclass(frozen=True)
class Stretches:
    """Segments begun together, of T steps and S of them, with K readings at most (of the 8 those that there
    are at all; all where a receiver errs). What is not there (a reading, a segment's end) shows nothing: its
    rows are zero."""

    F: np.ndarray  # (T, S, 11, 11)
    H: np.ndarray  # (T, S, K, 11): no instrument shows a wave by itself
    here: np.ndarray  # (T, S, K) which readings there were
    # (T, S, K, 1 + P) measured less read along the smooth motion, and less what one of each unknown makes of
    # it
    shown: np.ndarray
    # (T, S, 6, 1 + P) what a step adds to the motion: the model's defect, and what one of each unknown pushes
    pushed: np.ndarray
    spread: np.ndarray  # (T, S, 6, 3) accelerations to what they add to the motion in a step
    turned: np.ndarray  # (C,) columns of faulty instruments that turn what is read
    turns: np.ndarray  # (T, S, C K, K) by how much
    bends: np.ndarray | None = None  # (T, S, 3, 6, P)
    swing: np.ndarray | None = None  # (T, S, 12, 12) what takes the waves a step on
    # (T, S, 2, 2) from north and east to the readings of velocity over ground, where a receiver errs
    erring: np.ndarray | None = None


@dataclass(frozen=True)
class NoiseVariances:
    """Of every noise model (W) and every segment: variances."""

    reading: np.ndarray  # (T, W, S, K)
    new: np.ndarray  # (T, W, S, 11) of each of the ship's states, in one step
    waves: np.ndarray | None = None  # (T, S, 12, 12) of the waves' own, in one step
    error: "ReceiverError | None" = None


@dataclass(frozen=True)
class ReceiverError:
    """Of a velocity that a receiver shows beside the true one, and that moves its place along: how much of it
    a step of h [s] leaves, and the variance [m2/s2] of what is new in it."""

    h: np.ndarray  # (S,)
    left: np.ndarray  # (W, S)
    new: np.ndarray  # (W, S)


class RunsAway(DataError, np.linalg.LinAlgError):
    """Between two readings the model runs so far off that no covariance in double precision holds it: for a
    search, no place to step to; for a user, unusable data."""


class Filters:
    """A filter for every noise model and segment, all at the same step; begun with the covariance C (W, S,
    n, n), n being 11, or 23 at sea."""

    def __init__(self, stretches: Stretches, noise: NoiseVariances, C: np.ndarray) -> None:
        self.stretches, self.noise, self.C = stretches, noise, C
        self.X = np.zeros((*C.shape[:3], stretches.shown.shape[-1]), LIGHT)
        self.H, self.unread = stretches.H.astype(LIGHT), np.where(stretches.here[:, None], noise.reading, 1.0)
        self.read = [_which(there.any(-1)) for there in stretches.here]
        self.turned = 1 + stretches.turned
        self.on = _On(stretches.F, stretches.swing, noise.error)
        self.light = _On(
            stretches.F.astype(LIGHT),
            None if stretches.swing is None else stretches.swing.astype(LIGHT),
            noise.error,
        )

    def correct(self, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray | slice]:
        """By the readings of step k; gives the innovations with their tangents (W, R, K, 1 + P), in
        standard deviations, the diagonal of the root of their covariance (W, R, K), and which R of the
        segments had a reading; the others stay as they are. RunsAway where their covariance is none."""
        some = self.read[k]
        if isinstance(some, slice):
            return *self._corrected(k, some, self.X, self.C), some
        X, C = self.X[:, some], self.C[:, some]
        read = self._corrected(k, some, X, C) if some.size else (X[..., :0, :], C[..., :0, 0])
        self.X[:, some], self.C[:, some] = X, C
        return *read, some

    def _corrected(
        self, k: int, some: np.ndarray | slice, X: np.ndarray, C: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same of some segments, whose mean X and covariance C are corrected in place."""
        stretches, H, shown = self.stretches, self.stretches.H[k][some], self.stretches.shown[k][some]
        erring = None if stretches.erring is None else stretches.erring[k][some]
        E = shown - self.H[k][some] @ X[..., SHIP, :]
        if erring is not None:
            E[..., GROUND, :] -= erring.astype(LIGHT) @ X[..., ERROR, :]
        if self.turned.size:
            more = stretches.turns[k][some] @ (E[..., :1] - shown[..., :1])
            E[..., self.turned] += more.reshape(*E.shape[:2], -1, E.shape[2]).swapaxes(-1, -2)
        HC = H @ C[..., SHIP, :]
        if erring is not None:
            HC[..., GROUND, :] += erring @ C[..., ERROR, :]
        S = HC[..., SHIP] @ H.swapaxes(-1, -2)
        if erring is not None:
            S[..., GROUND] += HC[..., ERROR] @ erring.swapaxes(-1, -2)
        _diagonal(S)[...] += self.unread[k][:, some]
        try:
            L = np.linalg.cholesky(S)
        except np.linalg.LinAlgError:
            raise self._runs_away(k) from None
        inverse = lower_inverse(L)
        white, V = inverse.astype(LIGHT) @ E, inverse @ HC
        X += V.swapaxes(-1, -2).astype(LIGHT) @ white
        C -= V.swapaxes(-1, -2) @ V.copy()  # a product with itself takes BLAS twice as long
        return white, _diagonal(L)

    def advance(self, k: int) -> None:
        """From step k to the next: by the linear ship, what the unknowns push, and noise."""
        stretches = self.stretches
        bent = (
            None
            if stretches.bends is None
            else stretches.spread[k] @ np.einsum("kaip,wki->wkap", stretches.bends[k], self.X[..., BENDS, 0])
        )
        self.X = self.light(k, self.X)
        self.X[..., MOTION, :] += stretches.pushed[k]
        if bent is not None:
            self.X[..., MOTION, 1:] += bent
        # No reading corrects what rounding makes asymmetric of a covariance, and it would grow as an unstable
        # ship does. Source: Maybeck (1979) Stochastic models, estimation, and control, vol. 1, ch. 7.
        C = self.on(k, self.on(k, self.C).swapaxes(-1, -2))
        self.C = 0.5 * (C + C.swapaxes(-1, -2))
        _diagonal(self.C)[..., SHIP] += self.noise.new[k]
        if self.noise.waves is not None:
            self.C[..., WAVES, WAVES] += self.noise.waves[k]
        if self.noise.error is not None:
            _diagonal(self.C)[..., ERROR] += self.noise.error.new[..., None]

    def _runs_away(self, k: int) -> RunsAway:
        growth = np.abs(np.linalg.eigvals(self.stretches.F[max(k - 1, 0)])).max()
        return RunsAway(
            f"the fitted model runs away: what it is off by grows up to {num(growth, 3)} times in a time "
            "step, so nothing can be told from these voyages. Check mass, yaw inertia and actuators in the "
            "ship file and what the recording says of them; give more voyages, or readings without long "
            "gaps."
        )


class _On:
    """What takes states a step on: the ship by F, pushed by the waves as by what is slow; the waves by
    themselves; what a receiver errs by moves its place, and fades."""

    def __init__(self, F: np.ndarray, swing: np.ndarray | None, error: "ReceiverError | None") -> None:
        self.F, self.swing, self.pushed = F, swing, F[..., SLOW].copy()
        self.pushed[..., SLOW, :] = 0.0
        # by what a receiver's error moves its place in a step, and how much of it is left
        self.error: tuple[np.ndarray, ...] = (
            () if error is None else tuple(x[..., None, None].astype(F.dtype) for x in (error.h, error.left))
        )

    def __call__(self, k: int, M: np.ndarray) -> np.ndarray:
        """Of M (W, S, n, ...) at step k."""
        parts = [self.F[k] @ M[..., SHIP, :]]
        if self.swing is not None:
            parts[0] += self.pushed[k] @ M[..., WAVE, :]
            parts.append(self.swing[k] @ M[..., WAVES, :])
        if self.error:
            h, left = self.error
            parts[0][..., PLACE, :] += h * M[..., ERROR, :]
            parts.append(left * M[..., ERROR, :])
        return np.concatenate(parts, axis=-2) if len(parts) > 1 else parts[0]


def _which(there: np.ndarray) -> np.ndarray | slice:
    """The places where `there` (S,) holds: all of them as a slice, which copies nothing."""
    return slice(None) if there.all() else np.flatnonzero(there)


def lower_inverse(L: np.ndarray) -> np.ndarray:
    """The inverses (..., n, n) of lower triangles `L` (..., n, n), in units of one over theirs: blocks twice
    as large each time, of all at once. A third of what a general inverse takes for some hundred of them; of a
    few, that one takes a third. Source: Golub & Van Loan (2013) Matrix computations, sec. 3.1."""
    if L.size < IN_BLOCKS_FROM * L.shape[-1] ** 2:
        return np.linalg.inv(L)
    n, out = L.shape[-1], np.zeros_like(L)
    one = _diagonal(out)
    np.divide(1.0, _diagonal(L), out=one)
    # blocks of one by one are numbers: all pairs of them at once
    under = _diagonal(L[..., 1:, :-1])[..., ::2]
    np.multiply(-(one[..., 1::2] * under), one[..., : n - 1 : 2], out=_diagonal(out[..., 1:, :-1])[..., ::2])
    size = 2
    while size < n:
        for a in range(0, n - size, 2 * size):
            above, below = slice(a, a + size), slice(a + size, min(a + 2 * size, n))
            out[..., below, above] = -(out[..., below, below] @ L[..., below, above]) @ out[..., above, above]
        size *= 2
    return out


def _diagonal(M: np.ndarray) -> np.ndarray:
    """(..., n) the diagonals of (..., n, n), to be written to: a view."""
    out = M.diagonal(0, -2, -1)
    out.flags.writeable = True
    return out

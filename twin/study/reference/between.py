"""What differs from voyage to voyage: how far the core of one voyage is from the core of the next.

A core whose form is only roughly right is another one in a gentle zigzag than in a hard turn. Within a voyage
that error has one sign, so that the longer the voyage the more surely it is taken for an effect. It is found
as such: every reference voyage has numbers of its own; those scatter about the ship's (by a share of their
priors' widths) which make each voyage clearly more probable given the others; those that may do so count by
how probable that is. A random-effects model: Pinheiro & Bates (2000) Mixed-effects models, ch. 2; variances
one at a time where the score is steepest: Rao (1948)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from twin.study.estimation.innovations import Normal

SHARES = (0.1, 0.2, 0.4, 0.8, 1.6)
FEW = 6  # numbers that are tried in each round
DIFFERENT_LOG_PROBABILITY = 5.0  # log probability by which voyages must differ


@dataclass(frozen=True)
class BetweenVoyages:
    """What one voyage says in prior widths, tempered: ee - 2 b'z + z'Az for a misfit, half of it a log
    probability."""

    A: np.ndarray  # (P, P)
    b: np.ndarray  # (P,)
    ee: float

    def of_all(self, scatter: np.ndarray) -> "BetweenVoyages":
        """The same of the ship's own numbers, when this voyage's are scattered about them (`scatter` (P,):
        variances)."""
        blur = np.eye(len(self.b)) + self.A * scatter
        both = np.linalg.solve(blur, np.column_stack([self.A, self.b]))
        return BetweenVoyages(both[:, :-1], both[:, -1], self.ee)

    def log_probability(self, mean: np.ndarray, covariance: np.ndarray) -> float:
        """Of the voyage, up to a constant, when its numbers are as likely as a normal distribution says.
        `mean` (P,), `covariance` (P, P)."""
        off = self.b - self.A @ mean
        blur = np.eye(len(off)) + self.A @ covariance
        misfit = self.ee - 2.0 * float(self.b @ mean) + float(mean @ self.A @ mean)
        return -0.5 * (
            misfit - float(off @ covariance @ np.linalg.solve(blur, off)) + float(np.linalg.slogdet(blur)[1])
        )

    def score(self, mean: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(2, P) how log probability grows with the variance of each number, and how much of that is chance
        (Fisher information)."""
        blur = np.eye(len(self.b)) + self.A @ covariance
        pull, weight = np.linalg.solve(blur, self.b - self.A @ mean), np.diag(np.linalg.solve(blur, self.A))
        return 0.5 * (pull**2 - weight), 0.5 * weight**2


def voyages(normal: Normal, sd: np.ndarray, temper: float) -> list[BetweenVoyages]:
    """Each voyage by itself; a single one in two halves. `sd` (P,): the priors' widths, in the unknowns'
    own units."""
    of, out = normal.voyages(), []
    for voyage in np.unique(of):
        A, b, ee = normal.only(of == voyage).total()
        out.append(BetweenVoyages(A * np.outer(sd, sd) / temper, b * sd / temper, ee / temper))
    return out


def ship_of(
    told: Sequence[BetweenVoyages], scatter: np.ndarray, pull: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Mean and covariance of the ship's own numbers, from voyages that are scattered about them, and of
    priors (precision one). `scatter` and `pull` (P,), mean (P,), covariance (P, P), in prior widths."""
    confounded = [t.of_all(scatter) for t in told]
    covariance = np.linalg.inv(np.eye(pull.size) + sum(t.A for t in confounded))
    covariance = 0.5 * (covariance + covariance.T)
    return covariance @ (pull + sum(t.b for t in confounded)), covariance


def scattered(
    told: Sequence[BetweenVoyages], pull: np.ndarray, usual: np.ndarray | None = None
) -> np.ndarray:
    """(P,) variance of each number from voyage to voyage, in prior widths squared: `usual` (P,) for all but
    those that clearly differ by more, and the expected variance of those that may; None: zero."""
    least = np.zeros_like(pull) if usual is None else usual
    scatter = least
    if len(told) < 2:
        return scatter
    best = _foretold(told, scatter, pull)
    while True:
        trials = [
            _with(scatter, i, share**2)
            for i in _steepest(told, scatter, pull)
            for share in SHARES
            if share**2 > least[i]
        ]
        if not trials:
            return scatter
        scores = np.array([_foretold(told, trial, pull) for trial in trials])
        if scores.max() < best + DIFFERENT_LOG_PROBABILITY:
            return _expected(scatter, trials, scores - best)
        best, scatter = float(scores.max()), trials[int(np.argmax(scores))]


def _expected(scatter: np.ndarray, trials: Sequence[np.ndarray], gains: np.ndarray) -> np.ndarray:
    """(P,) the mean of these variances (P,) and of each of `trials`, by how probable they are: a trial has
    odds of exp(-DIFFERENT_LOG_PROBABILITY) beforehand, and gains so much."""
    odds = np.exp(gains - DIFFERENT_LOG_PROBABILITY)
    mean: np.ndarray = (scatter + odds @ np.array(trials)) / (1.0 + odds.sum())
    return mean


def doubted(
    told: Sequence[BetweenVoyages], pull: np.ndarray, usual: np.ndarray, numbers: np.ndarray
) -> np.ndarray:
    """(P,) `usual` (P,), but of these `numbers` (P,), of which it is known that they may differ, the expected
    variance: over SHARES and none, equally likely beforehand, as these voyages have them. In prior widths
    squared."""
    out, shares = usual.copy(), np.array([0.0, *SHARES])
    for i in np.flatnonzero(numbers).tolist():
        log = np.array([_foretold(told, _with(usual, i, share**2), pull) for share in shares])
        weight = np.exp(log - log.max())
        out[i] = max(usual[i], float(weight @ shares**2) / float(weight.sum()))
    return out


def _with(scatter: np.ndarray, i: int, variance: float) -> np.ndarray:
    out = scatter.copy()
    out[i] = variance
    return out


def _others(
    told: Sequence[BetweenVoyages], scatter: np.ndarray, pull: np.ndarray
) -> list[tuple[BetweenVoyages, np.ndarray, np.ndarray]]:
    """Every voyage with the mean and the covariance that the others foretell for its numbers."""
    out = []
    for i, voyage in enumerate(told):
        mean, covariance = ship_of([t for j, t in enumerate(told) if j != i], scatter, pull)
        out.append((voyage, mean, covariance + np.diag(scatter)))
    return out


def _foretold(told: Sequence[BetweenVoyages], scatter: np.ndarray, pull: np.ndarray) -> float:
    """Log probability of every voyage given the others."""
    return sum(
        voyage.log_probability(mean, covariance) for voyage, mean, covariance in _others(told, scatter, pull)
    )


def _steepest(told: Sequence[BetweenVoyages], scatter: np.ndarray, pull: np.ndarray) -> np.ndarray:
    """The few numbers whose variance the voyages ask for most, of those that they ask for."""
    slope, chance = np.sum(
        [voyage.score(mean, covariance) for voyage, mean, covariance in _others(told, scatter, pull)], axis=0
    )
    return np.argsort(-slope / np.sqrt(chance + 1e-12))[: min(FEW, int(np.sum(slope > 0.0)))]

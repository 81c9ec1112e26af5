"""Which faults the readings ask for: log evidence of every set of them, from one fit's normal equations
(Laplace's approximation).

    log L(theta) = g d - d A d/2,   d = theta - theta_fit;   a fault that is not in the set is nothing
    log evidence = max(log L + log prior) - log|W (A + W^-2) W|/2 + sum over ages of log 2 Phi(mean/sd)
W: prior scatters. An age is not below zero: its prior is one-sided.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr

from twin.study.instruments.kinematic_fit import MINE, SHARED, KinematicFit
from twin.study.instruments.unknowns import ALWAYS, FAULTS, UNKNOWNS

Sets = tuple[str, ...]
LEAST_INFORMATION = 1e-4  # of a prior width's information, below which the readings say nothing of a number


@dataclass(frozen=True)
class Weighed:
    """A set of faults about one fit: its log evidence with prior odds, and its numbers' mean and covariance
    (over `at`)."""

    faults: Sets
    log_weight: float
    at: np.ndarray
    mean: np.ndarray
    covariance: np.ndarray


class WeighedSets:
    """The sets weighed so far about one fit. `prompt`: the ages that are none by definition, since a clock
    of all instruments shows nowhere; `refuted`: faults that fits of their own did not bear out (refits.py),
    which are in no set but where they are asked for by name."""

    def __init__(self, found: KinematicFit, prompt: Collection[str], refuted: Collection[str] = ()) -> None:
        self.fit = found
        voyages = found.theta.shape[0]
        order = [UNKNOWNS[i] for i in SHARED] + [UNKNOWNS[i] for i in MINE] * voyages
        self.names = [u.name for u in order]
        self.fault = np.array([u.fault for u in order])
        self.late = np.array([u.late for u in order])
        told = np.diag(found.A) * found.width**2 > LEAST_INFORMATION
        self.tellable = tuple(
            f for f in FAULTS if f not in (*ALWAYS, *prompt) and told[self.fault == f].any()
        )
        self.offered = tuple(f for f in self.tellable if f not in refuted)
        self.always = np.isin(self.fault, ALWAYS)
        self.places = {f: self.fault == f for f in FAULTS}
        self.weighed: dict[Sets, Weighed] = {}

    def weigh(self, faults: Collection[str]) -> Weighed:
        """The set of these faults, in any order, with the numbers of ALWAYS free beside theirs; a name that
        is not in FAULTS does not count. Each set is worked out once and kept."""
        chosen = tuple(f for f in FAULTS if f in faults)
        if chosen not in self.weighed:
            self.weighed[chosen] = self._weigh(chosen)
        return self.weighed[chosen]

    def _weigh(self, chosen: Sets) -> Weighed:
        A, g, at, W = self.fit.A, self.fit.g, self.fit.at, self.fit.width
        free = self.always.copy()
        for fault in chosen:
            free |= self.places[fault]
        k, c = np.flatnonzero(free), np.flatnonzero(~free)
        h = g + A[:, c] @ at[c]
        log_weight = float(-g[c] @ at[c] - 0.5 * at[c] @ A[np.ix_(c, c)] @ at[c])
        inner = A[np.ix_(k, k)] + np.diag(W[k] ** -2.0)
        covariance = np.linalg.inv(inner)
        right = h[k] - at[k] / W[k] ** 2
        mean = at[k] + covariance @ right
        log_weight += 0.5 * float(right @ covariance @ right) - 0.5 * float((at[k] ** 2 / W[k] ** 2).sum())
        log_weight -= 0.5 * float(np.linalg.slogdet(inner * np.outer(W[k], W[k]))[1])
        sd = np.sqrt(np.diag(covariance))
        log_weight += float((np.log(2.0) + log_ndtr(mean / sd))[self.late[k]].sum())
        log_weight += float(sum(np.log(FAULTS[f].odds) for f in chosen))
        return Weighed(chosen, log_weight, k, mean, covariance)

    def best(
        self, start: Collection[str] = (), held: Collection[str] = (), never: Collection[str] = ()
    ) -> Weighed:
        """The likeliest set that holds `held` and none of `never`: one fault more, less or another in its
        place, while that helps."""
        now = self.weigh([f for f in {*start, *held} if f not in never])
        while True:
            best = max(
                (self.weigh(s) for s in self._near(now.faults, held, never)),
                key=lambda w: w.log_weight,
                default=now,
            )
            if best.log_weight <= now.log_weight + 1e-9:
                return now
            now = best

    def _near(self, now: Sets, held: Collection[str], never: Collection[str]) -> list[Sequence[str]]:
        more = [f for f in self.offered if f not in now and f not in never]
        less = [f for f in now if f not in held]
        out: list[Sequence[str]] = [(*now, f) for f in more]
        out += [tuple(x for x in now if x != f) for f in less]
        return out + [(*(x for x in now if x != f), m) for f in less for m in more]

    def likeliest(self) -> Weighed:
        """From nothing upward, and from everything downward: the better of both."""
        return max(self.best(), self.best(self.offered), key=lambda w: w.log_weight)

    def instead(self, fault: str, best: Weighed) -> Sets:
        """What would stand in the place of this fault of the likeliest set, were it not there."""
        return tuple(f for f in self.best(best.faults, never=[fault]).faults if f not in best.faults)

    def bayes_factor(self, fault: str, best: Weighed, nor: Collection[str] = ()) -> float:
        """Log Bayes factor of a fault: the likeliest set with it against the likeliest without it (`nor`
        those), prior odds aside."""
        odds = float(np.log(FAULTS[fault].odds))
        if fault in best.faults:
            return (
                best.log_weight
                - odds
                - self.best([f for f in best.faults if f not in nor], never=[fault, *nor]).log_weight
            )
        return self.best(best.faults, held=[fault]).log_weight - odds - best.log_weight

"""Whether faults that are seen about one fit are borne out by fits of their own, with each and without it.

About one fit every set of faults is weighed with the scatters of that fit (select.py). Where a ship hardly
turns, a deviation or a gyro's scale makes the path smaller, and a log's scale makes the stream so; their own
scatters shrink with them, and a set without the fault would be charged for a path that is too large for
those. Where each set has scatters of its own, it is not:

    log Bayes factor = log evidence of the set - max over sets without the fault of theirs, prior odds of the
    fault aside
"""

from collections.abc import Collection, Sequence

import numpy as np

from twin.study.instruments.kinematic_fit import fit
from twin.study.instruments.problem import Problem
from twin.study.instruments.unknowns import ALWAYS, FAULTS, UNKNOWNS


def begun_anew(problems: Sequence[Problem]) -> list[Problem]:
    """The same voyages with paths and scatters as before any fit: too large, and from there they come down
    in a few rounds."""
    return [Problem(p.readings, p.length, p.own) for p in problems]


class Refits:
    """Fits of whole sets of faults to these voyages, each begun anew and kept. `theta` (V, P): where their
    numbers start, in their own units."""

    def __init__(self, problems: Sequence[Problem], theta: np.ndarray) -> None:
        self.problems, self.theta = problems, theta
        self.weights: dict[frozenset[str], float] = {}

    def bayes_factors(self, chosen: Collection[str], seen: Collection[str]) -> dict[str, float]:
        """Log Bayes factor of each fault that is seen: the chosen set against the likelier of that without
        it and that without any that is seen."""
        whole, none = self._weight(chosen), self._weight({*chosen} - {*seen})
        return {
            f: whole - float(np.log(FAULTS[f].odds)) - max(none, self._weight({*chosen} - {f})) for f in seen
        }

    def _weight(self, chosen: Collection[str]) -> float:
        """Log evidence of a set of faults with its prior odds."""
        key = frozenset(chosen)
        if key not in self.weights:
            names = [u.name for u in UNKNOWNS if u.fault in (*key, *ALWAYS)]
            odds = float(np.log([FAULTS[f].odds for f in key]).sum())
            self.weights[key] = fit(begun_anew(self.problems), names, self.theta).log_likelihood + odds
        return self.weights[key]

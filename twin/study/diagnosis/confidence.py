"""How often a cause with such facts was really there, on ships of forms that the twin does not have.

The probability of a cause is Bayesian under the stated noise model, and a model that errs in form believes
itself
too much. What its facts are worth was measured: a logistic model, monotone in three of them, fitted to the
answers
on random ships of several families (bench/fleet); what it says of a family that was left out of the fit
stands in
docs/results/judgement.md. It holds for ships as often faulty as there, a third healthy, and is never told
beyond
what so many answers can show.
"""

from collections.abc import Callable
from math import exp, log

from twin.study.diagnosis.facts import Cause, Facts

LEAST_ODDS = 1e-3  # probability that is as good as none, and that short of one
SIGNIFICANCE_LIMIT = 30.0  # standard deviations of a number from none, beyond which there is no more to say
PROBABILITY_LIMITS = (0.05, 0.95)  # what a few hundred answers can show


def _log_odds(f: Facts, c: Cause) -> float:
    p = min(max(c.probability, LEAST_ODDS), 1.0 - LEAST_ODDS)
    return log(p / (1.0 - p)) / 3.0


def _clearness(f: Facts, c: Cause) -> float:
    return log(1.0 + min(c.significance, SIGNIFICANCE_LIMIT))


def _left_little(f: Facts, c: Cause) -> float:
    return -log(max(1.0 if f.left.error is None else f.left.error, 0.5))


FACTS: dict[str, Callable[[Facts, Cause], float]] = {  # each makes a cause likelier as it grows
    "log_odds": _log_odds,  # a third of the log odds of its probability
    "clearness": _clearness,  # log of one and its significance
    "left_little": _left_little,  # log of the expected error over what the explanation leaves
}
CONSTANT = -2.19
WEIGHTS = {"log_odds": 0.72, "clearness": 0.63, "left_little": 0.57}


def confidence(f: Facts, c: Cause) -> float | None:
    """Share of such causes that were there; None of one that is no part of the explanation."""
    if not c.in_explanation:
        return None
    s = CONSTANT + sum(WEIGHTS[name] * fact(f, c) for name, fact in FACTS.items())
    low, high = PROBABILITY_LIMITS
    return min(max(1.0 / (1.0 + exp(-s)), low), high)

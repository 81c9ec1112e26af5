"""The probabilities that are told: what they are worth on ships of forms that the twin does not have.

The posterior of a cause is Bayesian under the stated noise model, and a model that errs in form believes
itself too much: with a posterior of 0.95 or more a cause was there in 135 of 155 answers on random ships
(bench/fleet). What is told is therefore how often it was: logistic models, monotone in a few
facts, fitted to the answers on those ships; what they say of a form of hull that was left out of the fit
stands in docs/results/judgement.md. They hold for ships as often faulty as there, a third healthy, and
nothing is told beyond what so many answers can show.
"""

from collections.abc import Callable, Mapping
from math import exp, log

from twin.study.diagnosis.decision import Decision
from twin.study.diagnosis.facts import Cause, Facts

LEAST_ODDS = 1e-3  # probability that is as good as none, and that short of one
CLEAREST_SD = 30.0  # standard deviations of a number from none, beyond which there is no more to say
PROBABILITY_LIMITS = (0.05, 0.95)  # what a few hundred answers can show


def log_odds(posterior: float) -> float:
    """A third of the log odds of a posterior probability, within what is as good as sure."""
    p = min(max(posterior, LEAST_ODDS), 1.0 - LEAST_ODDS)
    return log(p / (1.0 - p)) / 3.0


def _clearness(f: Facts, c: Cause, d: Decision) -> float:
    return log(1.0 + min(c.significance, CLEAREST_SD))


FACTS: dict[str, Callable[[Facts, Cause, Decision], float]] = {  # each makes a cause likelier as it grows
    # a third of the log odds of the posterior that it is there, and lasts
    "log_odds": lambda f, c, d: log_odds(c.probability * f.lasts(c)),
    "clearness": _clearness,  # log of one and its significance
    "named": lambda f, c, d: float(c.effect in d.missing),  # whether the table of rules names it
}
OF_CAUSE = {"constant": -3.19, "log_odds": 1.31, "clearness": 0.83, "named": 1.11}  # of the explanation
OF_CAUSE_BESIDE = {"constant": -1.09, "log_odds": 0.93}  # the explanation does without it
OF_NOTHING = {"constant": -0.98, "log_odds": 1.21, "unnamed": 1.44}  # no cause of ship and instruments
OF_UNKNOWN = {"constant": -0.89, "log_odds": 1.18, "verdict": 0.71}  # what is there has no name


def of_cause(f: Facts, d: Decision, effect: str, posterior: float) -> float:
    """How often a cause with such facts, and this posterior probability, was there; of what is known by its
    form alone: how often something without a name was. [1]"""
    if effect in f.resembles:
        return of_unknown(f, d)
    cause = next((c for c in f.causes if c.effect == effect and c.in_explanation), None)
    if cause is None:
        return _share(OF_CAUSE_BESIDE, log_odds=log_odds(posterior))
    return _share(OF_CAUSE, **{name: fact(f, cause, d) for name, fact in FACTS.items()})


def of_nothing(posterior: float, f: Facts, d: Decision) -> float:
    """How often no cause was there where that has this posterior probability. [1] A diagnosis sets it aside
    where a stretch had a push of its own; the fit did not."""
    return _share(OF_NOTHING, log_odds=log_odds(posterior), unnamed=unnamed(f, d))


def unnamed(f: Facts, d: Decision) -> float:
    """1 where the rules name no cause of ship and instruments, else 0."""
    return float(not any(c.effect in d.missing for c in f.causes))


def of_unknown(f: Facts, d: Decision) -> float:
    """How often what was there is in no catalogue. [1]"""
    posterior = posterior_of_unknown(f)
    return _share(OF_UNKNOWN, log_odds=log_odds(posterior), verdict=float(d.verdict == "unknown"))


def posterior_of_unknown(f: Facts) -> float:
    """Posterior probability that something is there without a name: of no known form, or what acts like a
    cause of the explanation and does not last. [1]"""
    fitful = (c.probability * (1.0 - f.lasts(c)) for c in f.causes if c.in_explanation)
    return max(f.unknown, *fitful, 0.0)


def _share(weights: Mapping[str, float], **facts: float) -> float:
    """The logistic model, within what so many answers can show."""
    s = weights["constant"] + sum(weights[name] * fact for name, fact in facts.items())
    low, high = PROBABILITY_LIMITS
    return min(max(1.0 / (1.0 + exp(-s)), low), high)

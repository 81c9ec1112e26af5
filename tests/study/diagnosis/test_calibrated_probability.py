"""The probabilities that are told: what moves them, and that the fit to the recorded answers gives them."""

from dataclasses import replace
from statistics import NormalDist

import pytest

from bench.fleet import kept_rows, probability_fit
from bench.fleet.decision_fit import with_facts
from bench.fleet.keep_answers import FLEET, NEW_SHIPS
from tests.study.diagnosis.test_decision import cause, facts
from twin.study.diagnosis import calibrated_probability as told
from twin.study.diagnosis.decision import decide


def said(f, posterior=0.97):
    return told.of_cause(f, decide(f), f.causes[0].effect, posterior)


@pytest.fixture(scope="module")
def fitted():
    rows = with_facts([*kept_rows.read(*FLEET), *kept_rows.read(*NEW_SHIPS)])
    return probability_fit.fitted(probability_fit.examples(rows))


def test_a_clearer_and_a_likelier_cause_is_likelier_there():
    weak = facts(cause(probability=0.9, significance=2.0), cause("RudderWear", significance=2.0))
    likely = facts(cause(probability=0.99, significance=2.0), cause("RudderWear", significance=2.0))
    clear = facts(cause(probability=0.99, significance=20.0))
    assert said(weak, 0.9) < said(likely, 0.99) < said(clear, 0.99)


def test_it_by_hand():
    """p 0.97, significance 20, named: -3.19 + 1.31 (3.476 / 3) + 0.83 (3.045) + 1.11 = 1.965."""
    f = facts(cause(probability=0.97, significance=20.0))
    assert decide(f).missing == (f.causes[0].effect,)
    assert said(f) == pytest.approx(0.877, abs=1e-3)


def test_a_cause_that_the_explanation_does_without_is_told_by_its_posterior_alone():
    beside = facts(cause(in_explanation=False))
    assert said(beside, 0.3) < said(beside, 0.9) < 0.7


def test_nothing_is_told_beyond_what_so_many_answers_can_show():
    f = facts(cause(probability=1.0, significance=1e9))
    low, high = told.PROBABILITY_LIMITS
    d = decide(f)
    assert said(f, 1.0) <= high and told.of_nothing(1.0, f, d) <= high and told.of_nothing(0.0, f, d) >= low


def test_nothing_is_less_likely_where_a_cause_is_named():
    """Test: the same posterior beside a named cause, and beside one that is not. Expected: by hand, log odds
    of a half are none: 1 / (1 + e^0.98) = 0.273, and 1 / (1 + e^-0.46) = 0.613."""
    f = facts(cause(probability=0.97, significance=20.0))
    d = decide(f)
    assert d.missing and told.of_nothing(0.5, f, d) == pytest.approx(0.273, abs=1e-3)
    assert told.of_nothing(0.5, f, replace(d, missing=())) == pytest.approx(0.613, abs=1e-3)


def test_something_without_a_name_is_likelier_where_the_verdict_says_so():
    f = replace(facts(cause(in_explanation=False)), unknown=0.5)
    d = decide(f)
    assert told.of_unknown(f, replace(d, verdict="unknown")) > told.of_unknown(
        f, replace(d, verdict="undecided")
    )


def test_what_acts_like_a_cause_and_does_not_last_is_rather_something_without_a_name():
    steady, fitful = (facts(cause("RudderWear", probability=0.99, varies=p)) for p in (0.0, 0.98))
    assert said(fitful) < 0.5 < said(steady)
    assert said(facts(cause("RudderWear", probability=0.99, varies=0.25))) == said(steady)
    assert told.of_unknown(fitful, decide(fitful)) > 0.5 > told.of_unknown(steady, decide(steady))
    assert told.posterior_of_unknown(fitful) == pytest.approx(0.97, abs=1e-3)


def test_the_weights_are_those_that_the_fit_to_the_recorded_answers_gives(fitted):
    for name, one in fitted.items():
        assert getattr(told, name) == pytest.approx(one["weights"], abs=0.011), name


def test_what_is_told_of_forms_of_hulls_left_out_of_the_fit_is_what_was_there(fitted):
    """Within the 95 % interval of the shares of all bins of twenty and more together (Bonferroni), or five in a
    hundred."""
    bins = [
        (name, mean, *(int(x) for x in share.split(",")[0].split(" of ")))
        for name, one in fitted.items()
        for mean, share in one["held_out"]["so"].values()
    ]
    told_often = [b for b in bins if b[3] >= 20]
    z = NormalDist().inv_cdf(1.0 - 0.025 / len(told_often))
    for name, mean, k, n in told_often:
        assert abs(k / n - mean) < z * (mean * (1 - mean) / n) ** 0.5 + 0.05, (name, mean, k, n)

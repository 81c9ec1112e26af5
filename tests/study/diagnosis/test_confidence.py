"""How often a cause with such facts was there: what moves it, and where it is not said."""

from dataclasses import replace

import pytest

from tests.study.diagnosis.test_decision import cause, facts
from twin.study.diagnosis.confidence import confidence


def said(f):
    return confidence(f, f.causes[0])


def test_a_clearer_cause_that_leaves_little_is_likelier_there():
    weak = facts(cause(probability=0.9, significance=2.0), cause("RudderWear", significance=2.0))
    clear = facts(cause(probability=0.99, significance=20.0))
    much = replace(clear, left=replace(clear.left, error=3.0))
    assert said(weak) < said(much) < said(clear)


def test_it_by_hand():
    """p 0.9, significance 4, leaves what is expected: -2.19 + 0.72 (2.197 / 3) + 0.63 (1.609) = -0.649."""
    f = facts(cause(probability=0.9, significance=4.0))
    assert said(replace(f, left=replace(f.left, error=1.0))) == pytest.approx(0.343, abs=1e-3)


def test_what_explains_nothing_has_none():
    assert said(facts(cause(in_explanation=False))) is None

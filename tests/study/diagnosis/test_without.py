"""What an effect does by itself, and a drag that depends on the place, which is no tow."""

import numpy as np
import pytest

from tests.thorough import thorough
from twin.physics.effects import find
from twin.study.diagnosis.consider import consider
from twin.study.diagnosis.decision import decide
from twin.study.diagnosis.refine import refine
from twin.study.diagnosis.search import search
from twin.study.diagnosis.verdict import weights, without


@pytest.fixture(scope="module")
def worn(case_of):
    case = case_of("RudderWear")
    return case, refine(case, ("RudderWear",), "usual", np.ones(len(case.effects)), ())[0]


def test_an_effect_that_the_ship_had_is_put_back_to_what_it_was(worn):
    case, found = worn
    (effect,) = (e for e in found.model.effects if type(e) is find("RudderWear"))
    before = case.model.but(effect.but(loss=0.05))
    assert without(found.model, before, "RudderWear").effects == before.effects
    assert without(found.model, case.model, "RudderWear").effects == case.model.effects


@thorough
def test_where_the_best_that_is_known_is_no_tow_the_answer_is_that_nobody_knows(case_of):
    case = case_of("IceLike")
    case, weighed, found, seen, _ = search(case)
    facts = consider(case, weighed, found, seen, weights(case, weighed, found)).facts
    assert decide(facts).verdict == "unknown"

"""Whether a force is what its name says, or only of the size that suits the voyages best."""

from dataclasses import replace

import numpy as np
import pytest

from twin.study.diagnosis import leftover, own_force
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.leftover import answer
from twin.study.diagnosis.own_force import MOST_OF_IT, otherwise, without
from twin.study.diagnosis.refine import DOUBTS, refine
from twin.study.diagnosis.search import search
from twin.study.reference.evidence import Posterior


def about_its_size(voyage, ship, name):
    case = assemble([voyage], ship)
    return case, refine(case, (name,), "usual", np.ones(len(case.effects)), ())[0]


@pytest.fixture(scope="module")
def worn(tanker, voyages):
    return about_its_size(voyages["RudderWear"], tanker, "RudderWear")


def test_a_true_cause_is_what_it_says_though_nature_writes_it_otherwise(worn):
    assert otherwise(*worn, worn[1]) == []


def test_drag_that_depends_on_the_place_is_no_tow(tanker, voyages):
    case, found = about_its_size(voyages["IceLike"], tanker, "TowForce")
    assert otherwise(case, found, found) == ["TowForce"]


def test_one_that_leads_her_where_she_went_may_be_farther_off_its_form_but_not_be_something_else_altogether(
    tanker, voyages, monkeypatch
):
    """Test: shares of its own force that the voyages would rather have open, made up; led within the floor as
    the model alone is not, led outside, and where the model alone leads as well. Expected: eight tenths of it
    count against all but the first, against that only more than all of it."""
    case, found = about_its_size(voyages["RudderWear"], tanker, "RudderWear")
    near, far = (replace(found, off_m=off_m, floor_m=10.0) for off_m in (9.0, 11.0))
    led = {True: [(near, far)], False: [(far, far), (near, near)]}
    for likeliest, odd in (
        (0.8, {True: [], False: ["RudderWear"]}),
        (1.6, {True: ["RudderWear"], False: ["RudderWear"]}),
    ):
        says = [
            Posterior(np.zeros(0), np.zeros((0, 0)), 100.0 if k == likeliest else 0.0)
            for k in (*DOUBTS, *MOST_OF_IT)
        ]
        for within, named in odd.items():
            for those in led[within]:
                asked = iter(says if not within else [*says[: len(DOUBTS)], says[-1]])
                monkeypatch.setattr(own_force, "posterior", lambda *_, asked=asked: next(asked))
                assert otherwise(case, *those) == named, (likeliest, within)


def test_what_only_an_instrument_shows_has_no_force_to_ask_about(tanker, voyages):
    case, found = about_its_size(voyages["IceLike"], tanker, "HeadingBias")
    assert otherwise(case, found, found) == []


def test_an_effect_that_the_ship_had_is_put_back_to_what_it_was(worn):
    case, found = worn
    (effect,) = found.model.effects
    before = case.model.but(effect.but(loss=0.05))
    assert without(found.model, before, "RudderWear").effects == before.effects
    assert without(found.model, case.model, "RudderWear").effects == ()


@pytest.mark.parametrize("odd, explains", [
    ([], ("RudderWear", "SteeringLag")), (["SteeringLag"], ("RudderWear",)), (["RudderWear"], ()), (["RudderWear", "SteeringLag"], ()),
])  # fmt: skip
def test_of_two_the_one_that_is_what_it_says_is_left_if_it_explains_the_voyages_alone(
    monkeypatch, worn, odd, explains
):
    case, found = worn
    pair, alone = ("RudderWear", "SteeringLag"), ("RudderWear",)
    known = {s: replace(found, hypothesis=replace(found.hypothesis, effects=s)) for s in ((), alone, pair)}
    monkeypatch.setattr(leftover, "explains", lambda *_: True)
    monkeypatch.setattr(
        leftover, "otherwise", lambda _, f, nothing: odd if f.hypothesis.effects == pair else []
    )
    assert answer(case, [], known, pair) == explains
    assert answer(case, [], known, ()) == ()


def test_where_the_best_that_is_known_is_no_tow_the_answer_is_that_nobody_knows(tanker, voyages):
    case = assemble([voyages["IceLike"]], tanker)
    weighed, found, _ = search(case)
    assert answer(case, weighed, found, weighed[0].effects) == ()

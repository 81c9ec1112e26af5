"""What is judged next, and about which part a pair is weighed."""

from copy import copy
from dataclasses import replace

import numpy as np
import pytest

from tests.thorough import thorough
from twin.physics.effects import catalogue
from twin.study.diagnosis.case import ODDS_WEAK, SCENARIOS
from twin.study.diagnosis.criteria import SURE
from twin.study.diagnosis.hollow import hollow
from twin.study.diagnosis.refine import Found
from twin.study.diagnosis.search import Hypotheses, search
from twin.study.diagnosis.steady import simpler
from twin.study.diagnosis.verdict import weights

PAIR = ("RudderWear", "SteeringLag")


@pytest.fixture(scope="module")
def case(case_of):
    return case_of("SteeringLag")


def book(case):
    """Of this case, as the linear pass leaves it: weighed once, and a copy for each that writes into it."""
    opened = OPENED.setdefault(id(case), (case, _opened(case)))[1]
    own = copy(opened)
    own.entries, own.found = dict(opened.entries), dict(opened.found)
    own.first, own.last = list(opened.first), list(opened.last)
    return own


OPENED = {}  # with its case, so that no other gets its id


def _opened(case):
    names = list(SCENARIOS)
    return Hypotheses(case, dict(zip(names, case.reduced(case.lines, case.scenarios(names)), strict=True)))


@pytest.fixture(scope="module")
def in_turn(case):
    """By order of the two: the case with both relinearised at their estimates, and what the pair weighs in every
    noise scenario after each."""

    def weighed(*judged):
        held, weights = book(case), []
        for chosen in judged:
            held.judge(chosen)
            weights.append({scenario: h.log_weight for (s, scenario), h in held.entries.items() if s == PAIR})
        return held, *weights

    return weighed(PAIR[:1], PAIR[1:]), weighed(PAIR[1:], PAIR[:1])


@thorough
def test_a_pair_is_weighed_about_the_part_where_it_explains_more_whichever_was_judged_first(in_turn):
    (_, worn, worn_first), (_, slow, slow_first) = in_turn
    for both in (worn_first, slow_first):
        # beside no weather a pair is weighed where that is among the likeliest
        known = worn.keys() & slow.keys()
        assert {scenario: both[scenario] for scenario in known} == pytest.approx(
            {scenario: max(worn[scenario], slow[scenario]) for scenario in known}, abs=1.0
        )
    assert max(slow.values()) > max(worn.values())


@thorough
def test_a_pair_begins_where_the_likelier_of_its_parts_was_found_and_that_is_not_looked_for_again(
    case, in_turn, monkeypatch
):
    held = in_turn[0][0]
    worn, slow = (held.found[(name,)].hypothesis.log_weight for name in PAIR)
    began = {}

    def begins(case, chosen, scenario, z, wider, hoped, part):
        began.update(z=z, known=part.hypothesis.effects)
        return replace(
            held.found[PAIR[1:]], hypothesis=replace(held.found[PAIR[1:]].hypothesis, effects=chosen)
        ), []

    monkeypatch.setattr("twin.study.diagnosis.search.refine", begins)
    held.judge(PAIR)
    gear = [i for i, u in enumerate(case.effects) if u.owner == "SteeringLag"]
    assert slow > worn and began["known"] == ("SteeringLag",)
    assert began["z"][gear] == pytest.approx(held.found[PAIR[1:]].posterior.z[gear], abs=0.3)


def test_weather_stands_beside_any_two_causes_and_takes_no_place(case):
    """Test: a linear pass, on a voyage with wind recorded. Expected: pairs of causes beside wind and stream
    together; of a set its weather is judged first, then each cause beside it."""
    held = book(case)
    asked = {h.effects for h in held.weighed()}
    assert max(len(case.causes(s)) for s in asked) == 2 and max(len(case.day(s)) for s in asked) >= 2
    assert case.ordered(("Current", "RudderWear", "Wind")) in asked
    four = case.ordered(("Current", "Wind", "RudderWear", "SteeringLag"))
    day = case.ordered(("Current", "Wind"))
    assert held.parts(four) == [day, *(case.ordered((*day, name)) for name in case.causes(four))]


@thorough
def test_every_promising_effect_is_judged_when_what_was_found_leaves_too_much(case_of):
    held = book(case_of("nothing"))
    while chosen := held.next():
        held.judge(chosen)
    held.last = [("RudderWear",)]
    assert held.next() is None
    held.wide = True
    assert held.next() == ("RudderWear",)


def test_what_needs_a_measured_cause_that_was_too_weak_to_show_keeps_little_odds_in_all_that_follows(
    case_of, search_of
):
    """Also where a further cause is weighed beside those that the search found."""
    told = search_of("nothing")
    little = {n for n, odds in told.case.odds.items() if odds == ODDS_WEAK}
    assert little == {n for n, shows in told.seen.items() if not shows and told.case.catalogue[n].needs}
    assert little and ODDS_WEAK not in case_of("nothing").odds.values()


def test_a_set_that_was_never_weighed_can_be_judged(case):
    held = book(case)
    three = tuple(n for n in case.candidates if n in ("Current", "HullFouling", "SteeringLag"))
    assert not any(h.effects == three for h in held.weighed())
    held.judge(three)
    assert three in held.found


@thorough
def test_an_effect_and_a_part_of_it_are_no_pair(case):
    assert case.log_prior(("Current", "VaryingCurrent"), "usual") == -np.inf
    assert np.isfinite(case.log_prior(("VaryingCurrent",), "usual")) and np.isfinite(
        case.log_prior(("Current", "HullFouling"), "usual")
    )
    assert ("Current", "VaryingCurrent") not in {h.effects for h in search(case).weighed}


def test_beside_a_stream_that_changes_a_steady_one_is_judged_too(case):
    assert simpler(case, ("VaryingCurrent", "HullFouling")) == [
        tuple(n for n in case.candidates if n in ("Current", "HullFouling"))
    ]
    assert simpler(case, ("HullFouling",)) == []


def test_what_an_effect_holds_is_in_the_catalogue():
    effects = catalogue()
    assert effects["VaryingCurrent"].holds == ("Current",)
    assert {part for e in effects.values() for part in e.holds} <= set(effects)


def test_an_effect_that_ended_at_nothing_says_no_more_than_the_rest(case, monkeypatch):
    """A loss below nothing cannot be: it stays at nothing, and whatever it would explain, the set leaves the
    list."""
    held = book(case)

    def at_nothing(case, chosen, scenario, z, wider, hoped, part):
        none = held.found[()]
        h = replace(none.hypothesis, effects=chosen, log_evidence=1e6)
        return Found(h, replace(none.posterior, z=np.zeros(len(case.effects))), case.model), [h]

    monkeypatch.setattr("twin.study.diagnosis.search.refine", at_nothing)
    held.judge(("RudderWear",))
    assert ("RudderWear",) in held.found
    assert ("RudderWear",) not in {h.effects for h in held.weighed()}
    assert held.next() != ("RudderWear",)


@thorough
def test_what_any_day_brings_much_of_is_judged_about_its_own_size_without_having_earned_it(case):
    sizes = {u.label: u.sd for u in case.effects}
    for share, judged in ((0.02, []), (0.1, [("Current",)])):
        daily = {label: share * sizes[label] for label in ("Current.north", "Current.east")}
        usual = replace(case, nuisance=replace(case.nuisance, daily=daily))
        assert book(usual).of_the_day() == judged
        assert [s for s in book(usual).first if s == ("Current",)][:1] == judged


@thorough
def test_what_any_day_brings_is_no_news_where_it_stands_today(case_of):
    """Test: a stream as strong as any day's, and a ship that knows that and one that does not. Expected: that
    it is nothing new is likelier once it was judged where it stands, and nobody calls it missing; to the ship
    that knows no streams it is one."""
    case = case_of("Current")
    daily = dict.fromkeys(("Current.north", "Current.east"), 0.5)
    usual = replace(case, nuisance=replace(case.nuisance, daily=daily))
    nothing = {}
    for name, told in (("knows", usual), ("knows not", case)):
        held = book(told)
        before = max(h.log_weight for h in held.weighed() if not h.effects)
        held.judge(("Current",))
        nothing[name] = max(h.log_weight for h in held.weighed() if not h.effects) - before
    assert nothing["knows"] > 1.0 and nothing["knows not"] == 0.0
    told = search(usual)
    assert weights(usual, told.weighed, told.found).weather["Current"] < SURE


@pytest.mark.parametrize("c_d, none", [(0.0, True), (0.1, False)])
def test_drag_that_is_none_but_lies_otherwise_along_her_is_none(case, c_d, none):
    nothing, chosen = book(case).found[()], ("CrossFlowDrag",)
    z = np.array(
        [{"c_d": c_d, "c_aft": -0.4}.get(u.name, 0.0) if u.owner == chosen[0] else 0.0 for u in case.effects]
    )
    there = replace(nothing.hypothesis, effects=chosen)
    found = replace(nothing, hypothesis=there, posterior=replace(nothing.posterior, z=z))
    assert hollow(case, found) is none


def test_what_shows_another_moment_is_judged_about_its_own_size_if_it_promises_anything(case):
    held = book(case)
    assert (
        held.of_another_moment(("SensorDelay",))
        and not held.of_another_moment(("HeadingBias",))
        and not held.of_another_moment(("SteeringLag",))
    )
    assert (("SensorDelay",) in held.first) == (("SensorDelay",) in held.promising())

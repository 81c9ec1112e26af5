"""From weights to words: when something is named, when the ship is acquitted, and when the answer is that
nobody can tell."""

import math
from types import SimpleNamespace

import pytest

from twin.physics.effects import catalogue
from twin.study.diagnosis.verdict import Weights, group, judge, weights
from twin.study.reference.evidence import Hypothesis

YES = ("blurred",)


def verdict(effects=(), nothing=0.0, unknown=0.0, how=(), leads=None, **sure):
    best = Hypothesis(tuple(effects), "usual", 0.0, 0.0)
    singles = [Hypothesis((name,), "usual", -float(i), 0.0) for i, name in enumerate(effects)]
    nobody = Hypothesis((), "usual", 0.0, 0.0)  # as likely as the best, so that no group is sure
    flags = {flag: flag in YES for flag in how}
    return judge(
        [best, *singles, nobody],
        Weights(nothing, unknown, sure, best),
        dict.fromkeys(effects, ()),
        effects if leads is None else leads,
        **flags,
    )


def test_what_is_there_with_odds_of_four_to_one_is_named_and_what_is_less_likely_is_not():
    assert verdict(["HullFouling"], nothing=0.15, HullFouling=0.85) == ("missing", ["HullFouling"])
    assert verdict(["HullFouling"], nothing=0.4, HullFouling=0.6) == ("undecided", [])


@pytest.mark.parametrize("nothing, answer", [(0.01, ("missing", ["RudderOffset"])), (0.2, ("undecided", []))])
def test_one_of_two_that_cannot_be_told_apart_is_named_when_one_of_them_is_surely_there(nothing, answer):
    chances = {("RudderOffset",): 0.55 - nothing, ("PropellerWalk",): 0.45, (): nothing}
    weighed = [Hypothesis(effects, "usual", math.log(p), 0.0) for effects, p in chances.items()]
    w = Weights(nothing, 0.0, {"RudderOffset": 0.55 - nothing, "PropellerWalk": 0.45}, weighed[0])
    assert judge(weighed, w, {"RudderOffset": ["PropellerWalk"]}, ["RudderOffset"]) == answer
    assert judge(weighed, w, {"RudderOffset": []}, ["RudderOffset"]) == ("undecided", [])


def test_a_second_effect_is_named_only_when_it_is_nearly_certain():
    """Of two forms that are only roughly right, one may mend the other."""
    assert verdict(["HullFouling", "RudderWear"], HullFouling=1.0, RudderWear=0.85) == (
        "missing",
        ["HullFouling"],
    )
    assert verdict(["HullFouling", "RudderWear"], HullFouling=1.0, RudderWear=0.95) == (
        "missing",
        ["HullFouling", "RudderWear"],
    )


def test_the_one_that_explains_more_alone_comes_first():
    assert verdict(["RudderWear", "HullFouling"], HullFouling=1.0, RudderWear=1.0)[1] == [
        "RudderWear",
        "HullFouling",
    ]


@pytest.mark.parametrize("nothing, word", [(0.9, "nothing_missing"), (0.7, "undecided")])
def test_a_ship_is_acquitted_only_when_that_is_clear(nothing, word):
    assert verdict(nothing=nothing) == (word, [])


def test_a_restless_world_is_unknown():
    assert verdict(["Loading"], unknown=0.8, Loading=1.0) == ("unknown", [])


@pytest.mark.parametrize("effect, unknown", [("WaveDrift", 0.0), ("Loading", 1.0)])
def test_water_that_the_sea_makes_restless_is_nothing_unknown_beside_the_seas_own_force(effect, unknown):
    case = SimpleNamespace(
        names=list, candidates=(effect,), unnamed=(), present=set(), news=tuple, catalogue=catalogue()
    )
    assert weights(case, [Hypothesis((effect,), "strange", 0.0, 0.0)]).unknown == unknown


def test_what_is_left_over_or_otherwise_than_its_name_is_unknown_but_decides_nothing_where_there_was_a_sea():
    assert verdict(["Loading"], Loading=1.0, how=("explained",)) == ("unknown", [])
    assert verdict(["Loading"], Loading=1.0, how=("explained", "blurred")) == ("undecided", [])


def test_voyages_without_a_manoeuvre_decide_nothing():
    without = ("able",)
    assert verdict(["HullFouling"], HullFouling=1.0, how=without) == ("undecided", [])
    assert verdict(nothing=0.99, how=without) == ("undecided", [])
    assert verdict(unknown=0.99, how=without) == ("undecided", [])


def test_voyages_that_would_not_have_shown_most_effects_acquit_nobody_but_name_what_they_show():
    assert verdict(["Current"], Current=1.0, how=("sharp",)) == ("missing", ["Current"])
    assert verdict(nothing=0.99, how=("sharp",)) == ("undecided", [])


def test_what_does_not_lead_her_better_is_not_named():
    assert verdict(["Loading"], Loading=1.0, leads=[]) == ("undecided", [])
    assert verdict(["Loading", "RudderWear"], Loading=1.0, RudderWear=1.0, leads=["RudderWear"]) == (
        "missing",
        ["RudderWear"],
    )


def test_a_restlessness_for_which_there_was_a_sea_decides_nothing():
    assert verdict(["SteeringLag"], unknown=0.9, SteeringLag=1.0, how=("blurred",)) == ("undecided", [])
    assert verdict(["WaveDrift"], unknown=0.1, WaveDrift=1.0, how=("blurred",)) == ("missing", ["WaveDrift"])


def test_two_effects_that_leave_her_restless_are_unknown():
    assert verdict(["TowForce", "PropellerWear"], TowForce=1.0, PropellerWear=1.0, how=("explained",)) == (
        "unknown",
        [],
    )


@pytest.mark.parametrize(
    "chances, names",
    [
        (
            {"PropellerWear": 0.4, "RudderWear": 0.32, "Loading": 0.27, "": 0.01},
            ["PropellerWear", "RudderWear", "Loading"],
        ),
        ({"PropellerWear": 0.6, "RudderWear": 0.38, "": 0.02}, ["PropellerWear", "RudderWear"]),
        ({"PropellerWear": 0.5, "RudderWear": 0.3, "": 0.2}, []),  # it may be nothing
        ({"PropellerWear": 0.9, "RudderWear": 0.1}, []),  # likely enough: something else spoke against it
        (dict.fromkeys("ABCDE", 0.2), []),  # anything
    ],
)
def test_an_undecided_answer_still_says_of_which_few_effects_one_is_surely_there(chances, names):
    weighed = [Hypothesis((name,) if name else (), "usual", math.log(p), 0.0) for name, p in chances.items()]
    w = Weights(chances.get("", 0.0), 0.0, {n: p for n, p in chances.items() if n}, weighed[0])
    assert group(weighed, w) == names


@pytest.mark.parametrize("tank, unknown", [(-300.0, 0.0), (-105.0, 1.0)])
def test_what_is_known_by_its_form_alone_beside_an_effect_that_does_most_only_mends_its_form(tank, unknown):
    """Test: heel with a slack tank is 50 nats likelier than heel alone; the tank alone far less likely than
    heel, or nearly as likely. Expected: heel is named in the first case, and in the second something has no
    name."""
    case = SimpleNamespace(
        candidates=("RollCoupling", "SwayingMass"),
        unnamed=("SwayingMass",),
        news=lambda chosen: tuple(chosen),
        names=lambda chosen: tuple(n for n in chosen if n != "SwayingMass"),
    )
    said = {
        ("RollCoupling", "SwayingMass"): -50.0,
        ("RollCoupling",): -100.0,
        ("SwayingMass",): tank,
        (): -900.0,
    }
    w = weights(case, [Hypothesis(effects, "usual", says, 0.0) for effects, says in said.items()])
    assert w.unknown == pytest.approx(unknown) and w.effects["RollCoupling"] == pytest.approx(1.0)
    assert w.unnamed["SwayingMass"] == pytest.approx(1.0)

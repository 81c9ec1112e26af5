"""The decision: a table over facts. What it answers on recorded voyages, and which fact turns each
verdict."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from twin.study.diagnosis.criteria import SURE
from twin.study.diagnosis.decision import RULES, decide
from twin.study.diagnosis.facts import Cause, Facts, Left
from twin.study.diagnosis.naming import CAUSE_RULES, SECOND_NOT_SURE, why_not
from twin.study.diagnosis.reasons import why_not as words

RECORDED = json.loads(Path(__file__).with_name("recorded_facts.json").read_text())
LEFT = Left(error=0.9, share=0.4, restless=0.0)


def cause(effect="HullFouling", **facts):
    """One that is clearly there."""
    usual = {
        "belongs_to": "ship",
        "in_explanation": True,
        "in_ship_file": False,
        "sea_force": False,
        "probability": 0.97,
        "with_rivals": 0.98,
        "log_bayes_factor": 40.0,
        "alone": 80.0,
        "error_gain": 0.5,
        "significance": 8.0,
        "change": 0.0,
    }
    return Cause(effect, **usual | facts)


def facts(*causes, **other):
    """Of a voyage on which these causes explain everything; of none, one on which nothing is missing."""
    names = tuple(c.effect for c in causes if c.in_explanation)
    usual = Facts(
        nothing=0.0 if causes else 0.97,
        unknown=0.0,
        likeliest=names,
        explanation=names,
        left=LEFT,
        error_nothing=2.2 if causes else 0.9,
        error_best=0.9,
        manoeuvre=True,
        power=0.9,
        structural=(0.1, 0.1, 0.1),
        noise=(1.0, 1.0, 1.0),
        scatter=1.0,
        sea=False,
        rough=0.0,
        transient=0.0,
        in_waves=False,
        resembles=(),
        one_of=(),
        causes=causes,
        weather=(),
        as_before=(),
    )
    return replace(usual, **other)


@pytest.mark.parametrize("name", RECORDED)
def test_the_facts_of_a_recorded_voyage_give_the_verdict_that_was_recorded(name):
    row = RECORDED[name]
    answer = decide(Facts.read(row["facts"]))
    assert (answer.verdict, answer.reason, list(answer.missing)) == (
        row["verdict"],
        row["reason"],
        row["missing"],
    )


def test_facts_are_the_same_after_they_were_written():
    f = facts(cause(), weather=(cause("Wind", belongs_to="voyage"),))
    assert Facts.read(json.loads(json.dumps(f.as_json()))) == f


def test_the_last_rule_always_holds_and_each_reason_has_one_sentence():
    assert RULES[-1].condition(facts(nothing=0.5))
    said = {}
    for rule in RULES:
        assert said.setdefault(rule.reason, rule.sentence) is rule.sentence


@pytest.mark.parametrize(
    "changes, verdict, reason",
    [
        ({}, "nothing_missing", "nothing"),
        ({"nothing": 0.7}, "undecided", "cannot_tell"),
        ({"power": 0.5}, "undecided", "no_power"),
        ({"error_nothing": 1.8}, "undecided", "astray"),
        ({"left": Left(1.0, 1.0, 3.1)}, "undecided", "restless"),
        ({"manoeuvre": False}, "undecided", "no_manoeuvre"),
        ({"unknown": 0.6, "nothing": 0.3, "error_nothing": 2.0}, "unknown", "unexplained"),
        (
            {"unknown": 0.6, "nothing": 0.3},
            "undecided",
            "as_near_as_usual",
        ),  # restless, but led where it went
        ({"likeliest": ("RudderWear",), "nothing": 0.3, "error_nothing": 2.0}, "undecided", "still_astray"),
        ({"unknown": 0.6, "nothing": 0.3, "resembles": ("RudderPlay",)}, "unknown", "resembles"),
        ({"unknown": 0.6, "nothing": 0.3, "sea": True}, "undecided", "weather_may_mislead"),
        ({"transient": 40.0}, "unknown", "pushed"),
        ({"transient": 40.0, "sea": True}, "undecided", "pushed_in_weather"),
        ({"weather": (cause("Current", belongs_to="voyage"),)}, "missing", "weather_only"),
        ({"weather": (cause("Current", belongs_to="voyage"),), "nothing": 0.7}, "missing", "weather"),
        (
            {"weather": (cause("Current", belongs_to="voyage", error_gain=0.01),)},
            "nothing_missing",
            "nothing",
        ),
        (
            {"weather": (cause("Wind", belongs_to="voyage"),), "as_before": ("Wind",)},
            "nothing_missing",
            "nothing",
        ),
        ({"nothing": 0.1, "one_of": ("RudderWear", "PropellerWear")}, "undecided", "one_of"),
    ],
)
def test_which_fact_turns_nothing_missing_into_what(changes, verdict, reason):
    answer = decide(facts(**changes))
    assert (answer.verdict, answer.reason) == (verdict, reason)


@pytest.mark.parametrize(
    "changes, verdict, reason, missing",
    [
        ({}, "unknown", "comes_and_goes", ()),
        ({"sea": True}, "undecided", "weather_may_mislead", ()),
        ({"comes_and_goes": 0.8}, "missing", "named", ("RudderWear",)),
        ({"unknown": 0.6}, "unknown", "unexplained", ()),
        ({"weather": (cause("Current", belongs_to="voyage"),)}, "unknown", "comes_and_goes", ()),
    ],
)
def test_a_force_that_comes_and_goes_is_no_cause_that_lasts(changes, verdict, reason, missing):
    answer = decide(facts(cause("RudderWear"), **{"comes_and_goes": 0.95, **changes}))
    assert (answer.verdict, answer.reason, answer.missing) == (verdict, reason, missing)
    assert (answer.not_named.get("RudderWear") == "comes_and_goes") == (not missing)


def test_one_of_rivals_that_comes_and_goes_has_its_reason_and_its_sentence():
    """Test: a cause of 60 %, or one that cannot be told from it of 97 %; and a likelier one that is not named.
    Expected: the sentence is about the one that comes and goes."""
    rival, other = cause("RudderWear", probability=0.6, with_rivals=0.97), cause("Loading", error_gain=0.0)
    answer = decide(facts(other, rival, comes_and_goes=0.95))
    assert answer.reason == "comes_and_goes" and answer.not_named["RudderWear"] == "comes_and_goes"
    candidates = [{"effect": name, "says": f"{name} says."} for name in ("Loading", "RudderWear")]
    said = answer.sentence({"candidates": candidates, "answer": {"not_named": answer.not_named}})
    assert "resembles RudderWear, which would last: RudderWear says." in said


def test_an_instrument_is_named_beside_a_force_that_comes_and_goes():
    bias = cause("HeadingBias", belongs_to="instrument")
    answer = decide(facts(cause("RudderWear"), bias, comes_and_goes=0.95))
    assert answer.missing == ("HeadingBias",) and answer.not_named == {"RudderWear": "comes_and_goes"}


def test_a_cause_that_could_not_be_named_anyhow_does_not_come_and_go():
    likely = cause("RudderWear", probability=0.6, with_rivals=0.6)
    assert decide(facts(likely, comes_and_goes=0.95)).reason == "cannot_tell"


@pytest.mark.parametrize(
    "changes, reason",
    [
        ({}, None),
        ({"probability": 0.7, "with_rivals": 0.85}, "unlikely"),
        ({"probability": 0.6, "with_rivals": 0.97}, None),
        ({"probability": 0.44, "with_rivals": 0.97}, "unlikely"),
        ({"error_gain": 0.02}, "no_nearer"),
        ({"in_explanation": False}, "not_in_explanation"),
        ({"belongs_to": "instrument", "error_gain": 0.0}, None),
        ({"belongs_to": "instrument", "significance": 2.0}, "not_significant"),
        ({"in_ship_file": True, "change": 1.0}, "change_within_form"),
        ({"in_ship_file": True, "change": 3.0}, None),
    ],
)
def test_why_an_effect_is_not_named(changes, reason):
    one = cause(**changes)
    f = facts(one, explanation=("HullFouling",), likeliest=("HullFouling",))
    assert why_not(f, one) == reason
    assert ("HullFouling" in decide(f).missing) is (reason is None)


@pytest.mark.parametrize(
    "changes, verdict, missing",
    [
        ({"belongs_to": "instrument"}, "missing", ("SpeedLogScale",)),
        ({"belongs_to": "instrument", "significance": 2.0}, "undecided", ()),
        ({"belongs_to": "ship"}, "undecided", ()),
    ],
)
def test_an_instrument_that_disagrees_is_named_although_nothing_explains_where_the_ship_went(
    changes, verdict, missing
):
    """Expected: it is named, and that more is missing said; a force is not, for it would have to explain that."""
    one = cause("SpeedLogScale", in_explanation=False, **changes)
    lost = replace(LEFT, error=2.5, share=1.1)
    answer = decide(facts(one, likeliest=("SpeedLogScale",), left=lost))
    assert (answer.verdict, answer.missing, answer.more) == (verdict, missing, verdict == "missing")


def test_a_second_cause_is_named_only_when_it_is_nearly_certain_and_the_one_that_explains_more_comes_first():
    first, second = cause(alone=30.0), cause("RudderWear", alone=90.0, probability=0.95)
    assert decide(facts(first, second)).missing == ("RudderWear", "HullFouling")
    unsure = replace(first, probability=SURE + 0.02)
    answer = decide(facts(unsure, second))
    assert answer.missing == ("RudderWear",) and answer.not_named == {"HullFouling": "second_not_sure"}


def test_lasting_causes_stand_before_the_weather_that_the_model_lacks():
    f = facts(cause("PropellerWear"), weather=(cause("Wind", belongs_to="voyage", probability=0.99),))
    assert decide(f).missing == ("PropellerWear", "Wind")


@pytest.mark.parametrize(
    "left, verdict, more",
    [
        (LEFT, "missing", False),
        (replace(LEFT, error=1.4, share=0.9), "missing", False),
        (replace(LEFT, error=2.5, share=0.9), "undecided", False),  # leads the ship elsewhere
        # takes away most of the error, and something more is missing
        (replace(LEFT, error=2.5, share=0.3), "missing", True),
        (replace(LEFT, error=None, share=None), "undecided", False),  # nobody asked where it leads
    ],
)
def test_what_an_explanation_may_leave_over(left, verdict, more):
    answer = decide(facts(cause(), left=left))
    assert (answer.verdict, answer.more) == (verdict, more)


def test_what_calibration_left_unexplained_forbids_no_answer_that_stands_clear_of_it():
    assert decide(facts(cause(), structural=(0.61, 0.2, 0.2))).missing == ("HullFouling",)


def test_in_a_sea_a_force_is_named_only_where_the_model_alone_leads_astray():
    assert decide(facts(cause(), sea=True, error_nothing=2.2)).missing == ("HullFouling",)
    assert decide(facts(cause(), sea=True, error_nothing=1.2)).missing == ()


def test_every_reason_for_not_naming_has_words_of_its_own():
    c = {"parameters": [], "error_with": 1.0, "error_without": 2.0, "posterior": 0.85, "probability": 0.42}
    reasons = [*(rule.reason for rule in CAUSE_RULES), SECOND_NOT_SURE]
    said = {reason: words(c, reason) for reason in reasons}
    assert len(set(said.values())) == len(said)
    assert said["unlikely"] == (
        "such an answer was true on 42 % of random ships, not often enough to name it"
    )


def test_a_cause_that_brings_nothing_beside_the_others_is_not_told_with_numbers_that_say_it_does():
    """Test: the model alone ends 0.82 m off and with the whole explanation 0.57 m, but with the other effects of
    it 0.55 m. Expected: no "does not reduce the error (0.57 m with it, 0.82 m without)"."""
    c = {"parameters": [], "error_with": 0.57, "error_without": 0.82, "posterior": 1.0, "probability": 1.0}
    said = words(c, "no_nearer")
    assert "with the other effects alone, or with fewer of them" in said and "0.570 m with it" in said
    assert "0.820" not in said and "0.820 m without" in words(c | {"error_with": 0.9}, "no_nearer")


def test_a_cause_of_the_explanation_that_is_not_likely_enough_is_told_so():
    unlikely = cause(probability=0.85, with_rivals=0.88)
    answer = decide(facts(unlikely))
    assert answer.reason == "not_named" and answer.not_named == {"HullFouling": "unlikely"}
    c = {
        "effect": "HullFouling",
        "parameters": [],
        "probability": 0.42,
        "posterior": 0.85,
        "error_with": 1.0,
        "error_without": 2.0,
    }
    said = answer.sentence({"candidates": [c], "answer": {"not_named": answer.not_named}})
    assert said == (
        "Undecided: the readings ask for HullFouling (42 %), but such an answer was true on 42 % of random "
        "ships, not often enough to name it."
    )


def test_a_cause_that_was_never_estimated_is_not_in_the_sentence():
    """Test: a cause is likely, but only with others, none of which was estimated, so that no candidate has
    its numbers. Expected: the answer has its reason, and the sentence says that the voyages cannot tell."""
    answer = decide(facts(cause(probability=0.81, in_explanation=False)))
    assert answer.not_named == {"HullFouling": "not_in_explanation"}
    said = answer.sentence({"candidates": [], "answer": {"not_named": answer.not_named}})
    assert said == "Undecided: these voyages cannot tell what, if anything, is missing."


def test_a_cause_is_unchanged_where_healthy_voyages_of_the_ship_show_as_much():
    """Test: a clear cause, and how many reference voyages a single cause explains as much. Expected: named where
    none reaches it or nobody knows, and not from a quarter of them on."""
    clear = facts(cause())
    assert decide(clear).missing == decide(replace(clear, reached=0.0)).missing == ("HullFouling",)
    told = decide(replace(clear, reached=0.25))
    assert told.missing == () and told.not_named == {"HullFouling": "as_on_references"}

"""What is named only with another cause in the model: asked again, added to the answer, fitted with it."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from tests.study.conftest import voyage
from tests.thorough import thorough
from twin.physics.effects import find
from twin.study.diagnosis import further, sentences
from twin.study.diagnosis.answer import answer
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.criteria import CLEAR
from twin.study.diagnosis.search import MAX_CAUSES

BIAS_RAD, EXTRA = 0.03, 0.3


@pytest.fixture(scope="module")
def biased(tanker):
    """A voyage of the tanker's own model with a compass bias and a fouled hull."""
    hidden = {"HeadingBias": {"bias": BIAS_RAD}, "HullFouling": {"extra": EXTRA}}
    effects = (find(name).absent(tanker).but(**numbers) for name, numbers in hidden.items())
    return voyage(*effects, seed=3, seconds=900.0, of=tanker)


@pytest.fixture(scope="module")
def half(tanker, biased):
    """An answer that names the bias alone."""
    found = answer(assemble([biased], tanker), [biased], tanker)
    assert set(found.causes) == {"HeadingBias", "HullFouling"}
    return replace(found, decision=replace(found.decision, missing=("HeadingBias",)))


@pytest.fixture(scope="module")
def whole(half, tanker, biased):
    return further.with_further(half, [biased], tanker)


@thorough
def test_a_cause_that_was_not_named_is_named_with_the_other_in_the_model(whole):
    assert whole.causes == ("HeadingBias", "HullFouling")
    assert whole.further == ("HullFouling",)
    assert "HullFouling" not in whole.decision.not_named


@thorough
def test_the_numbers_of_all_causes_come_from_one_fit(whole):
    found = whole.found[whole.shown]
    assert set(whole.causes) <= set(found.hypothesis.effects)
    size = {
        f"{u.owner}.{u.name}": u.centre + u.sd * z
        for u, z in zip(whole.case.effects, found.posterior.z, strict=True)
    }
    assert size["HeadingBias.bias"] == pytest.approx(BIAS_RAD, rel=0.2)
    assert size["HullFouling.extra"] == pytest.approx(EXTRA, rel=0.4)
    nothing = whole.found[whole.considered.base]
    assert found.open_loop_error_m < 0.5 * nothing.open_loop_error_m


@thorough
def test_the_whole_takes_its_place_among_the_rivals_with_the_evidence_of_its_path(whole):
    weights = [h.log_weight for h in whole.weighed]
    assert weights == sorted(weights, reverse=True)
    (entry,) = (h for h in whole.weighed if h.effects == whole.joined and h.scenario == _scenario(whole))
    own = whole.found[whole.joined].hypothesis
    assert entry.log_weight == whole.path.with_path(own).log_weight
    off = replace(whole.found[whole.joined], open_loop_error_m=1e3)
    astray = replace(whole.path, found={**whole.path.found, whole.joined: off})
    assert astray.with_path(own).log_weight < entry.log_weight <= own.log_weight


def _scenario(told):
    return told.found[told.joined].hypothesis.scenario


@thorough
def test_the_facts_are_those_of_the_whole(whole, half):
    facts = whole.considered.facts
    assert {c.effect for c in facts.causes} == set(whole.causes)
    assert set(whole.causes) <= set(facts.explanation)
    assert facts.error_nothing == half.considered.facts.error_nothing
    assert facts.left.error < facts.error_nothing


@thorough
def test_a_single_cause_stays_single_and_nothing_is_asked_twice(asked):
    found, said = asked("HeadingBias")
    assert (found["missing"], found["further"]) == (["HeadingBias"], [])
    assert said and not [line for line in said if line.startswith("asking again")]


@thorough
def test_a_second_look_is_taken_where_another_cause_would_add_to_the_evidence(half):
    assert further._more_may_be(half)
    without = {s: f for s, f in half.found.items() if "HullFouling" not in s}
    alone = replace(half, found=without)
    assert further._likeliest(alone) == tuple(n for n in further._likeliest(alone) if n != "HullFouling")
    assert further._more_may_be(alone)  # to first order, about the bias by itself


@pytest.mark.parametrize("causes", [(), ("HeadingBias", "HullFouling", "RudderWear")])
def test_an_answer_with_no_cause_or_with_as_many_as_there_may_be_is_not_asked_again(tanker, causes):
    """Expected: the answer itself, and no step of a second look, for which it holds nothing."""
    assert MAX_CAUSES == 3
    told, said = SimpleNamespace(causes=causes), []
    assert further.with_further(told, [], tanker, (), said.append) is told
    assert said == []


def test_the_sentence_says_what_shows_only_with_the_others():
    names = ["HeadingBias", "HullFouling", "RudderWear"]
    told = sentences.further_in_words({"further": names[1:]}, names)
    assert told == " HullFouling and RudderWear show only with HeadingBias in the model."
    assert sentences.further_in_words({"further": []}, names) == ""


@thorough
def test_what_comes_and_goes_in_the_first_answer_still_does_beside_a_further_cause(half):
    """Test: the first answer's cause comes and goes with 0.6, those of the second look do not. Expected: 0.6,
    for the probability of the first is told by it."""
    facts = replace(half.considered.facts, comes_and_goes=0.6)
    first = replace(half, considered=replace(half.considered, facts=facts))
    both = further._considered(first, half, ("HullFouling",), ("HeadingBias", "HullFouling"))
    assert half.considered.facts.comes_and_goes < both.facts.comes_and_goes == 0.6


@thorough
def test_weather_that_only_the_second_look_is_sure_of_is_as_probable_as_it_says(half):
    likely = replace(half.weights, weather={**half.weights.weather, "Current": 0.93})
    named = replace(half.decision, missing=("HullFouling", "Current"))
    again = replace(half, weights=likely, decision=named)
    assert half.weights.weather["Current"] < 0.5
    both = further._joined(half, again, ("HullFouling",))
    assert both.decision.missing == ("HeadingBias", "HullFouling", "Current")
    assert both.weights.weather["Current"] == 0.93


@thorough
def test_the_set_is_fitted_also_where_the_first_answer_stood_beside_other_water(half):
    """Beside a stream that the whole does without, no part of it was found: its guess is of first order."""
    stream = {("HeadingBias", "Current"): half.found[half.shown]}
    beside = replace(half, found=stream, joined=("HeadingBias", "Current"))
    found = further._fitted(beside, half.case.ordered(("HeadingBias", "HullFouling")))
    (at,) = (i for i, u in enumerate(half.case.effects) if (u.owner, u.name) == ("HeadingBias", "bias"))
    size = half.case.effects[at].centre + half.case.effects[at].sd * found.posterior.z[at]
    assert size == pytest.approx(BIAS_RAD, rel=0.2)


@thorough
def test_a_cause_that_ends_at_nothing_beside_the_others_is_not_one(half, whole):
    found = whole.found[whole.joined]
    assert further._stands(half, found, whole.causes)
    z = found.posterior.z.copy()
    z[[u.owner == "HullFouling" for u in whole.case.effects]] = 0.0
    gone = replace(found, posterior=replace(found.posterior, z=z))
    assert not further._stands(half, gone, whole.causes)


@thorough
@pytest.mark.parametrize("clearer, named", [(CLEAR + 0.1, True), (CLEAR - 0.1, False)])
def test_a_further_cause_makes_the_voyages_clearly_more_probable_in_the_same_fit(half, whole, clearer, named):
    """Test: the whole is more probable than the first answer alone by little more, or little less, than what
    counts as clear (20 to 1)."""
    found = whole.found[whole.joined]
    alone = max(
        f.hypothesis.log_weight for s, f in half.found.items() if half.case.causes(s) == ("HeadingBias",)
    )
    by = alone + clearer - found.hypothesis.log_weight
    moved = replace(found.hypothesis, log_evidence=found.hypothesis.log_evidence + by)
    assert further._stands(half, replace(found, hypothesis=moved), whole.causes) is named

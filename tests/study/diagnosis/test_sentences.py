"""How sure a diagnosis is stands in its words."""

import pytest

from twin.study.diagnosis import sentences
from twin.study.diagnosis.reasons import why_not


def cause(effect, probability, **errors):
    """A candidate as the JSON has it."""
    return {
        "effect": effect, "probability": probability, "parameters": [], "typical_force": dict.fromkeys(("X_N", "Y_N", "N_Nm"), 0.0), "says": "It slows the ship.",
        "cannot_be_told_from": [], "error_without": 90.0, "error_with": 30.0, "error_floor": 28.0,
    } | errors  # fmt: skip


def result(*causes, resembles=(), one_of=()):
    return {
        "missing": [c["effect"] for c in causes], "candidates": list(causes), "weather": [], "further": [],
        "resembles": list(resembles), "one_of": list(one_of), "more": False, "facts": {"left": {"error": 1.0}},
    }  # fmt: skip


@pytest.mark.parametrize(
    "probability, begins", [(0.76, "Missing"), (0.74, "Probably missing"), (0.46, "Perhaps missing")]
)
def test_a_cause_is_missing_probably_or_perhaps_as_its_probability_says(probability, begins):
    assert sentences.named(result(cause("HullFouling", probability))).startswith(f"{begins}: HullFouling (")


def test_of_two_causes_the_less_likely_says_how_the_answer_begins():
    said = sentences.named(result(cause("HullFouling", 0.95), cause("RudderWear", 0.6)))
    assert said.startswith("Probably missing: HullFouling (95 %) and RudderWear (60 %).")


@pytest.mark.parametrize("error_with, said", [(89.0, True), (60.0, False), (27.0, False)])
def test_an_effect_that_leads_the_ship_no_nearer_to_where_it_went_is_told_with_that(error_with, said):
    """Test: 90 m without what it resembles, and 28 m are usual. Expected: told where hardly a metre is won and the
    model still ends astray; not where a third is, nor where it ends as near as is usual."""
    words = sentences.resembles(result(resembles=[cause("SwayingMass", 0.86, error_with=error_with)]))
    assert "It resembles SwayingMass" in words
    assert (
        f"comes hardly nearer to where the ship went ({error_with:.1f} m, 90.0 m without" in words
    ) == said


def test_what_is_known_by_its_form_has_its_probability_among_those_of_which_one_is_missing():
    told = result(
        cause("Loading", 0.41), resembles=[cause("HullDamping", 0.35)], one_of=("Loading", "HullDamping")
    )
    assert sentences.one_of(told).startswith(
        "Undecided: probably Loading (41 %) or something like HullDamping (35 %) is missing"
    )


@pytest.mark.parametrize(
    "share, words", [(None, "single causes"), (0.0, "single causes"), (0.5, "instruments")]
)
def test_what_is_as_on_the_references_says_by_what_it_is(share, words):
    """Test: an instrument's cause that no, none or half of the references had as much of by kinematics.
    Expected: only the last is said of the instruments; of the others, single causes explained as much."""
    c = cause("HeadingBias", 0.95, on_references=share, posterior=0.95)
    assert words in why_not(c, "as_on_references")


def test_of_a_healthy_ship_in_a_stream_the_first_words_are_that_nothing_of_it_is_missing():
    stream = result(cause("Current", 0.99))
    assert sentences.weather_only(stream).startswith(
        "Of ship and instruments nothing is missing. What the model lacks is water and weather of these voyages: "
        "Current (99 %)"
    )
    assert sentences.weather_at_least(stream).startswith(
        "The model lacks water and weather of these voyages: "
    )


@pytest.mark.parametrize(
    "probability, not_named, says",
    [
        (0.13, {}, "something, but"),
        (0.7, {}, "HullFouling (70 %), but"),
        (0.7, {"HullFouling": "unlikely"}, "HullFouling (70 %), but"),
        (
            0.7,
            {"PropellerWear": "comes_and_goes"},
            "something that acts like PropellerWear and comes and goes",
        ),
    ],
)
def test_what_may_be_the_weather_is_called_by_a_name_only_where_that_is_likely(probability, not_named, says):
    told = result(cause("HullFouling", probability)) | {"answer": {"not_named": not_named}}
    assert f"the readings point to {says}" in sentences.weather(told)

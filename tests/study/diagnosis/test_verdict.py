"""From weighed hypotheses to probabilities: of each cause, of nothing, of what has no name; and how they are
told."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from twin.physics.effects import catalogue
from twin.study.diagnosis.consider import of_any_day
from twin.study.diagnosis.effect_diagnosis import too_small
from twin.study.diagnosis.refine import Found
from twin.study.diagnosis.sentences import weather_at_least
from twin.study.diagnosis.verdict import MOST_SAID, Weights, capped, group, rivals, weights
from twin.study.estimation.columns import Unknown
from twin.study.reference.evidence import Hypothesis


def case_of(*candidates, unnamed=()):
    known = catalogue()
    weather = [n for n in candidates if n in known and known[n].is_weather()]
    causes = lambda chosen: tuple(n for n in chosen if n not in weather)
    return SimpleNamespace(
        candidates=candidates,
        unnamed=unnamed,
        present=set(),
        catalogue=known,
        weather=tuple(weather),
        causes=causes,
        names=lambda chosen: tuple(n for n in causes(chosen) if n not in unnamed),
    )


def test_a_cause_is_as_probable_whatever_the_weather_beside_it():
    said = {("RudderWear",): 0.2, ("Wind", "RudderWear"): 0.5, ("Wind",): 0.2, (): 0.1}
    w = weights(
        case_of("Wind", "RudderWear"),
        [Hypothesis(s, "usual", math.log(p), 0.0) for s, p in said.items()],
        {},
    )
    assert w.effects == {"RudderWear": pytest.approx(0.7)} and w.nothing == pytest.approx(0.3)
    assert w.weather == {"Wind": pytest.approx(0.7)}


def test_water_that_moves_more_than_on_the_references_is_a_stream_that_changes():
    case = case_of("Current", "VaryingCurrent")
    w = weights(
        case, [Hypothesis((), "streaming", 0.0, 0.0), Hypothesis((), "usual", math.log(0.25), 0.0)], {}
    )
    assert w.weather["VaryingCurrent"] == pytest.approx(0.8) and w.nothing == pytest.approx(1.0)


def test_a_stream_that_may_change_and_did_not_is_told_as_a_steady_one_and_its_eddies_blame_no_cause():
    """Test: beside a stream that hardly changes nothing is missing; beside a steady one a compass would be
    off. Expected: no cause, and the stream is a steady one."""
    case = case_of("Current", "VaryingCurrent", "HeadingBias")
    case.ordered = lambda chosen: tuple(n for n in case.candidates if n in chosen)
    said = {("VaryingCurrent",): -3.0, ("Current", "HeadingBias"): -9.0, ("Current",): -20.0}
    weighed = [Hypothesis(s, "usual", says, 0.0) for s, says in said.items()]
    still = {
        s: Found(h, None, None, steady=s == ("VaryingCurrent",)) for s, h in zip(said, weighed, strict=True)
    }
    w = weights(case, weighed, still)
    assert w.nothing > 0.99 and w.weather["Current"] == pytest.approx(1.0)
    assert w.weather["VaryingCurrent"] == 0.0 and w.effects["HeadingBias"] < 0.01


@pytest.mark.parametrize("effect, unknown", [("WaveDrift", 0.0), ("Loading", 1.0)])
def test_water_that_the_sea_makes_restless_is_nothing_unknown_beside_the_seas_own_force(effect, unknown):
    assert weights(case_of(effect), [Hypothesis((effect,), "strange", 0.0, 0.0)], {}).unknown == unknown


@pytest.mark.parametrize("tank, unknown", [(-300.0, 0.0), (-105.0, 1.0)])
def test_what_is_known_by_its_form_alone_beside_an_effect_that_does_most_only_mends_its_form(tank, unknown):
    """Test: heel with a slack tank is 50 likelier (log) than heel alone; the tank alone far less likely than
    heel, or nearly as likely. Expected: heel is named in the first case, and in the second something has no
    name."""
    case = case_of("RollCoupling", "SwayingMass", unnamed=("SwayingMass",))
    said = {
        ("RollCoupling", "SwayingMass"): -50.0,
        ("RollCoupling",): -100.0,
        ("SwayingMass",): tank,
        (): -900.0,
    }
    w = weights(case, [Hypothesis(effects, "usual", says, 0.0) for effects, says in said.items()], {})
    assert w.unknown == pytest.approx(unknown) and w.effects["RollCoupling"] == pytest.approx(1.0)
    assert w.unnamed["SwayingMass"] == pytest.approx(1.0)


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
def test_of_which_few_effects_one_is_surely_there(chances, names):
    weighed = [Hypothesis((name,) if name else (), "usual", math.log(p), 0.0) for name, p in chances.items()]
    w = Weights(chances.get("", 0.0), 0.0, {n: p for n, p in chances.items() if n}, weighed[0])
    assert group(weighed, w) == names


def test_what_is_known_by_its_form_alone_may_be_one_of_the_few():
    """Test: a walking propeller or a tow, or a hull that is not alike on both sides. Expected: one of the three."""
    chances = {"PropellerWalk": 0.5, "HullAsymmetry": 0.26, "TowForce": 0.23, "": 0.01}
    weighed = [Hypothesis((name,) if name else (), "usual", math.log(p), 0.0) for name, p in chances.items()]
    w = Weights(0.01, 0.26, {"PropellerWalk": 0.5, "TowForce": 0.23}, weighed[0], {"HullAsymmetry": 0.26})
    assert group(weighed, w) == ["PropellerWalk", "HullAsymmetry", "TowForce"]


def test_no_probability_is_told_beyond_what_was_ever_measured():
    assert capped(1.0) == MOST_SAID and capped(0.0) == pytest.approx(1.0 - MOST_SAID) and capped(0.7) == 0.7


def test_rivals_are_told_with_how_far_they_are_behind_and_where_they_lead():
    weighed = [
        Hypothesis(("RudderWear",), "usual", -10.0, 0.0),
        Hypothesis(("RudderWear",), "rough", -11.0, 0.0),
        Hypothesis((), "usual", -17.0, 0.0),
    ]
    first, second = rivals(weighed, {("RudderWear",): Found(weighed[0], None, None, 0.0, 4.2, 5.0)})
    assert first == {"effects": ["RudderWear"], "scenario": "usual", "log_bayes_factor": 0.0, "error_m": 4.2}
    assert second["effects"] == [] and second["log_bayes_factor"] == -7.0 and second["error_m"] is None


def test_what_the_answer_lists_is_not_also_too_small_to_be_seen():
    """Test: a rudder's offset that at a plausible size would not have been seen, and is likely at twice that.
    Expected: listed, it is not said to be too small; unlikely, it is."""
    seen = {"RudderOffset": False, "RudderWear": False, "SpeedLogBias": True}
    assert too_small(seen, ["RudderOffset"]) == ["RudderWear"]
    assert too_small(seen, []) == ["RudderOffset", "RudderWear"]


@pytest.mark.parametrize("east_mps, ordinary", [(0.3, True), (-0.3, True), (0.5, False), (0.0, True)])
def test_a_stream_within_twice_what_the_references_scatter_by_is_of_any_day(east_mps, ordinary):
    """Test: references whose streams scatter by 0.2 m/s to north and east, prior widths 0.25 m/s. Expected: up to
    0.4 m/s on each axis it is nothing that is missing; without a word of the references any stream is."""
    effects = [
        Unknown("Current", name, "m/s", 0.0, 0.25, -2.0, 2.0, every_day=True) for name in ("north", "east")
    ]
    found = SimpleNamespace(
        hypothesis=Hypothesis(("Current",), "usual", 0.0, 0.0),
        posterior=SimpleNamespace(z=np.array([0.4, east_mps]) / [1.0, 0.25]),
    )
    daily = {"Current.north": 0.2, "Current.east": 0.2}
    known, unknown = (
        SimpleNamespace(effects=effects, nuisance=SimpleNamespace(daily=d), weather=("Current",))
        for d in (daily, {})
    )
    assert of_any_day(known, found) == ("Current",) * ordinary and of_any_day(unknown, found) == ()


def test_a_steady_push_is_a_cause_and_no_weather_of_any_day():
    """Else one answer could name it and say that it is not missing."""
    push = Unknown("ExternalForce", "north", "N", 0.0, 1.0, -9.0, 9.0, every_day=True)
    found = SimpleNamespace(
        hypothesis=Hypothesis(("ExternalForce",), "usual", 0.0, 0.0),
        posterior=SimpleNamespace(z=np.array([0.1])),
    )
    daily = SimpleNamespace(daily={"ExternalForce.north": 1.0})
    assert of_any_day(SimpleNamespace(effects=[push], nuisance=daily, weather=("Current",)), found) == ()


def test_beside_weather_that_is_named_the_causes_are_told_that_cannot_be_told_apart():
    result = {"missing": ["Current"], "candidates": [], "facts": {"left": {"error": 1.0}}, "more": False}
    result |= {"resembles": [], "one_of": []}
    assert weather_at_least(result).endswith("missing besides, these voyages cannot tell.")
    told = weather_at_least(result | {"one_of": ["Loading", "RudderWear"]})
    assert told.endswith("Beside it Loading or RudderWear: these voyages cannot tell which.")

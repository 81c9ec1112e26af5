"""What is left under the best explanation, beside what the reference voyages left."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from twin.physics.effects import catalogue, find
from twin.study.diagnosis import leftover
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.led import roughly
from twin.study.diagnosis.leftover import (
    ASTRAY,
    CLEAR,
    asked_for,
    changed,
    explaining,
    explains,
    helpful,
    missed,
    quiet,
    too_small,
    undone,
    weathered,
)
from twin.study.diagnosis.refine import Found
from twin.study.diagnosis.search import search
from twin.study.diagnosis.tell_diagnosis import sentence
from twin.study.estimation.columns import Unknown, with_values
from twin.study.reference.evidence import Hypothesis

UNDECIDED = {
    "verdict": "undecided",
    "candidates": [],
    "one_of": [],
    "voyages_hold_a_manoeuvre": True,
    "calibrated_too_coarsely": [],
    "undo_each_other": [],
    "unclear": [],
    "moments": [],
    "resembles": [],
    "weather_may_mislead": False,
}


def test_a_push_where_waves_toss_her_is_told_with_its_time_and_decides_nothing():
    pushed = {"voyage": "june", "start_s": 600.0, "end_s": 655.0, "X_N": -8e4, "Y_N": 0.0, "N_Nm": 0.0}
    said = sentence(
        UNDECIDED | {"moments": [pushed], "probabilities": {"unknown": 0.9, "nothing_missing": 0.1}}
    )
    assert said.startswith("Undecided: from 10:00 to 10:55 on june something pushed her") and "waves" in said


def test_what_the_readings_say_in_weather_that_may_mislead_is_told_with_that():
    likely = {
        "effect": "CrossFlowDrag",
        "probability": 0.99,
        "error_with": 4.0,
        "error_without": 6.0,
        "parameters": [],
    }
    said = sentence(UNDECIDED | {"candidates": [likely], "weather_may_mislead": True})
    assert "CrossFlowDrag (99%)" in said and "calmer" in said


@pytest.fixture(scope="module")
def judged(tanker, voyages):
    case = assemble([voyages["RudderWear"]], tanker)
    return case, search(case)[1][("RudderWear",)]


def test_under_its_true_cause_a_ship_is_as_quiet_as_on_her_reference_voyages(judged):
    assert quiet(*judged)


@pytest.mark.parametrize(
    "off_m, asked", [(0.9, ["RudderWear", "HeadingBias"]), (1.1, ["RudderWear", "TowForce", "HeadingBias"])]
)
def test_where_the_model_alone_leads_her_no_force_is_named_for_the_group_it_belongs_to(judged, off_m, asked):
    case, found = judged
    nothing = {(): replace(found, off_m=off_m, floor_m=1.0)}
    sure = {"RudderWear": 0.9, "TowForce": 0.4, "HeadingBias": 0.4}
    assert asked_for(case, nothing, sure, list(sure), rough=False) == asked


def as_if(found, **worlds):
    """The same hypothesis as likely as said in each of these worlds."""
    return [
        replace(found.hypothesis, world=w, log_evidence=e - found.hypothesis.log_prior)
        for w, e in worlds.items()
    ]


def test_a_ship_that_is_tossed_about_is_not_quiet(judged):
    case, found = judged
    (line,) = case.lines
    swing = 0.2 * np.sin(2.0 * np.pi / 20.0 * line.track.t)
    state, measured = line.shown.state.copy(), line.shown.measured.copy()
    for column in (state[:, 4], measured[:, 4], measured[:, 7]):
        column += swing
    assert not quiet(
        replace(case, lines=(replace(line, shown=replace(line.shown, state=state, measured=measured)),)),
        found,
    )


def test_a_world_that_is_clearly_rougher_is_no_explanation_unless_a_sea_was_measured(judged):
    case, found = judged
    nothing = replace(found, off_m=1.5)
    rough, plain = as_if(found, rough=0.0, usual=-CLEAR - 0.1)
    off, led = (replace(found, hypothesis=rough, off_m=x, floor_m=1.0) for x in (1.1, 0.9))
    assert not explains(case, [rough, plain], off, nothing)
    assert explains(case, [rough, plain], led, nothing)
    assert explains(case, [rough, replace(plain, log_evidence=plain.log_evidence + 0.2)], off, nothing)
    # what the path says counts for all worlds alike
    astray = [replace(h, log_evidence=h.log_evidence - 50.0) for h in (plain, rough)]
    assert explains(case, astray, found, nothing)
    (track,) = case.tracks
    waves = np.full(len(track), 0.01 * case.model.ship.L_pp)
    assert explains(
        replace(case, tracks=(replace(track, weather=dict(track.weather) | {"H_s": waves}),)),
        [rough],
        off,
        nothing,
    )


@pytest.mark.parametrize(
    "off_m, asked",
    [(1.4, ["WaveDrift", "HeadingBias"]), (1.6, ["CrossFlowDrag", "WaveDrift", "HeadingBias"])],
)
def test_in_a_sea_in_which_the_model_alone_leads_her_nearly_no_force_but_the_seas_own_is_named(
    judged, off_m, asked
):
    case, found = judged
    sure = dict.fromkeys(["CrossFlowDrag", "WaveDrift", "HeadingBias"], 0.99)
    nothing = {(): replace(found, off_m=off_m, floor_m=1.0)}
    assert asked_for(case, nothing, sure, list(sure), rough=True) == asked
    knows = replace(case, model=case.model.but(find("WaveDrift").plausible(case.model.ship)))
    # a change of it the readings must ask for
    assert asked_for(knows, nothing, sure, list(sure), rough=True) == [n for n in asked if n != "WaveDrift"]


@pytest.mark.parametrize("more, asked", [(2.0, []), (4.0, ["Wind"])])
def test_a_change_of_a_wind_that_the_file_knows_must_be_asked_for_by_the_readings_too(judged, more, asked):
    case, found = judged
    knows = replace(case, model=case.model.but(find("Wind").plausible(case.model.ship)))
    before = replace(found, off_m=3.0, floor_m=1.0, hypothesis=Hypothesis((), "usual", 100.0, 0.0))
    sets = {
        (): before,
        ("Wind",): replace(before, off_m=0.9, hypothesis=Hypothesis(("Wind",), "usual", 100.0 + more, 0.0)),
    }
    assert asked_for(knows, sets, {"Wind": 0.99}, ["Wind"], rough=False) == asked
    assert asked_for(case, sets, {"Wind": 0.99}, ["Wind"], rough=False) == ["Wind"]


@pytest.mark.parametrize("more, asked", [(50.0, []), (70.0, ["RudderWear"])])
def test_what_stands_far_above_all_that_a_known_wind_misleads_to_is_named_but_not_in_a_sea(
    judged, more, asked
):
    case, found = judged
    nothing = replace(found, off_m=1.2, floor_m=1.0, hypothesis=Hypothesis((), "usual", 100.0, 0.0))
    sets = {
        (): nothing,
        ("RudderWear",): replace(
            nothing, off_m=0.9, hypothesis=Hypothesis(("RudderWear",), "usual", 100.0 + more, 0.0)
        ),
    }
    assert asked_for(case, sets, {"RudderWear": 0.99}, ["RudderWear"], rough=True) == asked
    (track,) = case.tracks
    waves = np.full(len(track), 0.01 * case.model.ship.L_pp)
    at_sea = replace(case, tracks=(replace(track, weather=dict(track.weather) | {"H_s": waves}),))
    assert asked_for(at_sea, sets, {"RudderWear": 0.99}, ["RudderWear"], rough=True) == []


def test_a_known_wind_misleads_where_a_tenth_of_it_matters_to_where_she_went(tanker, voyages):
    windy = tanker.with_effects(find("Wind").plausible(tanker))
    hers = replace(
        windy, notes={**windy.notes, "structural": windy.notes["structural"] | {"beside_effects": ["Wind"]}}
    )
    since, then = (assemble([voyages["Wind"]], ship) for ship in (windy, hers))
    nothing = lambda floor_m: Found(
        Hypothesis((), "usual", 0.0, 0.0), None, since.model, 0.0, floor_m, floor_m
    )
    matters = roughly(since)
    assert (
        matters > 0.0
        and weathered(since, nothing(2.0 * matters))
        and not weathered(since, nothing(4.0 * matters))
    )
    assert not weathered(then, nothing(2.0 * matters))


def test_what_was_so_unlikely_that_nobody_asked_where_it_leads_her_explains_nothing(judged):
    case, found = judged
    assert not explains(case, [found.hypothesis], replace(found, off_m=np.nan), replace(found, off_m=1.5))


def test_where_the_best_leaves_too_much_a_part_that_cannot_be_told_from_it_may_explain(judged):
    case, found = judged
    best = replace(found.hypothesis, effects=("RudderWear", "SteeringLag"), world="usual", log_evidence=0.0)
    part = replace(
        found.hypothesis, world="usual", log_evidence=best.log_weight - found.hypothesis.log_prior - 1.0
    )
    sets = {
        (): replace(found, hypothesis=replace(part, effects=()), off_m=1.5, floor_m=0.9),
        best.effects: replace(found, hypothesis=best, off_m=2.5, floor_m=1.0),
        part.effects: replace(found, hypothesis=part, off_m=0.9, floor_m=1.0),
    }
    assert explaining(case, [best, part], sets) == part.effects
    assert explaining(case, [best, replace(part, log_evidence=part.log_evidence - 3.0)], sets) == ()


def test_what_leads_her_elsewhere_explains_nothing_however_quiet_it_leaves_her(judged):
    case, found = judged
    nothing = replace(found, off_m=5.0)
    assert explains(case, [found.hypothesis], replace(found, off_m=1.4, floor_m=0.8), nothing)
    assert not explains(case, [found.hypothesis], replace(found, off_m=(ASTRAY + 0.1), floor_m=1.0), nothing)


def test_what_leads_her_little_of_the_way_must_end_nearer_to_where_she_went(judged):
    case, found = judged
    far = replace(found, off_m=1.8, floor_m=1.0)
    assert explains(case, [found.hypothesis], far, replace(found, off_m=2.5))
    assert not explains(case, [found.hypothesis], far, replace(found, off_m=2.3))
    assert explains(case, [found.hypothesis], replace(far, off_m=1.4), replace(found, off_m=1.5))


def test_what_leads_her_most_of_the_way_explains_whatever_is_left(judged):
    case, found = judged
    far = replace(found, off_m=10.0, floor_m=1.0, hypothesis=replace(found.hypothesis, world="rough"))
    assert explains(case, [far.hypothesis], far, replace(found, off_m=30.5))
    assert not explains(case, [far.hypothesis], far, replace(found, off_m=29.5))


def test_as_long_as_others_may_do_better_more_is_asked(monkeypatch, judged):
    case, found = judged
    far = replace(found, off_m=1.8, floor_m=1.0)
    assert explains(case, [found.hypothesis], far, replace(found, off_m=3.7), strict=True)
    assert not explains(case, [found.hypothesis], far, replace(found, off_m=3.5), strict=True)
    # restless one step ahead, and led where she went
    monkeypatch.setattr(leftover, "quiet", lambda *_: False)
    near, nothing = replace(found, off_m=0.9, floor_m=1.0), replace(found, off_m=1.5)
    assert explains(case, [found.hypothesis], near, nothing)
    assert not explains(case, [found.hypothesis], near, nothing, strict=True)
    assert not explains(case, [found.hypothesis], replace(near, off_m=1.1), nothing)


@pytest.mark.parametrize(
    "delay, travel_time, other",
    [(1.0, 25.0, False), (1.5, 31.0, True), (4.0, 25.0, True), (1.5, 25.0, False)],
)
def test_what_the_ship_has_is_otherwise_only_by_more_than_its_form_may_be_off(delay, travel_time, other):
    """Test: a gear in the ship's file, 1.5 s and 25 s; its dead time may be off by half, the other by a tenth
    (one standard deviation)."""
    own = [
        Unknown("SteeringLag", name, "s", centre, sd, 0.0, 300.0)
        for name, centre, sd in (("delay", 1.5, 0.5), ("travel_time", 25.0, 10.0))
    ]
    z = np.array([(value - u.centre) / u.sd for value, u in zip((delay, travel_time), own, strict=True)])
    found = SimpleNamespace(posterior=SimpleNamespace(z=z))
    case = SimpleNamespace(present={"SteeringLag"}, catalogue=catalogue(), effects=own)
    assert changed(case, found, "SteeringLag") is other
    assert changed(SimpleNamespace(present=set()), found, "SteeringLag")


@pytest.mark.parametrize("effects, off, named", [
    (("RudderWear",), 0.9, ("RudderWear",)), (("RudderWear",), 0.99, ()), (("GyroBias",), 1.0, ("GyroBias",)),
    (("GyroBias", "RudderWear"), 1.0, ("GyroBias",)), (("GyroBias", "RudderWear"), 0.9, ("GyroBias", "RudderWear")),
    (("WaveDrift",), 1.05, ("WaveDrift",)), (("WaveDrift",), 1.15, ()),
])  # fmt: skip
def test_a_force_must_lead_her_better_than_without_it_and_a_fault_of_an_instrument_need_not(
    judged, effects, off, named
):
    case, found = judged
    clear = replace(
        found.posterior, z=np.ones(len(case.effects)), covariance=0.01 * np.eye(len(case.effects))
    )
    found = replace(found, off_m=1.0, floor_m=0.5, posterior=clear)
    led = dict.fromkeys(((), ("GyroBias",), ("RudderWear",)), found) | {effects: replace(found, off_m=off)}
    assert helpful(case, led, effects) == list(named)


def test_an_instruments_fault_is_named_only_if_one_of_its_numbers_is_clear(judged):
    case, found = judged
    rows = [i for i, u in enumerate(case.effects) if u.owner == "SensorDelay"]
    z, covariance = np.zeros(len(case.effects)), np.eye(len(case.effects))
    covariance[np.ix_(rows, rows)] = [[0.04, 0.039], [0.039, 0.04]]  # each to 0.2, their difference to 0.045
    alone = ("SensorDelay",)
    for delay, turned, named in (
        (0.3, 0.0, []),
        (0.3, -0.5, []),
        (0.7, 0.7, ["SensorDelay"]),
        (0.7, 0.0, ["SensorDelay"]),
    ):
        z[rows] = delay, turned
        led = {
            s: replace(
                found,
                off_m=0.9,
                floor_m=1.0,
                posterior=replace(found.posterior, z=z.copy(), covariance=covariance),
            )
            for s in ((), alone)
        }
        assert helpful(case, led, alone) == named and not too_small(case, led, alone, rough=False)
    undecided = UNDECIDED | {"unclear": ["SensorDelay"]}
    one = {
        "effect": "SensorDelay",
        "probability": 0.99,
        "parameters": [],
        "error_with": 1.0,
        "error_without": 1.0,
    }
    assert ("SensorDelay (99%), but not one of its numbers is clearly") in sentence(
        undecided | {"candidates": [one]}
    )


def test_a_force_that_stands_alone_is_too_small_to_show_where_she_is_led_already_but_not_in_a_sea(judged):
    case, found = judged
    led = {
        (): replace(found, off_m=0.9, floor_m=1.0),
        ("RudderWear",): replace(found, off_m=0.9, floor_m=1.0),
    }
    assert too_small(case, led, ("RudderWear",), rough=False)
    assert too_small(
        case, led | {("RudderWear",): replace(found, off_m=0.99, floor_m=1.0)}, ("RudderWear",), rough=False
    )
    # it leads her astray
    assert not too_small(
        case, led | {("RudderWear",): replace(found, off_m=1.01, floor_m=1.0)}, ("RudderWear",), rough=False
    )
    assert not too_small(
        case, led | {(): replace(found, off_m=1.01, floor_m=1.0)}, ("RudderWear",), rough=False
    )
    pair = ("RudderWear", "Wind")
    assert not too_small(case, led | {("Wind",): led[()], pair: led["RudderWear",]}, pair, rough=False)
    (track,) = case.tracks
    waves = np.full(len(track), 0.01 * case.model.ship.L_pp)
    tossed = replace(case, tracks=(replace(track, weather=dict(track.weather) | {"H_s": waves}),))
    assert weathered(tossed, led[()]) and not weathered(case, led[()])
    assert not too_small(tossed, led, ("RudderWear",), rough=True)
    # waves' own force comes and goes, and leads her anywhere within the floor
    for off_m, small in ((0.9, True), (0.99, True), (1.01, False)):
        assert (
            too_small(
                tossed,
                led | {("WaveDrift",): replace(found, off_m=off_m, floor_m=1.0)},
                ("WaveDrift",),
                rough=True,
            )
            is small
        )


def test_and_it_is_said_how_far_off_that_is():
    path = {"horizon_s": 120.0, "error_without": 31.6, "error_floor": 12.4}
    silent = {"nothing_missing": 0.9, "unknown": 0.0}
    result = UNDECIDED | {"probabilities": silent, "path": path}
    assert "after 120 s the model ends 31.6 m from where she went (12.4 m would be usual)" in sentence(result)
    assert "what, if anything" in sentence(result | {"path": path | {"error_without": 13.0}})


def test_on_a_ship_that_does_not_go_where_the_model_leads_her_something_may_be_missing_and_nobody_is_acquitted(
    judged,
):
    _, found = judged
    assert missed(replace(found, off_m=1.51, floor_m=1.0)) and not missed(
        replace(found, off_m=1.49, floor_m=1.0)
    )


def test_and_else_it_is_said_that_she_goes_hardly_elsewhere_than_she_is_led():
    path = {"horizon_s": 48.0, "error_without": 1.93, "error_floor": 1.93}
    result = UNDECIDED | {"probabilities": {"nothing_missing": 0.0, "unknown": 1.0}, "path": path}
    assert (
        "leads her no clearly farther off than usual (1.93 m after 48 s, 1.93 m would be usual)"
    ) in sentence(result)
    assert "where she went (" not in sentence(result | {"path": path | {"error_without": 3.0}})


@pytest.mark.parametrize(("ahead_m", "no_pair"), [(16.0, True), (-16.0, False), (60.0, False)])
def test_a_late_position_and_an_antenna_as_far_ahead_as_she_sails_meanwhile_are_no_pair(
    judged, ahead_m, no_pair
):
    case, found = judged
    pair = ("AntennaOffset", "SensorDelay")
    delay_s = 16.0 / float(np.mean(case.tracks[0].state[:, 3]))
    sizes = {"AntennaOffset.ahead": ahead_m, "SensorDelay.delay": delay_s, "SensorDelay.turned": delay_s}
    own = [u for u in case.effects if u.label in sizes]
    model = with_values(case.model, own, [sizes[u.label] for u in own], case.catalogue)
    both = replace(found, model=model, hypothesis=replace(found.hypothesis, effects=pair))
    assert undone(case, both) is no_pair
    assert not undone(
        case, replace(both, hypothesis=replace(found.hypothesis, effects=("RudderWear", "SensorDelay")))
    )
    said = sentence(UNDECIDED | {"undo_each_other": list(pair)})
    assert "AntennaOffset and SensorDelay would fit, but each takes back" in said


def test_two_faults_of_a_log_may_undo_each_other_for_they_do_not_move_her(judged):
    case, found = judged
    sizes = {
        "SpeedLogBias.bias": 0.5,
        "SpeedLogScale.scale": -0.5 / float(np.mean(case.tracks[0].state[:, 3])),
    }
    own = [u for u in case.effects if u.label in sizes]
    model = with_values(case.model, own, [sizes[u.label] for u in own], case.catalogue)
    assert not undone(
        case,
        replace(
            found,
            model=model,
            hypothesis=replace(found.hypothesis, effects=("SpeedLogBias", "SpeedLogScale")),
        ),
    )

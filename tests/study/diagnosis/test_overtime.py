"""Whether an effect was there all the time: asked of each part of the voyages."""

from dataclasses import replace

import numpy as np
import pytest

from tests.study.conftest import voyage
from tests.study.diagnosis.test_decision import cause, facts
from tests.thorough import thorough
from twin.physics.effects import find
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.decision import decide
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.diagnosis.overtime import changes, log_bayes_factor, varying
from twin.study.diagnosis.refine import refine
from twin.study.diagnosis.tell_diagnosis import terminal_lines


def parts(result, name):
    return next(c for c in result["candidates"] if c["effect"] == name)["over_time"]


def test_an_effect_that_is_always_there_is_as_strong_in_every_part(diagnosed):
    result = diagnosed("RudderWear")
    found = parts(result, "RudderWear")
    assert len(found) > 1 and not changes(found)
    assert all(abs(p["share"] - 1.0) < 4.0 * p["sd"] + 0.25 for p in found)
    assert not any("its size changes with time" in line for line in terminal_lines(result))


@thorough
def test_an_effect_that_came_between_two_voyages_is_found_and_told_by_voyage(tanker, voyages):
    """Half of the time it was not there: that is no force that comes and goes as the ship sails."""
    result = diagnose([voyages["nothing"], voyages["RudderWear"]], tanker).result
    assert [c["effect"] for c in result["candidates"] if c["probability"] > 0.5] == ["RudderWear"]
    assert set(result["missing"]) <= {"RudderWear"}
    assert "comes_and_goes" not in (result["reason"], *result["answer"]["not_named"].values())
    found = parts(result, "RudderWear")
    share = {
        name: np.mean([p["share"] for p in found if p["voyage"] == name])
        for name in {p["voyage"] for p in found}
    }
    before, after = share[voyages["nothing"].name], share[voyages["RudderWear"].name]
    assert changes(found) and before < 0.5 < 1.0 < after
    assert any("its size changes with time" in line for line in terminal_lines(result))


def test_parts_that_know_little_do_not_disagree():
    part = {"voyage": "v", "start_s": 0.0, "end_s": 1.0}
    assert not changes([part | {"share": 0.0, "sd": 0.5}, part | {"share": 1.5, "sd": 0.5}])
    assert changes([part | {"share": 0.0, "sd": 0.1}, part | {"share": 1.5, "sd": 0.1}])
    assert not changes([])


def sizes(*shares, sd=0.2, voyage="v"):
    return [{"voyage": voyage, "share": share, "sd": sd} for share in shares]


def test_sizes_that_scatter_within_a_voyage_speak_against_one_that_lasts():
    """By hand, one voyage, shares 0 and 2 with s.d. 0.2, form 0.25: of a scatter of 1.4, 2.0625 in place of
    0.1025 in each variance: -1/2 ln(2.0625 / 0.1025) + 1/2 (2) (1 / 0.1025 - 1 / 2.0625) = 7.77."""
    assert np.isclose(log_bayes_factor(sizes(0.0, 2.0)), 7.77, atol=0.01)
    assert log_bayes_factor(sizes(0.9, 1.1, 1.0, 1.2)) < -1.0
    assert log_bayes_factor(sizes(0.0, 2.0, sd=2.0)) < 0.5


def test_another_size_on_another_day_is_no_scatter():
    both = sizes(0.0, 0.1, 0.0) + sizes(2.0, 2.1, 1.9, voyage="w")
    assert log_bayes_factor(both) < 0.0 < log_bayes_factor([p | {"voyage": "v"} for p in both])


def test_only_of_what_belongs_to_the_ship_it_is_asked_whether_it_varies(case_of):
    case = case_of("RudderWear")
    beside = refine(case, ("RudderWear", "Current"), "usual", np.ones(len(case.effects)), ())[0]
    told = varying(case, beside)
    assert list(told) == ["RudderWear"] and told["RudderWear"] < 0.3


@pytest.mark.parametrize("fouled_before", [True, False])
def test_growth_that_is_there_for_half_of_a_voyage_is_no_growth(tanker, fouled_before):
    """Test: 25 min with growth on the hull, and before them, as a part of the same voyage, as many with it or
    without. Expected: it varies (90 % and more) where it was not there all the time."""
    growth = find("HullFouling").absent(tanker).but(extra=0.6)
    before, after = voyage(*[growth] * fouled_before, of=tanker, seed=3), voyage(growth, of=tanker, seed=4)
    later = after.time_s - after.time_s[0] + before.time_s[-1] + 120.0
    columns = {name: np.append(x, after.columns[name]) for name, x in before.columns.items()}
    case = assemble([before.with_rows(np.append(before.time_s, later), columns)], tanker)
    found = refine(case, ("HullFouling",), "usual", np.ones(len(case.effects)), ())[0]
    varies = varying(case, found)["HullFouling"]
    assert varies < 0.5 if fouled_before else varies > 0.9


@thorough
def test_of_three_voyages_each_is_asked_in_parts_of_its_own(tanker):
    """Test: growth for the second half of each of three voyages of 24 min, asked together. Expected: it varies,
    as it would on one of them."""
    growth = find("HullFouling").absent(tanker).but(extra=0.6)
    halves = []
    for k in range(3):
        before, after = (voyage(*e, of=tanker, seed=3 + k, seconds=720.0) for e in ((), (growth,)))
        later = after.time_s - after.time_s[0] + before.time_s[-1] + 120.0
        columns = {name: np.append(x, after.columns[name]) for name, x in before.columns.items()}
        halves.append(before.with_rows(np.append(before.time_s, later), columns))
    case = assemble(halves, tanker)
    found = refine(case, ("HullFouling",), "usual", np.ones(len(case.effects)), ())[0]
    assert varying(case, found)["HullFouling"] > 0.9


def test_what_varies_within_a_voyage_is_no_cause_of_the_ship_and_the_others_are_named():
    fouled = cause("HullFouling", varies=0.95)
    assert decide(facts(fouled)).reason == "comes_and_goes"
    assert decide(facts(replace(fouled, varies=0.8))).missing == ("HullFouling",)
    towed = replace(fouled, effect="TowForce", belongs_to="voyage")
    assert decide(facts(towed)).missing == ("TowForce",)
    answer = decide(facts(fouled, cause("RudderWear")))
    assert answer.missing == ("RudderWear",) and answer.not_named == {"HullFouling": "comes_and_goes"}

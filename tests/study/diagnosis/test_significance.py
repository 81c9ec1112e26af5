"""How clear the numbers of an effect are, and how far from what the ship's file has."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from twin.physics.effects import catalogue
from twin.study.diagnosis.consider import change, joint_significance, significance
from twin.study.diagnosis.refine import refine
from twin.study.diagnosis.tell_diagnosis import candidate_lines
from twin.study.estimation.columns import Unknown


@pytest.fixture(scope="module")
def judged(case_of):
    case = case_of("RudderWear")
    return case, refine(case, ("RudderWear",), "usual", np.ones(len(case.effects)), ())[0]


@pytest.mark.parametrize(
    "delay, travel_time, other", [(1.0, 25.0, 0.67), (1.5, 31.0, 2.4), (4.0, 25.0, 3.33), (1.5, 25.0, 0.0)]
)
def test_how_far_what_the_ship_has_is_from_its_file_over_what_its_form_may_be_off(delay, travel_time, other):
    """Test: a gear in the ship's file, 1.5 s and 25 s; its dead time may be off by half, the other by a tenth
    (one standard deviation)."""
    own = [
        Unknown("SteeringLag", name, "s", centre, sd, 0.0, 300.0)
        for name, centre, sd in (("delay", 1.5, 0.5), ("travel_time", 25.0, 10.0))
    ]
    z = np.array([(value - u.centre) / u.sd for value, u in zip((delay, travel_time), own, strict=True)])
    found = SimpleNamespace(posterior=SimpleNamespace(z=z))
    case = SimpleNamespace(present={"SteeringLag"}, catalogue=catalogue(), effects=own)
    assert change(case, found, "SteeringLag") == pytest.approx(other, abs=0.01)
    assert change(SimpleNamespace(present=set()), found, "SteeringLag") == 0.0


def clear(judged, name, z, covariance):
    """Significance of an effect whose first numbers are these, known so well; its others stand at nothing."""
    case, found = judged
    rows = [i for i, u in enumerate(case.effects) if u.owner == name]
    all_z, all_c = np.zeros(len(case.effects)), np.eye(len(case.effects))
    all_c[np.ix_(rows, rows)] = covariance
    all_z[rows] = z
    known = replace(found.posterior, z=all_z, covariance=all_c)
    return significance(case, replace(found, posterior=known), name)


def together(judged, z, covariance, intervals):
    """What is told of a screw whose two numbers are these, with these 95 % intervals."""
    case, found = judged
    rows = [i for i, u in enumerate(case.effects) if u.owner == "PropellerWalk"]
    all_z, all_c = np.zeros(len(case.effects)), np.eye(len(case.effects))
    all_z[rows], all_c[np.ix_(rows, rows)] = z, covariance
    known = replace(found, posterior=replace(found.posterior, z=all_z, covariance=all_c))
    names = [case.effects[i].full_name for i in rows]
    numbers = [{"name": n, "low95": a, "high95": b} for n, (a, b) in zip(names, intervals, strict=True)]
    return joint_significance(case, known, "PropellerWalk", numbers)


NEAR = 0.25 - 0.5 * 0.05**2  # covariance of two numbers known to 0.5, and their difference to 0.05
ALIKE = [[0.25, NEAR], [NEAR, 0.25]]


def test_an_effect_of_which_no_number_is_clear_alone_says_how_clear_all_are(judged):
    around = [(-0.3, 1.7), (-1.0, 1.0)]
    assert together(judged, [0.7, 0.0], ALIKE, around) == pytest.approx(14.0, rel=0.05)


def test_an_effect_with_a_number_that_is_clear_alone_needs_no_such_word(judged):
    assert together(judged, [0.7, 0.0], ALIKE, [(0.1, 1.7), (-1.0, 1.0)]) is None


def test_numbers_that_are_not_clear_together_are_not_called_so(judged):
    assert together(judged, [0.3, 0.0], [[0.25, 0.0], [0.0, 0.25]], [(-0.7, 1.3), (-1.0, 1.0)]) is None


def test_one_number_is_as_clear_as_its_standard_deviations_from_none(judged):
    assert clear(judged, "GyroBias", [0.7], [[0.04]]) == pytest.approx(3.5)


def test_two_numbers_that_are_known_by_their_difference_alone_are_clear_together(judged):
    """Test: two numbers, 0.7 and none, each known to 0.5, their difference to 0.05.
    Expected: far clearer than either, 0.7/0.5."""
    alike = 0.25 - 0.5 * 0.05**2
    assert clear(judged, "PropellerWalk", [0.7, 0.0], [[0.25, alike], [alike, 0.25]]) > 10.0


def test_a_second_number_that_says_nothing_makes_an_effect_no_clearer(judged):
    both = clear(judged, "PropellerWalk", [0.7, 0.0], [[0.04, 0.0], [0.0, 0.04]])
    assert 3.0 < both < 3.5


def test_numbers_that_no_chance_makes_are_told_by_their_distance(judged):
    assert clear(judged, "PropellerWalk", [60.0, 0.0], np.eye(2)) == pytest.approx(60.0, abs=0.5)


A_LENGTH = {"name": "a", "value": 0.7, "low95": -0.3, "high95": 1.7, "unit": "m", "at_box_end": False,
            "meaning": "ahead of midship"}  # fmt: skip


def cause_with(numbers):
    return {
        "effect": "PropellerWalk",
        "probability": 0.9,
        "together_with": [],
        "parameters": numbers,
        "typical_force": {"X_N": 0.0, "Y_N": 0.0, "N_Nm": 0.0},
        "error_horizon_s": 60.0,
        "error_without": 5.0,
        "error_with": 2.0,
        "error_floor": 2.0,
        "cannot_be_told_from": [],
        "together_sd": 6.2,
    }


def test_the_text_says_why_a_cause_is_named_of_which_no_number_is_clear_alone():
    """Expected: of what the ship file has, another word; of others, nothing."""
    cause = cause_with([A_LENGTH])
    assert "may be none" in "\n".join(candidate_lines(cause)) and "6.2" in "\n".join(candidate_lines(cause))
    filed = cause | {"parameters": [A_LENGTH | {"in_ship_file": 0.1}]}
    assert "may be what the ship file has" in "\n".join(candidate_lines(filed))
    assert "alone" not in "\n".join(candidate_lines(cause | {"together_sd": None}))


def test_a_size_without_a_unit_says_of_what_it_is_a_share():
    """Expected: a number in metres says nothing more; a share is followed by what the number is."""
    share = A_LENGTH | {"name": "loss", "unit": "-", "meaning": "share of the thrust that is lost"}
    lines = candidate_lines(cause_with([share, A_LENGTH]))
    assert "loss" in lines[1] and lines[2].strip() == "share of the thrust that is lost"
    assert not any("midship" in line for line in lines)

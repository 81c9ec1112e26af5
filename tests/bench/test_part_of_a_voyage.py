"""What is said of a cause that acts for a part of a voyage: that it acts then alone, and how answers count."""

from dataclasses import replace

import numpy as np
import pytest

from bench.fleet.part_of_a_voyage import ACTING, answer, table, unasked
from bench.fleet.plausibility import build
from bench.fleet.voyage_plan import FleetCase, sailed
from tests.study.diagnosis.test_decision import cause, facts
from twin.study.diagnosis.decision import decide


def test_a_force_that_acts_in_the_second_half_leaves_the_first_as_it_was():
    ship = build("planing", 3)
    case = FleetCase("planing", 3, 1, "single", {"HullFouling": 1.0})
    always, later, never = (sailed(ship, case, of) for of in ((0.0, 1.0), ACTING["HullFouling"], (2.0, 3.0)))
    half = always.time_s.size // 2
    shown = [np.nan_to_num(one.columns["surge_velocity_mps"]) for one in (always, later, never)]
    assert np.array_equal(shown[1][: half - 2], shown[2][: half - 2])
    assert not np.array_equal(shown[0][: half - 2], shown[2][: half - 2])
    assert not np.array_equal(shown[1][half:], shown[2][half:])


@pytest.mark.parametrize(
    ("reason", "missing", "kind"),
    [
        ("comes_and_goes", [], "no name"),
        ("weather", ["Current"], "no name"),
        ("named", ["HullFouling", "Current"], "itself"),
        ("named", ["PropellerWear"], "another name"),
        ("nothing", [], "nothing missing"),
        ("weather_only", ["Current"], "nothing missing"),
    ],
)
def test_which_answer_it_is(reason, missing, kind):
    assert answer(reason, missing, "HullFouling") == kind


def test_what_would_have_been_said_stands_in_brackets():
    f = facts(replace(cause("HullFouling"), varies=0.97))
    said = decide(f)
    row = {"hidden": "HullFouling", "facts": f.as_json(), "reason": said.reason, "missing": said.missing}
    assert (said.missing, decide(unasked(f)).missing) == ((), ("HullFouling",))
    line = next(x for x in table([row, {"hidden": "TowForce", "failed": "no"}]) if "HullFouling" in x)
    assert line == "| HullFouling | 1 | 1 (0) | 0 (1) | 0 (0) | 0 (0) |"

"""Where the parameters of a hypothesis come to stand."""

import numpy as np
import pytest

from twin.study.assemble import assemble
from twin.study.refine import FARTHER, _bends, _climb, _pressed, refine


@pytest.fixture(scope="module")
def case(tanker, voyages):
    return assemble([voyages["SteeringLag"]], tanker)


def rows(case, owner):
    return np.array([i for i, u in enumerate(case.effects) if u.owner == owner])


def test_a_gears_travel_time_is_not_in_proportion_to_what_it_does_and_a_rudders_offset_is(case):
    by_label = {u.label: u for u in case.effects}
    assert _bends(case, case.model, by_label["SteeringLag.travel_time"])
    assert not _bends(case, case.model, by_label["RudderOffset.offset"])
    assert not _bends(case, case.model, by_label["PropellerWear.loss"])


def test_only_what_ended_at_nothing_and_bends_is_looked_for_farther_out(case):
    mine, at = rows(case, "SteeringLag"), np.zeros(len(case.effects))
    assert {case.effects[i].name for i in _pressed(case, mine, at)} >= {"travel_time"}
    at[mine] = 1.0
    assert _pressed(case, mine, at) == []
    assert _pressed(case, rows(case, "RudderOffset"), np.zeros(len(case.effects))) == []


def test_a_slow_gear_is_found_also_where_a_climb_from_nothing_ends_at_nothing(case):
    mine, none = rows(case, "SteeringLag"), np.zeros(len(case.effects))
    near, at = _climb(case, ("SteeringLag",), mine, "usual", none)
    far, _ = _climb(case, ("SteeringLag",), mine, "usual", FARTHER[0] * np.ones(len(case.effects)))
    found, _ = refine(case, ("SteeringLag",), "usual", none, ())
    print(near.log_weight, [case.effects[i].sd * at[i] for i in mine], far.log_weight, [case.effects[i].sd * found.posterior.z[i] for i in mine])
    assert found.hypothesis.log_weight >= near.log_weight

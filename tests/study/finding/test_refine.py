"""Where the parameters of a hypothesis come to stand."""

import numpy as np
import pytest

from twin.study.assemble import assemble
from twin.study.refine import _bends, _pressed


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

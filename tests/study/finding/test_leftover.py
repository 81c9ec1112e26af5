"""What is left under the best explanation, beside what the reference voyages left."""

from dataclasses import replace

import numpy as np
import pytest

from twin.study.assemble import assemble
from twin.study.leftover import ASTRAY, explains, helps, quiet
from twin.study.search import search


@pytest.fixture(scope="module")
def judged(tanker, voyages):
    case = assemble([voyages["RudderWear"]], tanker)
    return case, search(case)[1][("RudderWear",)]


def test_under_its_true_cause_a_ship_is_as_quiet_as_on_her_reference_voyages(judged):
    assert quiet(*judged)


def test_a_world_with_a_larger_floor_is_no_explanation_unless_a_sea_was_measured(judged):
    case, found = judged
    rough = replace(found, hypothesis=replace(found.hypothesis, world="rough"))
    assert not explains(case, rough)
    (track,) = case.tracks
    waves = np.full(len(track), 0.01 * case.model.ship.L_pp)
    assert explains(replace(case, tracks=(replace(track, weather=dict(track.weather) | {"H_s": waves}),)), rough)


def test_what_leads_her_elsewhere_explains_nothing_however_quiet_it_leaves_her(judged):
    case, found = judged
    assert explains(case, replace(found, off_m=1.4, floor_m=1.0))
    assert not explains(case, replace(found, off_m=(ASTRAY + 0.1), floor_m=1.0))


@pytest.mark.parametrize("effects, off, answer", [
    (("RudderWear",), 0.9, True), (("RudderWear",), 0.99, False), (("GyroBias",), 1.0, True), (("GyroBias", "RudderWear"), 1.0, False),
])  # fmt: skip
def test_a_force_must_lead_her_better_and_a_fault_of_an_instrument_need_not(judged, effects, off, answer):
    case, found = judged
    named = replace(found, off_m=off, hypothesis=replace(found.hypothesis, effects=effects))
    assert helps(case, named, replace(found, off_m=1.0)) is answer

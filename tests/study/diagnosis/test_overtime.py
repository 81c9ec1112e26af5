"""Whether an effect was there all the time: asked of each part of the voyages."""

import numpy as np

from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.diagnosis.overtime import changes
from twin.study.diagnosis.tell_diagnosis import terminal_lines


def parts(result, name):
    return next(c for c in result["candidates"] if c["effect"] == name)["over_time"]


def test_an_effect_that_is_always_there_is_as_strong_in_every_part(diagnosed):
    result = diagnosed("RudderWear")
    found = parts(result, "RudderWear")
    assert len(found) > 1 and not changes(found)
    assert all(abs(p["share"] - 1.0) < 4.0 * p["sd"] + 0.25 for p in found)
    assert not any("its size changes with time" in line for line in terminal_lines(result))


def test_an_effect_that_came_between_two_voyages_is_told_by_voyage(tanker, voyages):
    result = diagnose([voyages["nothing"], voyages["RudderWear"]], tanker).result
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

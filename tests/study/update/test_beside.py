"""Which water and weather stands beside what is added: that beside which a diagnosis told it."""

import pytest

from tests.study.conftest import voyage
from tests.thorough import thorough
from twin.commands import story
from twin.physics.effects import find
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.track.track import track
from twin.study.update.adding import fitted


def test_an_added_number_and_its_interval_are_those_of_the_diagnosis():
    """Test: the growth on the bundled tanker. Expected: 0.32 to 0.34 with a quarter of doubt either way, by
    both, to a hundredth of the interval; about another place than where the number was found its doubt had
    been five times as large, and with another weather beside it its size another by a tenth."""
    ship, voyage = load(story.SHIP), read_voyage(story.MONDAY)
    (extra,) = fitted(ship, [find("HullFouling")], [track(voyage, ship)]).numbers
    (said,) = next(
        c["parameters"] for c in diagnose([voyage], ship).result["candidates"] if c["effect"] == "HullFouling"
    )
    close = 0.01 * (said["high95"] - said["low95"])
    assert [extra.value, extra.low95, extra.high95] == pytest.approx(
        [said[key] for key in ("value", "low95", "high95")], abs=close
    )


@thorough
def test_a_stream_that_may_change_is_fitted_when_asked_for_though_it_does_not_change(kvlcc2):
    """Test: a steady stream. Expected: beside another effect it is a steady one, and the one that may change
    is kept where it is asked for by name."""
    steady = [track(voyage(find("Current").absent(kvlcc2).but(north=-0.3, east=0.5)), kvlcc2)]
    beside = fitted(kvlcc2, [find("HullFouling")], steady)
    assert {n.effect for n in beside.beside} == {"Current"}
    asked = fitted(kvlcc2, [find("VaryingCurrent")], steady)
    assert asked.names == ("VaryingCurrent",) and "Current" not in asked.found.hypothesis.effects

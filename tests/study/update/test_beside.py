"""Which water and weather stands beside what is added: that beside which a diagnosis told it."""

import pytest

from tests.study.conftest import voyage
from tests.thorough import thorough
from twin.commands import story
from twin.physics.effects import find
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.diagnosis.open_loop_check import OpenLoopCheck
from twin.study.diagnosis.refine import Found
from twin.study.reference.evidence import Hypothesis
from twin.study.track.track import track
from twin.study.update import beside
from twin.study.update.adding import fitted
from twin.study.update.beside import WeatherSearch


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


def kept_of(floats, **error_m):
    """What is kept of these sets (names joined by _), by how far off [m] each leads the ship, where 10 m are
    expected; the more effects the likelier one step ahead. `floats`: whether what a set holds can be a load."""
    ends = {(): 30.0} | {tuple(names.split("_")): m for names, m in error_m.items()}
    found = {
        s: Found(Hypothesis(s, "usual", 20.0 * len(s), 0.0), None, None, 0.0, m, 10.0)
        for s, m in ends.items()
    }
    search = object.__new__(WeatherSearch)
    search.case, search.found, search.names, search.stand = None, found, ("HullFouling",), list(found)[1:]
    path = OpenLoopCheck(found, {"usual": 10.0}, dict.fromkeys(found, 0.0), 20.0, frozenset(), {"Wind"})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(beside, "open_loop_check", lambda *_: path)
        patch.setattr(beside, "floats", lambda case, f: floats(f.hypothesis.effects))
        return search.likeliest().hypothesis.effects


def test_what_a_diagnosis_strikes_out_is_not_what_an_added_number_stands_beside():
    """Test: wind beside fouling, likelier one step ahead, that ends farther off than expected and than fouling
    alone, or with a load that does not float. Expected: fouling alone; it, too, where nothing is left."""
    alone, both = ("HullFouling",), ("HullFouling", "Wind")
    assert kept_of(lambda s: True, HullFouling=9.0, HullFouling_Wind=9.0) == both
    assert kept_of(lambda s: True, HullFouling=9.0, HullFouling_Wind=12.0) == alone
    assert kept_of(lambda s: s == alone, HullFouling=9.0, HullFouling_Wind=9.0) == alone
    assert kept_of(lambda s: False, HullFouling=9.0, HullFouling_Wind=9.0) == alone

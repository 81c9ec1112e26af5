"""What leaves the operating set is told in the bridge's units, and counted under one name whatever its numbers."""

from math import nan

import pytest

from twin.live.bridge.alarms import key_of
from twin.live.observer.operating import BORDER_UNITS, WORDS, OperatingSet, outside_in_words
from twin.physics.state import Situation

RANGES = {"u": (0.0, 8.0), "v": (-2.0, 2.0), "r": (-0.015, 0.015), "n": (0.0, 1.5), "wind_speed": (0.0, 20.0)}
SAID = {  # by hand: 1 m/s is 1.944 kn, 1 rad/s is 3437.7 deg/min
    "rate of turn = 68.8 ± 3.44 °/min, outside -51.6 to 51.6 °/min": ({"r": 0.02}, (0.0, 0.0, 0.001)),
    "surge speed through water = 17.5 kn, outside 0 to 15.6 kn": ({"u_r": 9.0, "u": 9.0}, (0.0, 0.0, 0.0)),
    "propeller rate = 96.0 1/min, outside 0 to 90.0 1/min": ({"n": 1.6}, (0.0, 0.0, 0.0)),
    "wind = 25.0 m/s, outside 0 to 20.0 m/s": ({"wind_speed": 25.0}, (0.0, 0.0, 0.0)),
}


def inside(**other):
    return Situation(**{"u": 5.0, "u_r": 5.0, "v": 0.0, "v_r": 0.0, "r": 0.0, "n": 1.0} | other)


@pytest.mark.parametrize("words", SAID)
def test_it_is_told_with_its_unit_and_its_bound(words):
    other, bound = SAID[words]
    assert OperatingSet(RANGES).outside(inside()) is None
    assert OperatingSet(RANGES).outside(inside(**other), bound) == words


def test_every_number_has_a_unit_and_a_name():
    assert set(BORDER_UNITS) <= set(WORDS)
    for name in WORDS:
        said = outside_in_words(name, 3.0, 0.5, 0.0, 1.0)
        assert said.startswith(f"{WORDS[name]} = ") and said.endswith(f" {BORDER_UNITS.get(name, ('m',))[0]}")
    assert "nan" in outside_in_words("u", nan, 0.0, 0.0, 1.0)


def test_the_same_reason_with_other_numbers_is_counted_as_one():
    said = [outside_in_words("r", value, 0.001, -0.015, 0.015) for value in (0.02, -0.3)]
    assert len(set(said)) == 2
    assert len({key_of(text) for text in said}) == 1
    assert {text.partition(" = ")[0] for text in said} == {"rate of turn"}

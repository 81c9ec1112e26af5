"""A small boat in waves, from the reference sea: what its instruments say of each other there."""

from collections import Counter

import pytest

from bench.instrument_lies import RATE_HZ, WEATHERS, LieWatch, voyage_rows
from tests.thorough import one_of
from twin.physics.ship import load


@pytest.mark.parametrize("manoeuvre", one_of(("zigzag_10", "course_changes")))
def test_R13_a_small_boat_in_waves_turns_as_its_gyro_says(manoeuvre):
    """Test: five minutes of a 2 m boat in waves. Expected: in no tick is heading held against the rate of
    turn, nor are there more texts than one can read."""
    watch, words = LieWatch(load("usv")), Counter()
    for row in voyage_rows("usv", WEATHERS["waves"][2], manoeuvre, 300.0):
        words.update(watch.hear(row))
    assert watch.now_s > 750.0 and RATE_HZ == 10.0
    assert not [text for text in words if "yaw_rate_degps against the turning heading" in text]
    assert not [text for text in words if text.startswith("heading_true_north_deg against yaw_rate")]
    assert len(words) <= 5

"""Cells become numbers of a channel: degrees as people write them, with their sign; angles that are late."""

from pathlib import Path

import numpy as np
import pytest

from twin.recording.cells import converted, degrees_of
from twin.recording.mapping import Column
from twin.recording.table import Table


@pytest.mark.parametrize(
    ("text", "deg"),
    [
        ("57°30.6'N", 57.51),
        ("57 30.6S", -57.51),
        ("57 deg 30.6 min S", -57.51),
        ("57 degrees 30.6 minutes North", 57.51),
        ("11 06 36 West", -11.11),
        ("South 11 06 36", -11.11),
        ("11d06m36sW", -11.11),
        ("11d06m36s", 11.11),
        ("11 deg 6 min 36 sec E", 11.11),
        ("-57 30.6", -57.51),
    ],
)
def test_only_a_letter_or_word_of_its_own_is_a_hemisphere(text, deg):
    assert degrees_of(text) == pytest.approx(deg)


@pytest.mark.parametrize("text", ["57 30.6 Sud", "57 30 lost", "57 30 N S", "57 30.6 SE"])
def test_letters_that_are_no_hemisphere_are_refused_and_not_guessed_at(text):
    with pytest.raises(ValueError):
        degrees_of(text)


T = np.arange(0.0, 60.0)


def channel(name, values, time_s=T, **entry):
    """The samples of one channel that a table has in the column `x`."""
    table = Table(Path("v.csv"), np.arange(time_s.size) + 2, {"x": values}, {})
    return converted(name, table, Column("x", **entry), time_s, "m.toml", [])


@pytest.mark.parametrize(
    ("name", "entry"),
    [("heading_true_north_deg", {}), ("sway_velocity_mps", {"frame": "course"})],
)
def test_an_angle_that_comes_late_is_lined_across_north_and_not_through_south(name, entry):
    course = 330.0 + T
    shown = channel(name, np.mod(course, 360.0), late_s=0.5, **entry)
    assert shown[5:-5] == pytest.approx(np.mod(course + 0.5, 360.0)[5:-5])


def test_what_comes_late_is_not_lined_across_a_hole_and_is_in_a_log_that_is_slow():
    """Test: a heading every second with a hole of an hour; one every 10 s. Expected: nothing in the hole is
    made up, and of the slow one, of which 10 s are the usual wait, all but the end is there."""
    time_s = T + 3600.0 * (T > 30.0)
    shown = channel("heading_true_north_deg", 10.0 + T, time_s, late_s=3.0)
    assert np.flatnonzero(np.isnan(shown)).tolist() == [28, 29, 30, 57, 58, 59]
    slow = channel("heading_true_north_deg", 10.0 + T, 10.0 * T, late_s=5.0)
    assert slow[:-1] == pytest.approx(10.5 + T[:-1])


def test_a_course_over_ground_that_passes_north_has_no_spikes_there():
    time_s = np.arange(0.0, 200.0)
    course = 357.0 + 2.0 * np.sin(time_s)
    course[100] = 1.0
    shown = channel("sway_velocity_mps", course, time_s, despike=True, frame="course")
    assert np.isfinite(shown).all()

"""What a calibration fits, and what it holds out to be judged by."""

import numpy as np
import pytest

import twin
from twin.commands.story import MONDAY, SHIP
from twin.errors import DataError
from twin.physics.ship import load


def test_a_voyage_of_which_only_the_held_out_part_is_whole_is_refused_in_words():
    """Test: half an hour whose rudder was logged for a moment, and again in the last eight minutes. Expected: which
    voyage, that its first part is too short, and what to give."""
    monday = twin.read_voyage(MONDAY)
    out = (monday.time_s > 10.0) & (monday.time_s < 1320.0)
    rudder = np.where(out, np.nan, monday.columns["rudder_angle_deg"])
    late = monday.with_rows(monday.time_s, {**monday.columns, "rudder_angle_deg": rudder})
    with pytest.raises(DataError, match=r"^monday: .*first 70 %.* --held-out"):
        twin.calibrate(load(SHIP), [late])

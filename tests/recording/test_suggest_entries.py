"""What a proposed map makes of columns that only another column explains."""

from pathlib import Path

import numpy as np
import pytest

from twin.recording.columns_seen import SeenColumns
from twin.recording.suggest_entries import best_guesses, proposed

T = np.arange(60.0)
SPEED = 10.0 + np.sin(T / 9.0)


def entries(*names):
    seen = SeenColumns(Path("b.csv"), ["t", *names], {"t": T} | dict.fromkeys(names, SPEED))
    return proposed([seen], best_guesses([seen]), {}, {"column": "t", "unit": "s"})


@pytest.mark.parametrize(
    ("ahead", "aside"),
    [
        ("LOG_AHEAD_kn", "LOG_STBD_kn"),
        ("Log longitudinal (kn)", "Log transverse (kn)"),
        ("water_speed_x_kn", "water_speed_y_kn"),
    ],
)
def test_the_log_s_second_axis_is_proposed_beside_its_first_with_what_its_place_asks(ahead, aside):
    found = entries(aside, ahead)
    assert found["surge_velocity_through_water_mps"].keys["column"] == ahead
    beside = found["sway_velocity_through_water_mps"]
    assert beside.keys == {"column": aside, "unit": "kn"}
    assert "ahead of midship" in beside.why[-1] and beside.why[-1].endswith("CONFIRM")


def test_the_log_of_the_starboard_side_is_no_second_axis():
    """Test: a log to each side. Expected: none of them is the speed aside."""
    assert "sway_velocity_through_water_mps" not in entries("LOG_PORT_kn", "LOG_STBD_kn")

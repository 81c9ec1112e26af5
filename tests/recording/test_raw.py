"""A table through a map: a model's file becomes the ship's, whatever its position and velocity are written in."""

import numpy as np
import pytest

from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage

SCALE = 25.0


def as_ship(path, scale=SCALE):
    return read_voyage(path, parse_map({"scale": {"froude": scale}}, "m.toml"))


def test_a_model_with_a_receiver_and_a_course_over_ground_becomes_a_ship(sailed, write_csv):
    """Test: latitude and longitude, speed and course over ground, once as they are and once of a model of 1 to
    25. Expected: ways 25 times and velocities five times as long, derived ones too, and the datum where it
    was."""
    place = {
        "time_s": sailed["t"],
        "latitude_deg": sailed["latitude"],
        "longitude_deg": sailed["longitude"],
        "heading_true_north_deg": sailed["psi"],
        "rudder_angle_deg": sailed["rudder"],
        "propeller_rate_rpm": sailed["rpm"],
    }
    course = {"speed_over_ground_mps": sailed["sog"], "course_over_ground_deg": sailed["psi"] + 10.0}
    for columns in (place, place | course):
        model, ship = (as_ship(write_csv(columns, digits=17), by) for by in (1.0, SCALE))
        for name in ("north_m", "east_m"):
            np.testing.assert_allclose(ship[name], SCALE * model[name], atol=1e-6)
        assert ship.meta["datum"] == model.meta["datum"]
    for name in ("surge_velocity_mps", "sway_velocity_mps"):
        np.testing.assert_allclose(ship[name], 5.0 * model[name], rtol=1e-9)
    assert ship["sway_velocity_mps"][0] == pytest.approx(5.0 * 6.0 * np.sin(np.radians(10.0)))

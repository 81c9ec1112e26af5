"""A proposed map of two rudders behind two shafts says how a ship file with one of each reads them."""

import tomllib

import numpy as np

from twin.recording.suggest_actuators import means_of_two
from twin.recording.suggest_map import suggestion

PORT = {"port.angle_deg": {"column": "Rudder PS"}, "port.rate_rpm": {"column": "RPM PS"}}
STARBOARD = {"starboard.angle_deg": {"column": "Rudder SB"}, "starboard.rate_rpm": {"column": "RPM SB"}}


def test_of_two_alike_there_are_means():
    assert means_of_two({"north_m": {"column": "n"}, **PORT, **STARBOARD}) == {
        "rudder_angle_deg": {"column": ["Rudder PS", "Rudder SB"], "factors": [0.5, 0.5]},
        "propeller_rate_rpm": {"column": ["RPM PS", "RPM SB"], "factors": [0.5, 0.5]},
    }


def test_of_others_there_are_none():
    """Test: one shaft; two and a bow thruster; two of which one rudder is read with another sign; none."""
    bow, turned = {"bow.command": {"column": "Bow"}}, {"starboard.angle_deg": {"column": "SB", "sign": -1}}
    for columns in (PORT, PORT | STARBOARD | bow, PORT | STARBOARD | turned, {"north_m": {"column": "n"}}):
        assert means_of_two(columns) == {}


def test_the_lines_stand_in_the_proposed_map_and_read_as_they_are(tmp_path):
    t = np.arange(0.0, 120.0)
    columns = {
        "Time (s)": t, "Northing (m)": 5.0 * t, "Easting (m)": 0.0 * t, "Heading True (deg)": 0.0 * t + 3.0,
        "Rudder Port (deg)": np.sin(t), "Rudder Stbd (deg)": np.sin(t), "Shaft RPM Port": 90.0 + np.cos(t),
        "Shaft RPM Stbd": 90.0 + np.cos(t),
    }  # fmt: skip
    path = tmp_path / "v.csv"
    np.savetxt(path, np.column_stack([*columns.values()]), "%.4f", ";", header=";".join(columns), comments="")
    said = [
        line[2:] for line in suggestion([path], {}).splitlines() if line.startswith("# rudder_angle_deg = ")
    ]
    assert tomllib.loads(said[0])["rudder_angle_deg"] == {
        "column": ["Rudder Port (deg)", "Rudder Stbd (deg)"],
        "factors": [0.5, 0.5],
    }

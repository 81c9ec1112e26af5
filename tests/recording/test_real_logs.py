"""Every real log goes in, or says in one line what it is and what it lacks (skipped where the data are
not)."""

import tomllib

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.recording.suggest_map import suggestion

LACK = {  # what a log lacks for a voyage with controls
    "nmea0183/gofree-merrimac.log": "this is an NMEA 0183 log; a voyage needs rudder_angle_deg",
    "nmea0183/irene-training-NMEA0000.TXT": "this is an NMEA 0183 log; a voyage needs rudder_angle_deg",
    "nmea0183/plaka-first-part.log": "this is an NMEA 0183 log; a voyage needs heading_true_north_deg",
    "nmea2000/ac42-commissioning-first-part.raw": "as canboat writes it; a voyage needs propeller_rate_rpm",
    "nmea2000/furuno-130842-figure8-fast.raw": "as canboat writes it; a voyage needs rudder_angle_deg",
    "nmea2000/furuno-130842-wide-turn.raw": "as canboat writes it; a voyage needs rudder_angle_deg",
    "nmea2000/merrimac-ydwg-2020.raw": "Yacht Devices gateway; a voyage needs propeller_rate_rpm",
    "candump/candumpSample3.txt": "this is an NMEA 2000 candump; a voyage needs propeller_rate_rpm",
    "candump/actisense-522.candump.log": "this is an NMEA 2000 candump, and nothing in it can be used",
    "ulog/sample_log_small.ulg": "this is a PX4 ULog; a voyage needs rudder_angle_deg",
    "ros1/pool_st.bag": "this is a ROS recording, and nothing in it says what it is",
}


@pytest.mark.parametrize("name", LACK)
def test_a_log_says_in_one_line_what_it_is_and_what_it_lacks(data, name):
    with pytest.raises(DataError) as caught:
        read_voyage(data / "logs" / name)
    assert LACK[name] in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "name", [n for n, said in LACK.items() if "heading" not in said and "nothing" not in said]
)
def test_without_the_controls_it_goes_in(data, name):
    v = read_voyage(data / "logs" / name, controls=False)
    assert len(v) > 20 and v.has("heading_true_north_deg", "north_m")


def test_the_figure_eight_of_a_yacht_agrees_with_itself(data):
    """Test: two satellite compasses, each its own course. Expected: the heading and the course of one
    receiver, within leeway and stream."""
    v = read_voyage(data / "logs" / "nmea2000" / "furuno-130842-figure8-fast.raw", controls=False)
    drift = np.degrees(np.arctan2(v["sway_velocity_mps"], v["surge_velocity_mps"]))
    assert abs(np.nanmedian(drift)) < 8.0 and 3.0 < np.nanmedian(v["surge_velocity_mps"]) < 4.5


@pytest.mark.parametrize(
    "run",
    ["turn_14-Oct-2020_14_08_51.csv", "zigzag_31-Jul-2020_13_04_24.csv", "random_03-Aug-2020_11_04_37.csv"],
)
def test_a_model_tank_table_goes_in_by_its_proposed_map(data, run):
    path = data / "esso_osaka" / run
    text = suggestion([path], {})
    v = read_voyage(path, parse_map(tomllib.loads(text), "proposed"))
    assert v.has(
        "heading_true_north_deg",
        "rudder_angle_deg",
        "propeller_rate_rpm",
        "surge_velocity_mps",
        "true_wind_speed_mps",
    )
    assert np.nanmax(v["propeller_rate_rpm"]) > 100.0 and "NOT FOUND" not in text


def test_a_catamaran_of_two_thrusters_goes_in_by_its_proposed_map(data):
    path = data / "blueboat" / "fixed_00000216.csv"
    text = suggestion([path], {})
    v = read_voyage(path, parse_map(tomllib.loads(text), "proposed"))
    assert "NOT FOUND" not in text and 'unit = "rad/s"' in text and 'unit = "ms"' in text
    assert v.has("port.pwm_us", "starboard.pwm_us", "heading_true_north_deg", "surge_velocity_mps")


def test_a_folder_of_one_table_a_topic_goes_in_with_its_four_azimuths(data):
    folder = data / "milliampere" / "maneuvering1"
    text = suggestion([folder], {})
    v = read_voyage(folder, parse_map(tomllib.loads(text), "proposed"))
    assert 'file = "nav_estimate.csv"' in text and 'unit = "quaternion"' in text and 'frame = "earth"' in text
    assert v.has(*(f"actuator_{i}.{last}" for i in (1, 2, 3, 4) for last in ("angle_deg", "rate_rpm")))

"""A map laid over columns that say by their own names what they are: it replaces what it names, no more."""

import numpy as np
import pytest

from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage


def by(**columns):
    return parse_map({"columns": columns}, "m.toml")


def test_a_map_of_one_line_leaves_the_columns_that_name_themselves(columns, write_csv, refused):
    foreign = dict(columns) | {"n1": columns["propeller_rate_rpm"]}
    del foreign["propeller_rate_rpm"]
    path = write_csv(foreign)
    refused(path, "needs propeller_rate_rpm", "'n1' is not used")
    v = read_voyage(path, by(propeller_rate_rpm="n1"))
    for name in columns:
        if name != "time_s":
            np.testing.assert_allclose(v[name], read_voyage(write_csv(columns))[name])


def test_an_entry_without_a_column_is_of_the_channels_own(columns, write_csv):
    knots = columns | {"surge_velocity_mps": columns["surge_velocity_mps"] * 3600.0 / 1852.0}
    v = read_voyage(write_csv(knots), by(surge_velocity_mps={"unit": "kn"}))
    np.testing.assert_allclose(v["surge_velocity_mps"], columns["surge_velocity_mps"], rtol=1e-6)
    np.testing.assert_allclose(v["sway_velocity_mps"], columns["sway_velocity_mps"], rtol=1e-6)


def test_a_clock_alone_may_be_corrected(columns, write_csv):
    path = write_csv(columns | {"time_s": 1000.0 * columns["time_s"]})
    v = read_voyage(path, parse_map({"time": {"unit": "ms"}}, "m.toml"))
    np.testing.assert_allclose(np.ptp(v.time_s), np.ptp(columns["time_s"]))


def test_the_columns_own_clock_is_taken_where_a_map_names_none(columns, write_csv):
    whole = {k: x[::10] for k, x in columns.items()}
    utc = [f"2024-05-17T08:{int(t) // 60:02d}:{int(t) % 60:02d}Z" for t in whole["time_s"]]
    table = {"time_utc": np.array(utc, dtype=object)} | {k: x for k, x in whole.items() if k != "time_s"}
    v = read_voyage(write_csv(table), by(rudder_angle_deg={"sign": -1}))
    assert str(v.meta["start_time_utc"]).startswith("2024-05-17T08:00:00")
    np.testing.assert_allclose(v["rudder_angle_deg"], -whole["rudder_angle_deg"])


def test_a_position_that_a_map_names_stands_alone(columns, write_csv):
    """Test: north and east stand in the file, and the map reads latitude and longitude from other columns.
    Expected: the place of the map, and no mixture of both."""
    table = columns | {
        "la": 57.0 + (2.0 * columns["north_m"]) / 111_360.0,
        "lo": 11.0 + columns["east_m"] / (111_360.0 * np.cos(np.radians(57.0))),
    }
    v = read_voyage(write_csv(table, digits=12), by(latitude_deg="la", longitude_deg="lo"))
    assert np.ptp(v["north_m"]) == pytest.approx(2.0 * np.ptp(columns["north_m"]), rel=0.01)


def test_half_a_position_keeps_its_own_partner(columns, write_csv):
    v = read_voyage(write_csv(columns), by(east_m={"sign": -1}))
    np.testing.assert_allclose(v["east_m"] - v["east_m"][0], -(columns["east_m"] - columns["east_m"][0]))
    np.testing.assert_allclose(v["north_m"] - v["north_m"][0], columns["north_m"] - columns["north_m"][0])


def test_velocities_of_another_frame_push_out_both_of_the_ships_axes(columns, write_csv):
    psi = np.radians(columns["heading_true_north_deg"])
    over = (columns["surge_velocity_mps"] + 1j * columns["sway_velocity_mps"]) * np.exp(1j * psi)
    table = columns | {"vn": 3.0 * over.real, "ve": 3.0 * over.imag}
    entry = {
        name: {"column": c, "frame": "earth"}
        for name, c in (("surge_velocity_mps", "vn"), ("sway_velocity_mps", "ve"))
    }
    v = read_voyage(write_csv(table), by(**entry))
    np.testing.assert_allclose(v["surge_velocity_mps"], 3.0 * columns["surge_velocity_mps"], atol=1e-6)
    np.testing.assert_allclose(v["sway_velocity_mps"], 3.0 * columns["sway_velocity_mps"], atol=1e-6)


def test_a_column_that_a_map_reads_as_another_channel_is_not_read_by_its_name_too(columns, write_csv):
    table = columns | {"roll_deg": columns["yaw_rate_degps"]}
    del table["yaw_rate_degps"]
    v = read_voyage(write_csv(table), by(yaw_rate_degps="roll_deg"))
    assert v.has("yaw_rate_degps") and not v.has("roll_deg")


def test_a_constant_replaces_a_column_of_its_name(columns, write_csv):
    m = parse_map({"constant": {"propeller_rate_rpm": 90.0}}, "m.toml")
    assert np.all(read_voyage(write_csv(columns), m)["propeller_rate_rpm"] == 90.0)


def test_several_tables_are_overlaid_alike(columns, write_csv, tmp_path):
    """Test: motion in one file, the shaft under a name of its own in another; the map has one line."""
    shaft = {"time_s": columns["time_s"], "n1": columns["propeller_rate_rpm"]}
    motion = {k: x for k, x in columns.items() if k != "propeller_rate_rpm"}
    paths = [write_csv(motion, name="motion.csv"), write_csv(shaft, name="shaft.csv")]
    v = read_voyage(paths, by(propeller_rate_rpm="n1"))
    assert v.has("propeller_rate_rpm", "rudder_angle_deg", "north_m", "yaw_rate_degps")
    np.testing.assert_allclose(v["propeller_rate_rpm"], columns["propeller_rate_rpm"])

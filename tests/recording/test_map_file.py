"""A map says what a file's own columns, units, signs and clock mean; a wrong one says where."""

import numpy as np
import pytest

from twin.errors import SettingsError
from twin.recording.map_file import number, parse_map
from twin.recording.read import read_voyage

MAP = {
    "file": {"skip_lines": 1, "separator": ";", "decimal": ",", "missing": ["-99"]},
    "time": {"column": ["day", "clock"], "format": "%d.%m.%Y %H:%M:%S.%f"},
    "columns": {
        "latitude_deg": {"column": "lat", "unit": "ddmm"},
        "longitude_deg": "lon",
        "heading_true_north_deg": {"column": "hdg", "unit": "rad", "offset": 5.0},
        "surge_velocity_mps": {"column": "sog", "unit": "kn", "frame": "course"},
        "sway_velocity_mps": {"column": "cog", "frame": "course"},
        "rudder_angle_deg": {"column": 8, "sign": -1},
        "propeller_rate_rpm": {"column": "n", "unit": "1/s"},
        "true_wind_speed_mps": {"column": "w", "unit": "km/h"},
        "true_wind_direction_deg": {"column": "wd", "direction": "to"},
    },
    "constant": {"water_depth_m": 35},
}


def test_a_map_names_columns_units_signs_frames_and_the_clock(tmp_path):
    rows = ["exported by somebody", "day;clock;lat;lon;hdg;sog;cog;RUD;n;w;wd"]
    rows += [
        f"17.05.2024;08:30:{s:02d}.5;5530,00;10,0;0,5;10,0;33,65;-4;1,5;36;{'-99' if s == 3 else '10'}"
        for s in range(20)
    ]
    path = tmp_path / "v.csv"
    path.write_text("\n".join(rows))
    v = read_voyage(path, parse_map(MAP, "my.toml"))
    assert v.meta["datum"] == {"latitude_deg": 55.5, "longitude_deg": 10.0} and v.meta["map"] == "my"
    assert v["heading_true_north_deg"][0] == pytest.approx(np.degrees(0.5) + 5.0)
    assert (
        v["surge_velocity_mps"][0] == pytest.approx(5.1444, abs=1e-3)
        and abs(v["sway_velocity_mps"][0]) < 0.01
    )
    assert v["rudder_angle_deg"][0] == 4.0 and v["propeller_rate_rpm"][0] == 90.0
    assert v["true_wind_speed_mps"][0] == pytest.approx(10.0) and v["true_wind_direction_deg"][0] == 190.0
    assert np.isnan(v["true_wind_direction_deg"][3]) and v["water_depth_m"][5] == 35.0
    assert v.meta["start_time_utc"] == "2024-05-17T08:30:00.500000Z"


def test_speed_and_course_and_north_and_east_may_be_called_by_their_own_names():
    """Expected: the same map as with the ship's axes and a frame; a velocity that has two entries is refused."""
    rest = {n: c for n, c in MAP["columns"].items() if n not in ("surge_velocity_mps", "sway_velocity_mps")}
    own = {"speed_over_ground_mps": {"column": "sog", "unit": "kn"}, "course_over_ground_deg": "cog"}
    assert parse_map(MAP | {"columns": own | rest}, "my.toml") == parse_map(MAP, "my.toml")
    by = parse_map({"columns": {"velocity_north_mps": 3, "velocity_east_mps": {"sign": -1}}}, "my.toml")
    assert {n: (c.parts, c.frame) for n, c in by.columns.items()} == {
        "surge_velocity_mps": ((3,), "earth"),
        "sway_velocity_mps": (("velocity_east_mps",), "earth"),
    }
    with pytest.raises(SettingsError, match="course_over_ground_deg is a second entry for sway_velocity_mps"):
        parse_map({"columns": {"sway_velocity_mps": "v", "course_over_ground_deg": "cog"}}, "my.toml")


def test_froudes_law_makes_a_ship_of_a_model(columns, write_csv):
    names = {n: {"column": n} for n in columns if n != "time_s"}
    by = parse_map({"time": {"column": "time_s"}, "columns": names, "scale": {"froude": 4.0}}, "m.toml")
    v = read_voyage(write_csv(columns), by)
    np.testing.assert_allclose(v.time_s, 2.0 * columns["time_s"])
    np.testing.assert_allclose(v["north_m"], 4.0 * columns["north_m"], rtol=1e-8)
    np.testing.assert_allclose(v["surge_velocity_mps"], 2.0 * columns["surge_velocity_mps"], rtol=1e-8)
    np.testing.assert_allclose(v["yaw_rate_degps"], 0.5 * columns["yaw_rate_degps"], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(v["propeller_rate_rpm"], 0.5 * columns["propeller_rate_rpm"], rtol=1e-8)
    np.testing.assert_allclose(v["rudder_angle_deg"], columns["rudder_angle_deg"], rtol=1e-7)


def test_rounded_stamps_are_rebuilt_but_not_where_rows_are_missing(columns, write_csv, refused):
    names = {n: {"column": n} for n in columns if n != "time_s"}
    by = parse_map({"time": {"column": "time_s", "rebuild": True}, "columns": names}, "m.toml")
    v = read_voyage(write_csv(columns | {"time_s": np.round(columns["time_s"])}), by)
    np.testing.assert_allclose(v.time_s, columns["time_s"], atol=0.5)
    assert np.ptp(np.diff(v.time_s)) < 1e-9 and "rebuilt" in v.meta["notes"][-1]
    holed = columns["time_s"] + np.where(columns["time_s"] > 40.0, 60.0, 0.0)
    jumpy = columns | {"time_s": np.round(holed)}
    refused(write_csv(jumpy), "Rows are missing", by=by)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"colums": {}}, "Did you mean 'columns'"),
        ({"columns": {"heading": 3}}, "Did you mean 'heading_true_north_deg'"),
        ({"columns": {"port.rate_rmp": 3}}, "Did you mean 'port.rate_rpm'"),
        ({"columns": {"Port Aft.pwm": 3}}, "Did you mean 'port_aft.pwm_us'"),
        ({"columns": {"rudder_angle_deg": {"column": 3, "unit": "degree"}}}, "Did you mean 'deg'"),
        ({"columns": {"rudder_angle_deg": {"colum": "rud"}}}, "Did you mean 'column'"),
        ({"columns": {"rudder_angle_deg": {"column": 3, "sign": 2}}}, "sign = 2"),
        ({"columns": {"rudder_angle_deg": {"column": 3, "frame": "earth"}}}, "frame is for"),
        ({"columns": {"surge_velocity_mps": {"column": 3, "frame": "earth"}}}, "same frame"),
        ({"columns": {"rudder_angle_deg": {"column": 1.5}}}, "column = 1.5 must be text or a whole number"),
        ({"file": {"skip_lines": "two"}}, "skip_lines"),
        ({"file": {"separator": "/"}}, "separator"),
        ({"time": {"unit": "weeks"}}, "unit = 'weeks'"),
        ({"time": {"rebuild": -1.0}}, "rebuild"),
        ({"scale": {"froude": -3}}, "must be positive"),
        ({"constant": {"water_depth_m": "deep"}}, "must be a number"),
        ({"columns": 3}, "[columns]: is 3; it must be a table"),
        ({"constant": 3}, "[constant]: is 3; it must be a table"),
        ({"columns": {"roll_deg": {"column": []}}}, "[columns] roll_deg: column names no column"),
        ({"time": {"column": []}}, "[time]: column names no column"),
        ({"file": {"skip_lines": -1}}, "[file] skip_lines = -1"),
        ({"file": {"skip_after_header": -2}}, "[file] skip_after_header = -2"),
        ({"time": {"column": ["a", "b"], "factors": [1]}}, "[time]: factors needs 2 numbers"),
        ({"columns": {"roll_deg": {"column": "a", "factors": [1, 2]}}}, "factors needs 1 number,"),
        ({"time": {"column": ["a", "b"], "factors": [1, 2], "unit": "iso"}}, "factors is for numbers"),
        (
            {
                "columns": {
                    "heading_true_north_deg": {"column": [1, 2, 3, 4], "unit": "quaternion", "factors": [1]}
                }
            },
            "factors is for numbers",
        ),
    ],
    ids=str,
)
def test_a_wrong_map_is_a_setting_that_says_where(table, words):
    with pytest.raises(SettingsError, match=r"my\.toml") as caught:
        parse_map(table, "my.toml")
    assert words in str(caught.value), str(caught.value)


def test_a_whole_number_too_long_for_a_float_is_refused_in_one_line():
    with pytest.raises(SettingsError, match="longer than a number can be"):
        number(10**400, "map.toml: [constant] depth")


def test_a_map_that_asks_for_a_column_that_is_not_there(columns, write_csv, refused):
    by = parse_map({"columns": {"rudder_angle_deg": 30}}, "m.toml")
    refused(write_csv(columns), "has 9 columns, so there is no column 30", by=by)
    by = parse_map({"columns": {"rudder_angle_deg": "RUD"}}, "m.toml")
    refused(write_csv(columns), "has no column 'RUD'", "optional = true", by=by)


def test_an_optional_column_may_be_absent_and_any_other_may_not(columns, write_csv, refused):
    path = write_csv(columns)
    by = {
        "columns": {n: n for n in columns if n != "time_s"}
        | {"roll_deg": {"column": "Heel", "optional": True}}
    }
    voyage = read_voyage(path, parse_map(by, "m.toml"))
    assert not voyage.has("roll_deg") and "the optional column 'Heel' is not there" in voyage.meta["notes"]
    refused(
        path,
        "no column 'Heel'",
        by=parse_map(by | {"columns": by["columns"] | {"roll_deg": "Heel"}}, "m.toml"),
    )
    with pytest.raises(SettingsError, match="cannot be optional"):
        parse_map({"columns": {"surge_velocity_mps": {"column": "u", "optional": True}}}, "m.toml")


def test_the_factor_of_a_single_column_counts(columns, write_csv):
    by = parse_map({"columns": {"rudder_angle_deg": {"factors": [-0.5]}}}, "m.toml")
    rudder = read_voyage(write_csv(columns), by)["rudder_angle_deg"]
    np.testing.assert_allclose(rudder, -0.5 * columns["rudder_angle_deg"], rtol=1e-7)


@pytest.mark.parametrize("left_out", [("lat",), ("NS",), ("lat", "NS")], ids=" ".join)
@pytest.mark.parametrize("entry", [{"unit": "dms"}, {"hemisphere": "NS"}], ids=str)
def test_an_optional_position_as_text_or_with_its_letter_may_be_absent(columns, write_csv, entry, left_out):
    """Expected: it is read where all of its columns are there, and left out, with a word, where one is not."""
    lat = {"lat": np.full(columns["time_s"].size, 57.0), "NS": ["S"] * columns["time_s"].size}
    motion = {n: x for n, x in columns.items() if n not in ("north_m", "east_m")} | {
        "longitude_deg": 11.0 * lat["lat"] / 57.0
    }
    by = parse_map({"columns": {"latitude_deg": {"column": "lat", "optional": True, **entry}}}, "m.toml")
    needed = {"lat", *entry.values()} & set(lat)
    for there in (lat, {n: x for n, x in lat.items() if n not in left_out}):
        v = read_voyage(write_csv(motion | there), by)
        assert ("latitude_deg" in v.meta["given"]) == (needed <= set(there))
        for name in needed - set(there):
            assert f"the optional column {name!r} is not there" in v.meta["notes"]

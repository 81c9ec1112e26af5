"""Maps that scale, add columns, take hemispheres, text and clocks in parts; maps that are proposed."""

import tomllib

import numpy as np
import pytest

from twin.errors import DataError, SettingsError
from twin.recording.cells import without_deviation
from twin.recording.columns_seen import columns_seen
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.recording.sheet import find_separator
from twin.recording.suggest_map import suggestion

ROWS = 40
T = np.arange(ROWS, dtype=float)
PSI = 40.0 + 0.5 * T


def table(tmp_path, **columns):
    path = tmp_path / "own.csv"
    rows = zip(*columns.values(), strict=True)
    path.write_text(
        "\n".join(
            [
                ",".join(columns),
                *(",".join(x if isinstance(x, str) else f"{x:.10g}" for x in row) for row in rows),
            ]
        )
        + "\n"
    )
    return path


def base(**more):
    return {
        "north_m": "n",
        "east_m": "e",
        "heading_true_north_deg": "h",
        "rudder_angle_deg": "d",
        "propeller_rate_rpm": "rpm",
    } | more


def columns(**more):
    return {"t": T, "n": 6.0 * T, "e": T, "h": PSI, "d": np.sin(T), "rpm": 0 * T + 80.0} | more


def read(path, entries, **time):
    return read_voyage(path, parse_map({"time": time or {"column": "t"}, "columns": entries}, "m"))


def test_a_factor_and_the_sum_of_two_columns(tmp_path):
    path = table(tmp_path, **columns(coarse=np.floor(PSI), fine=1000 * (PSI % 1.0)))
    v = read(
        path,
        base(
            heading_true_north_deg={"column": ["coarse", "fine"], "factors": [1, 0.001]},
            propeller_rate_rpm={"column": "rpm", "factor": 0.25},
        ),
    )
    np.testing.assert_allclose(v["heading_true_north_deg"], PSI)
    np.testing.assert_allclose(v["propeller_rate_rpm"], 20.0)


def test_seconds_and_nanoseconds_make_a_clock(tmp_path):
    v = read(
        table(tmp_path, **columns(s=1.7e9 + T, ns=0 * T + 250e6)),
        base(),
        column=["s", "ns"],
        factors=[1, 1e-9],
    )
    assert v.duration_s == ROWS - 1 and v.meta["start_time_utc"].endswith("20.250000Z")


def test_degrees_and_minutes_as_text_and_a_column_for_the_hemisphere(tmp_path):
    lat = [f"57°{30 + 0.003 * k:.4f}'S" for k in range(ROWS)]
    lon = [f"{11 + 1e-5 * k:.6f}" for k in range(ROWS)]
    path = table(tmp_path, **columns(lat=lat, lon=lon, ew=["W"] * ROWS))
    entries = {k: c for k, c in base().items() if k not in ("north_m", "east_m")}
    v = read(
        path,
        entries
        | {
            "latitude_deg": {"column": "lat", "unit": "dms"},
            "longitude_deg": {"column": "lon", "hemisphere": "ew"},
        },
    )
    assert v.meta["datum"] == pytest.approx({"latitude_deg": -57.5, "longitude_deg": -11.0})
    assert v["north_m"][-1] < -200.0 and v["east_m"][-1] < -20.0


def test_a_quaternion_is_a_heading(tmp_path):
    half = np.radians(PSI) / 2.0
    path = table(tmp_path, **columns(x=0 * T, y=0 * T, z=np.sin(half), w=np.cos(half)))
    v = read(path, base(heading_true_north_deg={"column": ["x", "y", "z", "w"], "unit": "quaternion"}))
    np.testing.assert_allclose(v["heading_true_north_deg"], PSI)
    v = read(path, base(heading_true_north_deg={"column": ["x", "y", "z", "w"], "unit": "quaternion_enu"}))
    np.testing.assert_allclose(v["heading_true_north_deg"], 90.0 - PSI)


def test_what_is_late_stands_where_it_was_true(tmp_path):
    path = table(tmp_path, **columns(h=40.0 + 0.5 * (T - 3.0)))
    v = read(path, base(heading_true_north_deg={"column": "h", "late_s": 3.0}))
    there = np.isfinite(v["heading_true_north_deg"])
    np.testing.assert_allclose(v["heading_true_north_deg"][there], PSI[there])
    assert there.sum() == ROWS - 3


def test_a_deviation_is_taken_out():
    true = np.linspace(0.0, 359.0, 200)
    x = np.radians(true)
    shown = true + 2.0 + 8.0 * np.sin(x) - 3.0 * np.cos(x) + 1.5 * np.sin(2 * x) + 0.5 * np.cos(2 * x)
    np.testing.assert_allclose(without_deviation(shown, (2.0, 8.0, -3.0, 1.5, 0.5)), true, atol=1e-6)


def test_fractions_of_a_second_without_leading_zeros_are_counted(tmp_path):
    stamps = [f"2025/04/11 12:08:{17 + k // 4}.{250_000_000 * (k % 4) + 7_000_000}" for k in range(ROWS)]
    v = read(table(tmp_path, **columns(t=stamps)), base(), column="t", format="%Y/%m/%d %H:%M:%S.%f")
    np.testing.assert_allclose(np.diff(v.time_s), 0.25, atol=1e-6)


@pytest.mark.parametrize(
    "entry, words",
    [
        ({"column": ["a", "b"], "factors": [1]}, "factors needs 2 numbers"),
        ({"column": ["a", "b"], "unit": "quaternion"}, "four of them"),
        ({"column": "a", "deviation": [1, 2, 3, 4, 5, 6]}, "at most five"),
        ({"column": "a", "factor": "x"}, "must be"),
    ],
)
def test_a_map_that_cannot_be_meant_so_says_why(entry, words):
    with pytest.raises(SettingsError, match=words):
        parse_map({"columns": {"heading_true_north_deg": entry}}, "m")


def test_a_map_is_proposed_for_a_bridges_export_and_reads_it(tmp_path):
    """Test: names and units of a bridge system, speed in knots and rate in deg/min without saying so.
    Expected: both found, by how it moves."""
    t = np.arange(300.0)
    psi = 45.0 + 20.0 * np.sin(t / 15.0)
    way = 6.0 * np.exp(1j * np.radians(psi))
    place = np.r_[0.0, np.cumsum((way[1:] + way[:-1]) / 2.0)]
    path = table(
        tmp_path,
        Time=t,
        Lat=57 + place.real / 111_360,
        Lon=11 + place.imag / 60_650,
        HDG=psi % 360,
        SOG=0 * t + 6 / 0.514444,
        COG=psi,
        ROT=60 * 20 / 15 * np.cos(t / 15),
        Rudder=5 * np.cos(t / 15),
        ShaftRPM=0 * t + 84,
        RudderOrder=0 * t,
    )
    text = suggestion([path], {})
    by = parse_map(tomllib.loads(text), "proposed")
    assert (
        by.columns["surge_velocity_mps"].unit == "kn" and by.columns["surge_velocity_mps"].frame == "course"
    )
    assert (
        by.columns["yaw_rate_degps"].unit == "deg/min" and by.columns["rudder_angle_deg"].column == "Rudder"
    )
    assert "not used: RudderOrder" in text and read_voyage(path, by).has("surge_velocity_mps")


def test_an_easting_beside_a_longitude_is_no_position():
    entries = {"latitude_deg": "lat", "longitude_deg": "lon", "east_m": {"column": "lon", "sign": -1}}
    with pytest.raises(SettingsError, match="belongs to longitude_deg"):
        parse_map({"columns": entries}, "m")


@pytest.mark.parametrize(
    ("line", "separator"),
    [
        ("Time;N;E", ";"),
        ("0,00000;-0,01116;1,5e-3;;7,2", ";"),
        ("0,0\t1,5\t2,5\t-3,1", "\t"),
        ("0.5,1.5;2.5,3.5,4", ","),  # commas that are those of no decimal
        ("a,b,c;d", ","),
        ("1.0 2.0", " "),
    ],
)
def test_the_separator_is_not_the_comma_of_a_decimal(line, separator):
    assert find_separator(line) == separator


def test_a_header_above_decimal_commas_is_no_line_to_be_skipped(tmp_path):
    """Test: one semicolon fewer than decimal commas in a row, and rows with gaps. Expected: the names are found."""
    rows = [f"{k},5;{k},25;;{k},75" if k % 3 else f"{k},5;;;" for k in range(60)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["Time;Heading;Rudder;RPM", *rows]) + "\n")
    seen = columns_seen(path)
    assert seen.names == ["Time", "Heading", "Rudder", "RPM"] and seen.layout == {}
    assert seen.numbers("Heading")[1] == 1.25


def test_a_table_without_names_is_one_line_with_what_to_do(tmp_path):
    path = tmp_path / "bare.csv"
    path.write_text("\n".join(f"{k},5;{k},25;{k},75" for k in range(60)) + "\n")
    with pytest.raises(DataError, match="line 1 has numbers where the names of the 3 columns should be") as e:
        columns_seen(path)
    assert "header = false" in str(e.value) and "\n" not in str(e.value)

"""Tables as other people write them: what --suggest-map proposes reads them, and gives back what was sailed."""

import tomllib
from datetime import datetime, timedelta

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.formats.actuator_guess import guess_actuator
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.recording.suggest_clock import clock_unit, text_format
from twin.recording.suggest_map import proved, suggestion

KNOT = 1852.0 / 3600.0
T = np.arange(400.0)
PSI = 45.0 + 30.0 * np.sin(T / 20.0)
RATE = 30.0 / 20.0 * np.cos(T / 20.0)
WAY = 6.0 * np.exp(1j * np.radians(PSI))
PLACE = np.r_[0.0, np.cumsum((WAY[1:] + WAY[:-1]) / 2.0)]
LAT, LON = 57.5 + PLACE.real / 111_360.0, 11.2 + PLACE.imag / (111_320.0 * np.cos(np.radians(57.5)))
RUDDER, TURNS = 5.0 * np.cos(T / 20.0), 84.0 + np.sin(T / 50.0)
SAILED = {
    "heading_true_north_deg": PSI,
    "surge_velocity_mps": 6.0 + 0.0 * T,
    "yaw_rate_degps": RATE,
    "rudder_angle_deg": RUDDER,
    "propeller_rate_rpm": TURNS,
}
NEAR = {"surge_velocity_mps": 0.1, "yaw_rate_degps": 0.02}


def stamps(form):
    return [(datetime(2024, 5, 17, 8, 30) + timedelta(seconds=t)).strftime(form) for t in T]


def write(path, columns, separator=",", decimal=".", above="", under=""):
    def cell(x):
        return x if isinstance(x, str) else f"{x:.7f}".replace(".", decimal)

    rows = [separator.join(map(cell, row)) for row in zip(*columns.values(), strict=True)]
    path.write_text(above + separator.join(columns) + "\n" + under + "\n".join(rows) + "\n", encoding="utf-8")
    return path


def read(path):
    text = suggestion([path], {})
    return read_voyage(path, parse_map(tomllib.loads(text), "proposed")), text


def agrees(v, names=SAILED):
    for name in names:
        np.testing.assert_allclose(v[name], SAILED[name], atol=NEAR.get(name, 0.02), err_msg=name)


GERMAN = {
    "Datum": stamps("%d.%m.%Y"), "Uhrzeit": stamps("%H:%M:%S"), "Breite": LAT, "Länge": LON, "Kurs": PSI,
    "KüG": PSI, "FüG": 6.0 / KNOT + 0 * T, "Drehrate": RATE * 60, "Ruderlage": RUDDER, "Drehzahl": TURNS,
}  # fmt: skip
AMERICAN = {
    "Timestamp": stamps("%m/%d/%Y %I:%M:%S %p"), "Lat": LAT, "Lon": LON, "Heading": PSI, "SOG": 6.0 / KNOT + 0 * T,
    "COG": PSI, "ROT": RATE * 60, "Rudder": RUDDER, "RPM": TURNS,
}  # fmt: skip
LETTERS = {
    "t": T, "x": PLACE.real, "y": PLACE.imag, "psi": np.radians(PSI), "u": 6.0 + 0 * T, "v": 0 * T,
    "r": np.radians(RATE), "delta": np.radians(RUDDER), "n": TURNS / 60,
}  # fmt: skip
SIGNALK = {
    "datetime": stamps("%Y-%m-%dT%H:%M:%SZ"), "navigation.position.latitude": LAT,
    "navigation.position.longitude": LON, "navigation.headingTrue": np.radians(PSI),
    "navigation.speedOverGround": 6.0 + 0 * T, "navigation.courseOverGroundTrue": np.radians(PSI),
    "navigation.rateOfTurn": np.radians(RATE), "steering.rudderAngle": np.radians(RUDDER),
    "propulsion.main.revolutions": TURNS / 60,
}  # fmt: skip
PARTS = {
    "Year": ["2024"] * 400, "Month": ["5"] * 400, "Day": ["17"] * 400, "Hour": stamps("%H"),
    "Minute": stamps("%M"), "Second": stamps("%S"), "latitude": LAT, "longitude": LON, "hdg": PSI,
    "speed (km/h)": 21.6 + 0 * T, "course": PSI, "yaw rate (deg/s)": RATE, "rudder": RUDDER,
    "Rotational speed (1/min)": TURNS,
}  # fmt: skip
SPREADSHEET = {"Utc": [f"{45429 + (30600 + t) / 86400:.9f}" for t in T], "BSP": 6 / KNOT + 0 * T, **dict(
    list(AMERICAN.items())[1:])}  # fmt: skip

BASIN = {
    "COUNT_ms": 7000 + 1000 * T, "Xo_mm": 1000 * PLACE.real, "Yo_mm": 1000 * PLACE.imag, "YAW_rad": np.radians(PSI),
    "u_mmps": 6000 + 0 * T, "v_mmps": 0 * T, "GYRO_Z_radps": np.radians(RATE), "RUD_deg": RUDDER, "n_rps": TURNS / 60,
}  # fmt: skip


@pytest.mark.parametrize(
    ("columns", "how"),
    [
        (GERMAN, {"separator": ";", "decimal": ","}),
        (AMERICAN, {}),
        (
            AMERICAN,
            {"above": "MV Alma\nExport 4711, system X\n\n", "under": ",deg,deg,deg,kn,deg,deg/min,deg,rpm\n"},
        ),
        (LETTERS, {"separator": " ", "above": "# "}),
        (SIGNALK, {"separator": "\t"}),
        (PARTS, {"separator": "|"}),
        (SPREADSHEET, {}),
        (BASIN, {"above": "Model 4711, free running\n"}),
    ],
    ids=[
        "german",
        "american",
        "lines-above-and-units",
        "letters",
        "signalk",
        "six-columns",
        "spreadsheet-days",
        "model-basin",
    ],
)
def test_a_table_goes_in_by_its_proposed_map(tmp_path, columns, how):
    """Expected: every channel as it was sailed, in whatever unit, language, clock and separator it stands."""
    v, text = read(write(tmp_path / "log.csv", columns, **how))
    assert "NOT FOUND" not in text
    agrees(v)
    assert np.ptp(v["north_m"]) == pytest.approx(np.ptp(PLACE.real), rel=0.01)


def test_names_that_stand_twice_are_told_apart_by_their_groups(tmp_path):
    """Test: `RPM` and `Rudder` of two sides, under a line of groups. Expected: each side's own."""
    names = "Time,Lat,Lon,Heading,Speed,Course,RPM,Rudder,RPM,Rudder"
    rows = zip(
        stamps("%H:%M:%S"),
        LAT,
        LON,
        PSI,
        0 * T + 6 / KNOT,
        PSI,
        TURNS,
        RUDDER,
        TURNS + 3,
        RUDDER + 1,
        strict=True,
    )
    lines = [",".join([row[0], *(f"{x:.7f}" for x in row[1:])]) for row in rows]
    path = tmp_path / "twin.csv"
    path.write_text("\n".join([",GPS,,Gyro,GPS,,Port,,Stbd,", names, *lines]) + "\n")
    v, _ = read(path)
    np.testing.assert_allclose(v["starboard.rate_rpm"] - v["port.rate_rpm"], 3.0, atol=1e-6)
    np.testing.assert_allclose(v["starboard.angle_deg"] - v["port.angle_deg"], 1.0, atol=1e-6)
    agrees(v, ("heading_true_north_deg", "surge_velocity_mps"))


@pytest.mark.parametrize(
    ("name", "values", "channel"),
    [
        ("thr_left", 1500 + 100 * np.sin(T), "port.pwm_us"),
        ("Stbd Throttle (%)", 50 + np.sin(T), "starboard.command"),
        ("cmd_right", 0.5 * np.sin(T), "starboard.command"),
        ("Azimuth 2 angle (deg)", 90 * np.sin(T), "azimuth_2.angle_deg"),
        ("left_force", 20 * np.sin(T), "port.thrust_n"),
        ("engine1_rpm", 3000 + T, "engine_1.rate_rpm"),
        ("Bow thruster rpm", 300 + T, "bow.rate_rpm"),
        ("motor 1 temperature", 60 + np.sin(T), None),
        ("heading", PSI, None),
        ("speed", 0 * T + 3, None),
    ],
)
def test_whose_a_column_is_and_what(name, values, channel):
    found = guess_actuator(name, values)
    assert (found.channel if found else None) == channel


def test_a_table_of_readings_is_read_by_their_names(tmp_path):
    """Test: a historian's export, a row a reading. Expected: proposed and read as a table; a name that is not
    there is one line."""
    shown = {"Latitude": LAT, "Longitude": LON, "Heading": PSI, "SOG [kn]": 6 / KNOT + 0 * T, "COG": PSI,
             "Rudder angle": RUDDER, "Shaft rpm": TURNS, "Rate of turn": RATE * 60}  # fmt: skip
    rows = [
        f"{at}Z,{n},{x[k]:.7f}" for k, at in enumerate(stamps("%Y-%m-%dT%H:%M:%S")) for n, x in shown.items()
    ]
    path = tmp_path / "long.csv"
    path.write_text("\n".join(["time,name,value", *rows]) + "\n")
    v, text = read(path)
    agrees(v)
    assert 'long = ["name", "value"]' in text
    wrong = parse_map(tomllib.loads(text.replace('"Shaft rpm"', '"Shaft"')), "m")
    with pytest.raises(DataError, match=r"no reading is called 'Shaft'.*Shaft rpm"):
        read_voyage(path, wrong)


def test_json_records_are_a_table(tmp_path):
    import json

    path = tmp_path / "log.json"
    records = [{"time": t, "gps": {"lat": a, "lon": o}, "heading": h, "rudder": d, "rpm": n}
               for t, a, o, h, d, n in zip(T, LAT, LON, PSI, RUDDER, TURNS, strict=True)]  # fmt: skip
    path.write_text(json.dumps(records))
    v, _ = read(path)
    agrees(v, ("heading_true_north_deg", "rudder_angle_deg", "propeller_rate_rpm"))


def test_the_axes_of_a_robot_are_turned(tmp_path):
    """Test: pose and twist as ROS counts them, in a table. Expected: north, east, heading and turning."""
    half = np.radians(90.0 - PSI) / 2.0
    columns = {
        "__time": 1.7e9 + T, "/odom/pose/pose/position/x": PLACE.imag, "/odom/pose/pose/position/y": PLACE.real,
        "/odom/pose/pose/orientation/x": 0 * T, "/odom/pose/pose/orientation/y": 0 * T,
        "/odom/pose/pose/orientation/z": np.sin(half), "/odom/pose/pose/orientation/w": np.cos(half),
        "/odom/twist/twist/linear/x": 6.0 + 0 * T, "/odom/twist/twist/angular/z": -np.radians(RATE),
        "/rudder/data": RUDDER, "/rpm/data": TURNS,
    }  # fmt: skip
    v, _ = read(write(tmp_path / "odom.csv", columns))
    agrees(v, ("heading_true_north_deg", "yaw_rate_degps", "rudder_angle_deg", "propeller_rate_rpm"))
    np.testing.assert_allclose(v["north_m"] - v["north_m"][0], PLACE.real, atol=1e-3)


@pytest.mark.parametrize(
    ("begins", "said"),
    [
        (b"MATLAB 5.0 MAT-file", "a MATLAB file"),
        (b"\x89HDF\r\n\x1a\n", "an HDF5 file"),
        (b"\xd0\xcf\x11\xe0", "before 2007"),
        (b'<?xml version="1.0"?>\n<gpx version="1.1">\n', "a GPX track"),
        (b"\xd4\xc3\xb2\xa1", "a capture of a network"),
    ],
)
def test_a_file_of_another_kind_is_named(tmp_path, begins, said):
    path = tmp_path / "file"
    path.write_bytes(begins + bytes(300))
    for asked in (read_voyage, lambda p: suggestion([p], {})):
        with pytest.raises(DataError, match=said) as caught:
            asked(path)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("stamp", "form"),
    [
        ("170524 083000", "%d%m%y %H%M%S"),
        ("17.05.2024 08:30:00,25", "%d.%m.%Y %H:%M:%S.%f"),
        ("May 17, 2024 8:30:00 AM", "%b %d, %Y %I:%M:%S %p"),
        ("08:30:00", "%H:%M:%S"),
    ],
)
def test_the_form_of_a_stamp(stamp, form):
    found = text_format([stamp])
    assert found == {"format": form}


def test_the_unit_of_a_clock_of_numbers():
    assert clock_unit(1.7e18 + 1e9 * T)[0] == "ns" and clock_unit(45429.0 + T / 86400.0)[0] == "excel"
    assert (
        clock_unit(1e6 * T)[0] == "us"
        and clock_unit(3.4e6 + 100.0 * T)[0] == "ms"
        and clock_unit(0.1 * T)[0] == "s"
    )


def test_a_clock_without_a_date_goes_on_past_midnight(tmp_path):
    day = [
        f"{(86200 + int(t)) // 3600 % 24:02d}:{(86200 + int(t)) // 60 % 60:02d}:{int(86200 + t) % 60:02d}"
        for t in T
    ]
    v, _ = read(
        write(tmp_path / "night.csv", {"time": day, "n": PLACE.real, **dict(list(AMERICAN.items())[1:])})
    )
    assert v.duration_s == 399.0


def test_a_stamp_years_ahead_is_one_line_and_takes_no_memory(tmp_path):
    """Test: the last of the stamps lies three hundred years ahead. Expected: a map, and what is wrong with the
    stamps at its head."""
    columns = {"epoch": np.r_[1.7e9 + T[:-1], 1e10], **dict(list(AMERICAN.items())[1:])}
    text = suggestion([write(tmp_path / "far.csv", columns)], {})
    assert "cannot be imported by it yet" in text and "leaps ahead" in text


def test_what_a_check_proves_of_a_frame_is_in_the_proposal(tmp_path):
    """Test: velocities to north and east under the names u and v. Expected: their frame, to be confirmed."""
    path = write(tmp_path / "earth.txt", LETTERS | {"u": WAY.real, "v": WAY.imag}, separator=" ")
    v, text = read(path)
    agrees(v, ("surge_velocity_mps", "heading_true_north_deg"))
    assert text.count('frame = "earth"') == 2 and "prove. CONFIRM" in text


def test_a_unit_of_time_that_a_check_proves_is_written_in():
    """The name of the column says seconds, the ship's motion says milliseconds."""
    said = '# velocity_frame: all of it agrees; that is believed. In the map: [time] unit = "ms".\n[time]\nunit = "s"\n'
    time = {"column": "time_s", "unit": "s", "why": "unit by its name"}
    assert proved({}, time, said)
    assert time["unit"] == "ms" and time["why"].endswith("CONFIRM")
    either = said.replace('"ms".', '"ms", or unit = "km" for positions')
    untouched = {"column": "time_s", "unit": "s"}
    assert not proved({}, untouched, either)
    assert untouched["unit"] == "s"

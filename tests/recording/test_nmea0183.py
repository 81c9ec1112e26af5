"""NMEA 0183 as it is recorded becomes the voyage that was sailed."""

import numpy as np
import pytest

from tests.recording.conftest import nmea_lines, sentence
from twin.errors import DataError, SettingsError
from twin.recording.formats import recognised
from twin.recording.formats.nmea0183 import checksum, read
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage


def log(tmp_path, lines, name="bridge.log"):
    path = tmp_path / name
    path.write_text("\r\n".join(lines) + "\r\n")
    return path


def bridge(m, front=lambda i: ""):
    return [front(i) + s for i in range(m["t"].size) for s in nmea_lines(m, i)]


def test_a_bridge_log_goes_in_as_it_is(tmp_path, sailed):
    path = log(tmp_path, bridge(sailed))
    assert recognised(path).name == "nmea0183"
    v = read_voyage(path)
    assert len(v) == 120 and v.meta["start_time_utc"] == "2026-11-25T12:00:00Z"
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"], atol=0.006)
    np.testing.assert_allclose(v["yaw_rate_degps"], sailed["rate"], atol=1e-3)
    np.testing.assert_allclose(v["north_m"], sailed["place"].real, atol=1.0)
    np.testing.assert_allclose(v["surge_velocity_mps"], 6.0, atol=0.01)
    np.testing.assert_allclose(v["apparent_wind_speed_mps"], 12.0 * 1852 / 3600)
    assert any("AIS sentences" in note for note in v.meta["notes"])


@pytest.mark.parametrize(
    "front",
    [
        lambda i: f"2026-11-25T12:{i // 60:02d}:{i % 60:02d}.250Z ",
        lambda i: f"{1795608000.25 + i:.2f} ",
        lambda i: f"{1795608000250 + 1000 * i};multiplexer;",
        lambda i: f"\\s:bridge1,c:{1795608000 + i}*1F\\",
        lambda i: f"UdPbC\0\\s:GP0001,c:{1795608000 + i}*1F\\",
    ],
)
def test_the_stamp_in_front_of_a_sentence_is_its_time(tmp_path, sailed, front):
    v = read_voyage(log(tmp_path, bridge(sailed, front)))
    assert v.meta["start_time_utc"].startswith("2026-11-25T12:00:00") and v.duration_s == pytest.approx(119.0)
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"], atol=0.006)


def test_a_sentence_that_comes_five_times_a_second_stands_at_five_times(tmp_path, sailed):
    lines = []
    for i in range(60):
        rows = nmea_lines(sailed, i)
        lines += [
            rows[0],
            *(sentence(f"HEHDT,{sailed['psi'][i] + 0.2 * k * sailed['rate'][i]:.2f},T") for k in range(5)),
            *rows[2:],
        ]
    t, x = read(log(tmp_path, lines)).series["HEHDT.heading"].arrays()
    np.testing.assert_allclose(np.diff(t), 0.2, atol=1e-6)
    assert np.abs(np.diff(x)).max() < 0.4


def test_a_damaged_sentence_is_left_out_and_counted(tmp_path, sailed):
    lines = bridge(sailed)
    lines[8] = lines[8][:8] + "9" + lines[8][9:]  # a digit of the heading
    found = read(log(tmp_path, lines))
    assert found.skipped["sentences with a wrong checksum"] == 1 and len(found.series["HEHDT.heading"]) == 119


@pytest.mark.parametrize(
    "body",
    [
        "HEHDT,45.0,T",
        "A" * 63,
        "B" * 64,
        "C" * 65,
        "GPGGA,195719,5310.8115,N,00525.7025,E,1,00,1.10,-2,M,,M,," * 2,
    ],
)
def test_the_checksum_is_the_exclusive_or_of_all_bytes(body):
    by_hand = 0
    for byte in body.encode():
        by_hand ^= byte
    assert checksum(body.encode()) == by_hand


def test_two_talkers_are_kept_apart_and_one_can_be_chosen(tmp_path, sailed):
    lines = [
        s
        for i in range(120)
        for s in [*nmea_lines(sailed, i), sentence(f"GPHDT,{sailed['psi'][i] + 3:.2f},T")]
    ]
    path = log(tmp_path, lines)
    first, second = read_voyage(path), read_voyage(path, sources={"heading_true_north_deg": "GP"})
    np.testing.assert_allclose(
        second["heading_true_north_deg"] - first["heading_true_north_deg"], 3.0, atol=0.02
    )
    assert any("HEHDT.heading is used, not GPHDT.heading" in note for note in first.meta["notes"])
    by = parse_map({"columns": {"heading_true_north_deg": "GPHDT.heading"}}, "of a person")
    third = read_voyage(path, by)
    np.testing.assert_array_equal(third["heading_true_north_deg"], second["heading_true_north_deg"])
    assert not any("HEHDT.heading is used" in note for note in third.meta["notes"])
    with pytest.raises(SettingsError, match="its sources are GP, HE"):
        read_voyage(path, sources={"heading_true_north_deg": "XX"})


def test_of_a_table_no_instrument_can_be_chosen(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("time_s,heading_true_north_deg\n0,1\n1,2\n")
    with pytest.raises(SettingsError, match="one column for each quantity and names no instruments"):
        read_voyage(path, sources={"heading_true_north_deg": "GP"})


def test_midnight_passes_without_a_date(tmp_path):
    lines = [
        sentence(f"GPGLL,5700.0000,N,01100.0000,E,{t // 3600 % 24:02d}{t // 60 % 60:02d}{t % 60:02d},A,A")
        for t in range(86390, 86420)
    ]
    t, _ = read(log(tmp_path, lines)).series["GPGLL.latitude"].arrays()
    np.testing.assert_allclose(np.diff(t), 1.0)


def test_a_clock_that_was_set_back_by_an_hour_is_refused_with_its_line(tmp_path, sailed):
    lines = bridge(sailed)
    lines[420:] = [
        sentence(s[1:].partition("*")[0].replace("GPRMC,12", "GPRMC,11")) if s.startswith("$GPRMC") else s
        for s in lines[420:]
    ]
    with pytest.raises(DataError, match="line 421: the clock steps back by 3599 s, an hour"):
        read(log(tmp_path, lines))


def test_what_a_log_lacks_is_one_line_that_says_what_it_is(tmp_path, sailed):
    lines = [s for s in bridge(sailed) if "RSA" not in s and "RPM" not in s]
    with pytest.raises(
        DataError,
        match=r"this is an NMEA 0183 log; a voyage needs rudder_angle_deg, "
        r"propeller_rate_rpm.*--without-controls",
    ) as caught:
        read_voyage(log(tmp_path, lines))
    assert "\n" not in str(caught.value)
    assert read_voyage(log(tmp_path, lines), controls=False).has("heading_true_north_deg")


def test_a_magnetic_heading_becomes_true_by_the_variation_in_the_log(tmp_path, sailed):
    lines = [s.replace("HEHDT", "HCHDG") for s in bridge(sailed)]
    lines = [sentence(f"HCHDG,{s.split(',')[1]},,,4.5,E") if "HCHDG" in s else s for s in lines]
    v = read_voyage(log(tmp_path, lines))
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"] + 4.5, atol=0.006)
    assert any("magnetic" in note or "variation" in note for note in v.meta["notes"])

"""Logs of other firmware, message types and talkers than the usual: each is read, or proposed by its names."""

import re
import tomllib
from struct import pack

import numpy as np
import pytest

from tests.recording.conftest import nmea_lines, sentence
from twin.recording.formats.ros_messages import numbers
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.recording.suggest_map import suggestion

SIZES = {"Q": "Q", "B": "B", "H": "H", "L": "i", "f": "f", "c": "h", "C": "H", "N": "16s"}


def proposed(path):
    text = suggestion([path], {})
    return read_voyage(path, parse_map(tomllib.loads(text), "proposed"), controls=False), text


def dataflash(m, kinds, settings=()):
    """A DataFlash log: {name: (format, labels, row(i))} and the boat's settings."""

    def fmt(kind, form, name, labels):
        width = sum(len(pack("<" + SIZES[c], b"" if c == "N" else 0)) for c in form)
        return b"\xa3\x95\x80" + pack(
            "<BB4s16s64s", kind, 3 + width, name.encode(), form.encode(), labels.encode()
        )

    out = b"\xa3\x95\x80" + pack("<BB4s16s64s", 128, 89, b"FMT", b"BBnNZ", b"Type,Length,Name,Format,Columns")
    out += fmt(129, "QNf", "PARM", "TimeUS,Name,Value")
    for k, (name, (form, labels, _)) in enumerate(kinds.items(), 130):
        out += fmt(k, form, name, labels)
    for name, value in settings:
        out += b"\xa3\x95\x81" + pack("<Q16sf", 1, name.encode(), value)
    for i in range(m["t"].size):
        for k, (form, _, row) in enumerate(kinds.values(), 130):
            values = (int(m["t"][i] * 1e6) + 1_000_000, *row(i))
            out += b"\xa3\x95" + bytes([k]) + pack("<" + "".join(SIZES[c] for c in form), *values)
    return out


def boat(m):
    return {
        "GPS": (
            "QBLLff",
            "TimeUS,Status,Lat,Lng,Spd,GCrs",
            lambda i: (3, round(m["latitude"][i] * 1e7), round(m["longitude"][i] * 1e7), 6.0, m["psi"][i]),
        ),
        "ATT": ("QccC", "TimeUS,Roll,Pitch,Yaw", lambda i: (0, 0, round(m["psi"][i] * 100))),
    }


def turned(m):
    return np.round(100 * np.sin(m["t"] / 15.0))


@pytest.fixture
def flash(tmp_path, sailed):
    pytest.importorskip("pymavlink", reason="needs the extra io")

    def write(kinds, settings=()):
        path = tmp_path / "00000001.BIN"
        path.write_bytes(dataflash(sailed, boat(sailed) | kinds, settings))
        return path

    return write


def test_a_boats_settings_say_which_output_is_which_thruster(flash, sailed):
    """Test: outputs 1 and 3 set as left and right throttle, the right one reversed about 1511. Expected: both
    sides by themselves, ahead positive, and the stop told."""
    by = turned(sailed)
    row = lambda i: (int(1600 + by[i]), 1500, int(1422 + by[i]))
    settings = [
        ("SERVO1_FUNCTION", 73),
        ("SERVO3_FUNCTION", 74),
        ("SERVO3_REVERSED", 1),
        ("SERVO3_TRIM", 1511),
    ]
    v = read_voyage(flash({"RCOU": ("QHHH", "TimeUS,C1,C2,C3", row)}, settings))
    np.testing.assert_allclose(v["port.pwm_us"], 1600 + by)
    np.testing.assert_allclose(v["starboard.pwm_us"], 1600 - by)
    assert any("zero = 0.0275" in n for n in v.meta["notes"])


def test_a_steered_boats_outputs_are_proposed(flash, sailed):
    row = lambda i: (int(1500 + turned(sailed)[i]), 1700)
    settings = [("SERVO1_FUNCTION", 26), ("SERVO2_FUNCTION", 70)]
    v, text = proposed(flash({"RCOU": ("QHH", "TimeUS,C1,C2", row)}, settings))
    np.testing.assert_allclose(v["main.angle_deg"], turned(sailed) * 35.0 / 400.0, atol=1e-3)
    assert "main.pwm_us" in text and "CONFIRM" in text


def test_parts_that_another_version_names_otherwise_do_not_end_the_log(flash, sailed):
    """Test: one rate a message, wind by other names, rates of two controllers. Expected: all else is read."""
    kinds = {
        "RPM": ("QBf", "TimeUS,I,RPM", lambda i: (0, 84.0)),
        "WIND": ("Qff", "TimeUS,Dir,Spd", lambda i: (1.0, 2.0)),
        "ESC": ("QBf", "TimeUS,Instance,RPM", lambda i: (1, 900.0)),
    }
    v = read_voyage(flash(kinds), controls=False)
    np.testing.assert_allclose(v["propeller_rate_rpm"][np.isfinite(v["propeller_rate_rpm"])], 84.0)
    assert len(v) >= sailed["t"].size and np.nanmedian(v["motor_2.rate_rpm"]) == 900.0
    assert any("WIND messages that hold other parts" in n for n in v.meta["notes"])


def test_noise_within_a_log_is_not_printed(flash, capfd):
    """Test: 200 bytes of something else in the middle. Expected: no word on the terminal, and the rest is read."""
    path = flash({})
    whole = path.read_bytes()
    path.write_bytes(whole[:6000] + bytes(range(200)) + whole[6000:])
    assert len(read_voyage(path, controls=False)) > 50 and capfd.readouterr() == ("", "")


def test_telemetry_without_an_attitude_has_other_messages(tmp_path, sailed):
    pytest.importorskip("pymavlink", reason="needs the extra io")
    from pymavlink.dialects.v20 import ardupilotmega

    link, out = ardupilotmega.MAVLink(None, srcSystem=1, srcComponent=1), bytearray()
    for i, t in enumerate(sailed["t"]):
        half, place = np.radians(sailed["psi"][i]) / 2.0, sailed["place"][i]
        for message in (
            link.attitude_quaternion_encode(
                int(t * 1e3), float(np.cos(half)), 0.0, 0.0, float(np.sin(half)), 0.0, 0.0, 0.0
            ),
            link.local_position_ned_encode(int(t * 1e3), place.real, place.imag, 0.0, 0.0, 0.0, 0.0),
            link.esc_telemetry_1_to_4_encode([20] * 4, [1] * 4, [1] * 4, [1] * 4, [800, 810, 0, 0], [0] * 4),
        ):
            out += int((1795608000 + t) * 1e6).to_bytes(8, "big") + message.pack(link)
    path = tmp_path / "a.tlog"
    path.write_bytes(bytes(out))
    v = read_voyage(path)
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"], atol=1e-3)
    assert v["motor_2.rate_rpm"][5] == 810.0 and not v.has("motor_3.rate_rpm")
    np.testing.assert_allclose(v["north_m"], sailed["place"].real, atol=1e-2)


def ulog(topics, size):
    """The bytes of a ULog: {topic: (fields, row(i))}, once a second."""

    def message(kind, body):
        return pack("<HB", len(body), ord(kind)) + body

    out = b"ULog\x01\x12\x35\x01" + pack("<Q", 0) + message("B", bytes(40))
    for name, (fields, _) in topics.items():
        out += message("F", f"{name}:uint64_t timestamp;{fields}".encode())
    for k, name in enumerate(topics):
        out += message("A", pack("<BH", 0, k) + name.encode())
    for i in range(size):
        for k, (_, row) in enumerate(topics.values()):
            out += message("D", pack("<HQ", k, (i + 1) * 10**6) + row(i))
    return out


def test_px4_of_other_versions(tmp_path, sailed):
    """Test: speed and course in place of velocities, an attitude with rates, orders of two motors. Expected:
    read; the motors by their proposed map; a topic without its parts is told."""
    pytest.importorskip("pyulog", reason="needs the extra io")
    m, half = sailed, np.radians(sailed["psi"]) / 2.0
    topics = {
        "vehicle_attitude": (
            "float[4] q;float yawspeed;",
            lambda i: pack("<5f", np.cos(half[i]), 0, 0, np.sin(half[i]), np.radians(m["rate"][i])),
        ),
        "vehicle_gps_position": (
            "int32_t lat;int32_t lon;float vel_m_s;float cog_rad;uint8_t fix_type;",
            lambda i: pack(
                "<iiffB",
                round(m["latitude"][i] * 1e7),
                round(m["longitude"][i] * 1e7),
                6,
                np.radians(m["psi"][i]),
                3,
            ),
        ),
        "actuator_motors": ("float[2] control;", lambda i: pack("<ff", 0.5 + 0.001 * i, 0.5 - 0.001 * i)),
        "wind": ("float other;", lambda i: pack("<f", 0.0)),
    }
    path = tmp_path / "log.ulg"
    path.write_bytes(ulog(topics, m["t"].size))
    v, _ = proposed(path)
    np.testing.assert_allclose(v["surge_velocity_mps"][5:-5], 6.0, atol=0.05)
    np.testing.assert_allclose(v["yaw_rate_degps"], m["rate"], atol=1e-4)
    np.testing.assert_allclose(v["motor_1.command"], 0.5 + 0.001 * np.arange(m["t"].size), atol=1e-6)
    assert any("wind is not read: it has no windspeed_north" in n for n in v.meta["notes"])


def test_lists_in_messages_are_numbers_and_covariances_are_not():
    class Message:
        __dataclass_fields__ = dict.fromkeys(("data", "covariance", "name", "speed"))
        data, covariance, name, speed = np.array([1.5, 2.5]), np.zeros(9), "x", 3.0

    assert [(part, x) for part, _, x in numbers(Message())] == [
        ("data_1", 1.5),
        ("data_2", 2.5),
        ("speed", 3.0),
    ]


def plain(m, i):
    return [s for s in nmea_lines(m, i) if "RPM," not in s and "RSA," not in s]


def nmea(tmp_path, m, *more):
    """A bridge's log: position, and the sentences given by `more(i)`."""
    lines = [s for i in range(m["t"].size) for s in (*plain(m, i), *(sentence(one(i)) for one in more))]
    path = tmp_path / "bridge.log"
    path.write_text("\r\n".join(lines) + "\r\n")
    return path


def test_two_shafts_and_rudders_of_a_bridge_are_proposed_by_side(tmp_path, sailed):
    """Expected: odd shafts to starboard, even ones to port, beside the one shaft that is taken by itself."""
    path = nmea(
        tmp_path,
        sailed,
        lambda i: f"IIRSA,{sailed['rudder'][i]:.2f},A,{sailed['rudder'][i] - 2:.2f},A",
        lambda i: f"IIRPM,S,1,{84 + i % 7:.1f},100,A",
        lambda i: f"IIRPM,S,2,{80 + i % 7:.1f},100,A",
    )
    v, text = proposed(path)
    assert re.search(r'"port\.rate_rpm" = "IIRPM\.shaft2"', text)
    np.testing.assert_allclose(v["starboard.rate_rpm"] - v["port.rate_rpm"], 4.0)
    both = np.isfinite(v["starboard.angle_deg"]) & np.isfinite(v["port.angle_deg"])
    np.testing.assert_allclose((v["starboard.angle_deg"] - v["port.angle_deg"])[both], 2.0, atol=0.02)


def test_thrusters_and_an_inertial_unit_of_a_bridge(tmp_path, sailed):
    path = nmea(
        tmp_path,
        sailed,
        lambda i: f"IITRD,1,{300 + i},R,,,{20 + i % 5}",
        lambda i: f"IITRD,2,{310 + i},R,,,{10 + i % 5}",
        lambda i: f"PASHR,120000.00,{sailed['psi'][i]:.2f},T,1.50,0.10,0.00,0.1,0.1,0.1,1",
    )
    v, _ = proposed(path)
    assert np.nanmax(v["thruster_2.rate_rpm"]) == 310 + sailed["t"].size - 1
    assert v.has("thruster_1.angle_deg") and np.nanmedian(v["roll_deg"]) == 1.5

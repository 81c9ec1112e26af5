"""NMEA 2000 in each form in which it is written down gives the same series."""

import json
from struct import pack

import numpy as np
import pytest

from twin.recording.formats import recognised
from twin.recording.formats.nmea2000 import of_can_id, read
from twin.recording.formats.nmea2000_pgns import FastPackets

START = 1795608000.0
ANGLE = 1e-4


def frames(m):
    """(time, group, source, eight bytes) of heading, rate, rudder, position, course and engine; two
    compasses."""
    for i, t in enumerate(m["t"]):
        psi, r = np.radians(m["psi"][i]), np.radians(m["rate"][i])
        yield t, 127250, 52, pack("<BHhhB", 0xFF, round(psi / ANGLE), 0x7FFF, 0x7FFF, 0xFC)
        yield t, 127250, 25, pack("<BHhhB", 0xFF, round((psi + 0.05) / ANGLE), 0x7FFF, 0x7FFF, 0xFC)
        yield t, 127251, 52, pack("<BiBBB", 0xFF, round(r / 3.125e-8), 255, 255, 255)
        yield (
            t,
            127245,
            13,
            pack("<BBhhH", 0, 0xFF, 0x7FFF, round(np.radians(m["rudder"][i]) / ANGLE), 0xFFFF),
        )
        yield t, 129025, 52, pack("<ii", round(m["latitude"][i] * 1e7), round(m["longitude"][i] * 1e7))
        yield t, 129026, 52, pack("<BBHHH", 0xFF, 0xFC, round(psi / ANGLE), 600, 0xFFFF)
        yield t, 127488, 7, pack("<BHHbH", 0, 336, 0xFFFF, 127, 0xFFFF)


def can_id(pgn, source):
    return (2 << 26) | (pgn << 8) | source


def stamp(t):
    return f"2026-11-25T12:{int(t) // 60:02d}:{t % 60:06.3f}Z"


FORMS = {
    "candump -l": lambda t, p, s, d: f"({START + t:.6f}) can0 {can_id(p, s):08X}#{d.hex().upper()}",
    "candump": lambda t, p, s, d: f" ({START + t:.6f})  can0  {can_id(p, s):08X}   [8]  {d.hex(' ').upper()}",
    "canboat": lambda t, p, s, d: f"{stamp(t)},2,{p},{s},255,{len(d)},{d.hex(',')}",
    "Yacht Devices": lambda t, p, s, d: f"{stamp(t)[11:23]} R {can_id(p, s):08X} {d.hex(' ').upper()}",
    "Actisense": lambda t, p, s, d: (
        f"A{stamp(t)[11:23].replace(':', '')} {s:02X}FF2 {p:05X} {d.hex().upper()}"
    ),
}


@pytest.mark.parametrize("form", FORMS)
def test_every_form_gives_the_same_series(tmp_path, sailed, form):
    path = tmp_path / "bus.log"
    path.write_text("\n".join(FORMS[form](*f) for f in frames(sailed)) + "\n")
    assert recognised(path).name == "nmea2000"
    series = read(path).series
    t, x = series["127250.52.heading_true"].arrays()
    np.testing.assert_allclose(np.diff(t), 1.0, atol=2e-3)
    np.testing.assert_allclose(x, sailed["psi"], atol=0.006)
    np.testing.assert_allclose(series["127250.25.heading_true"].arrays()[1] - x, np.degrees(0.05), atol=0.01)
    np.testing.assert_allclose(series["127251.52.rate"].arrays()[1], sailed["rate"], atol=1e-4)
    np.testing.assert_allclose(series["127245.13.position"].arrays()[1], sailed["rudder"], atol=0.006)
    np.testing.assert_allclose(series["129025.52.latitude"].arrays()[1], sailed["latitude"], atol=1e-7)
    assert (
        series["127488.7.engine0"].quantity == "engine_rate_rpm"
        and series["127488.7.engine0"].values[0] == 84.0
    )


def test_canboats_json_is_read_in_degrees_and_in_radians(tmp_path, sailed):
    for scale, name in ((1.0, "deg.json"), (np.pi / 180.0, "rad.json")):
        path = tmp_path / name
        rows = [
            {
                "timestamp": stamp(t),
                "pgn": 127250,
                "src": 3,
                "fields": {"Heading": (psi + 200.0) * scale, "Reference": "True"},
            }
            for t, psi in zip(sailed["t"], sailed["psi"], strict=True)
        ]
        rows.append(rows[-1] | {"fields": {"Heading": 10**400}})  # too long to be a number
        path.write_text("\n".join(map(json.dumps, rows)) + "\n")
        kind = recognised(path)
        assert kind.name == "canboat_json"
        np.testing.assert_allclose(
            kind.series(path).series["127250.3.heading_true_north"].arrays()[1],
            sailed["psi"] + 200.0,
            atol=1e-6,
        )


def canboat_log(tmp_path, messages):
    """The series of a file of such messages, each (group, fields), a second apart."""
    rows = [
        {"timestamp": stamp(float(k)), "pgn": pgn, "src": 3, "fields": fields}
        for k, (pgn, fields) in enumerate(messages)
    ]
    path = tmp_path / "log.json"
    path.write_text("\n".join(map(json.dumps, rows)) + "\n")
    return recognised(path).series(path).series


def test_two_rudders_and_two_engines_of_one_source_are_two_series_in_canboats_json(tmp_path):
    starboard = "Dual Engine Starboard"
    series = canboat_log(
        tmp_path,
        [
            (127245, {"Instance": 0, "Position": 5.0}),
            (127245, {"Instance": 1, "Position": -4.0}),
            (127488, {"Instance": "Single Engine or Dual Engine Port", "Speed": 800}),
            (127488, {"Instance": starboard, "Speed": 900}),
            (127488, {"engineInstance": starboard, "engineSpeed": 910}),
            (127250, {"Heading": 200.0, "Reference": "True"}),
        ],
    )
    assert {name: list(s.values) for name, s in series.items() if s.quantity != "heading_true_north_deg"} == {
        "127245.3.rudder_angle": [5.0],
        "127245.3.rudder_angle_1": [-4.0],
        "127488.3.engine_rate": [800.0],
        "127488.3.engine_rate_dual_engine_starboard": [900.0, 910.0],
    }


def test_canboats_json_with_numbers_and_names_of_a_field_is_read_as_with_names_alone(tmp_path):
    """Test: fields as the analyzer writes them with `-nv`. Expected: what they are with their names; the number,
    where a field has no name."""
    series = canboat_log(
        tmp_path,
        [
            (127250, {"Heading": 200.0, "Reference": {"value": 1, "name": "Magnetic"}}),
            (127488, {"Instance": {"value": 0, "name": "Single Engine or Dual Engine Port"}, "Speed": 800}),
            (127488, {"Instance": {"value": 2, "name": None}, "Speed": 900}),
            (130306, {"Wind Speed": 7.0, "Wind Angle": 30.0, "Reference": {"value": 2, "name": "Apparent"}}),
        ],
    )
    assert {name: list(s.values) for name, s in series.items()} == {
        "127250.3.heading_magnetic": [200.0],
        "127488.3.engine_rate": [800.0],
        "127488.3.engine_rate_2": [900.0],
        "130306.3.apparent_wind_speed": [7.0],
        "130306.3.apparent_wind_angle": [30.0],
    }


@pytest.mark.parametrize("scale", [1.0, np.pi / 180.0], ids=["deg", "rad"])
def test_deviation_and_the_depth_of_the_transducer_are_added_in_canboats_json(tmp_path, scale):
    """Test: a heading that passes 360 deg only by its deviation. Expected: nobody takes radians for degrees."""
    series = canboat_log(
        tmp_path,
        [
            (127250, {"Heading": 359.0 * scale, "Deviation": 3.0 * scale, "Reference": "Magnetic"}),
            (127250, {"Heading": 90.0 * scale, "Reference": "Magnetic"}),
            (128267, {"Depth": 10.0, "Offset": 1.5}),
            (128267, {"Depth": 10.0, "Offset": -2.0}),
            (128267, {"Depth": 10.0}),
        ],
    )
    assert list(series["127250.3.heading_magnetic"].values) == pytest.approx([362.0, 90.0])
    assert list(series["128267.3.water_depth"].values) == [11.5, 10.0, 10.0]


def test_the_bytes_of_an_actisense_gateway_are_read(tmp_path, sailed):
    out = bytearray()
    for t, pgn, source, data in frames(sailed):
        body = (
            bytes([0x93, 11 + len(data), 2])
            + pgn.to_bytes(3, "little")
            + bytes([255, source])
            + int(t * 1000).to_bytes(4, "little")
            + bytes([len(data)])
            + data
        )
        body += bytes([-sum(body) & 0xFF])
        out += b"\x10\x02" + body.replace(b"\x10", b"\x10\x10") + b"\x10\x03"
    path = tmp_path / "bus.ebl"
    path.write_bytes(bytes(out))
    assert recognised(path).name == "nmea2000"
    x = read(path).series["127250.52.heading_true"].arrays()[1]
    assert (
        x.size > 100 and np.abs(x - np.interp(np.arange(x.size), np.arange(120), sailed["psi"])).max() < 3.0
    )


def test_a_long_message_is_put_together_and_a_lost_frame_loses_only_its_own():
    message = bytes(range(43))
    parts = [
        bytes([0x20 | k])
        + (bytes([43]) + message[:6] if k == 0 else message[6 + 7 * (k - 1) : 13 + 7 * (k - 1)])
        for k in range(7)
    ]
    whole = FastPackets()
    assert [whole.add(129029, 1, p) for p in parts][-1] == message
    assert all(whole.add(129029, 1, p) is None for i, p in enumerate(parts) if i != 3)
    assert [whole.add(129029, 1, p) for p in parts][-1] == message


def test_what_is_not_available_is_no_measurement(tmp_path, sailed):
    path = tmp_path / "bus.log"
    gone = pack("<BHhhB", 0xFF, 0xFFFF, 0x7FFF, 0x7FFF, 0xFC)
    path.write_text(
        "\n".join(FORMS["candump -l"](*f) for f in [*frames(sailed), (200.0, 127250, 52, gone)]) + "\n"
    )
    assert len(read(path).series["127250.52.heading_true"]) == 120


def test_an_addressed_group_is_told_from_a_broadcast():
    assert of_can_id(0x18EA0E21) == (0xEA00, 0x21) and of_can_id(0x09F112CC) == (127250, 0xCC)


def test_messages_inside_sentences_of_a_gateway():
    """Test: the makers' own samples. Expected: a position off Puerto Vallarta, whose bytes come last first; an
    attitude of source 15; a position in base 64, at the gateway's own second."""
    from base64 import b64encode

    from twin.recording.formats.nmea2000_wrapped import wrapped
    from twin.recording.formats.recorder_stamps import Stamp

    t, pgn, source, data, _ = wrapped("$MXPGN,01F801,2801,C1308AC40C5DE343*19", Stamp())
    assert (t, pgn, source) == (None, 129025, 1)
    assert int.from_bytes(data[:4], "little", signed=True) * 1e-7 == pytest.approx(20.7479619)
    assert int.from_bytes(data[4:], "little", signed=True) * 1e-7 == pytest.approx(-105.3783356)
    t, pgn, source, data, _ = wrapped("1795608000.5 $PCDIN,01F119,00000000,0F,2AAF00D1067414FF*59", Stamp())
    assert (t, pgn, source, data[:3].hex()) == (1795608000.5, 127257, 15, "2aaf00")
    body = b64encode(bytes(range(8))).decode().rstrip("=")
    assert wrapped(f"!PDGY,129025,2,7,255,12.5,{body}", Stamp()) == (12.5, 129025, 7, bytes(range(8)), True)
    assert wrapped("$GPRMC,120000,A", Stamp()) is None

"""Decoding is validation: each bad sample gets its code (faults I1, I2, I15, I16, I20, I26, I27)."""

from math import inf, nan

import pytest

from twin.live.keelson import messages, topics
from twin.live.keelson.decode import Decoder, Result, check, from_row
from twin.live.keelson.schema import keelson_class
from twin.live.signals.channels import BY_NAME, CHANNELS, Channel
from twin.live.signals.chart import Chart
from twin.live.signals.geodesy import datum
from twin.live.signals.readings import WORDS, Quality, Reading, Rejected
from twin.live.signals.sentinels import CODES

NS = 1_750_000_000_500_000_000
HEADING = topics.key("twin", "ship", "heading_true_north_deg", "gyro")
FIX = topics.key("twin", "ship", "location_fix", "gps")


def one(key: str, payload: bytes, decoder: Decoder | None = None) -> Result:
    results = (decoder or Decoder(Chart(datum(57.7, 11.9)))).decode(key, messages.wrap(payload, NS), 7.0)
    return results[0]


def code(key: str, payload: bytes, decoder: Decoder | None = None) -> Quality:
    result = one(key, payload, decoder)
    return result.quality if isinstance(result, Rejected) else Quality.OK


def test_a_good_scalar_becomes_a_reading() -> None:
    assert one(HEADING, messages.encode_float(123.5, NS)) == Reading(
        "heading_true_north_deg", 123.5, 1_750_000_000.5, 7.0, "gyro"
    )


def test_a_good_position_becomes_two_readings() -> None:
    fix = messages.wrap(messages.encode_fix(57.701, 11.9, NS), NS)
    results = Decoder(Chart(datum(57.7, 11.9))).decode(FIX, fix, 7.0)
    assert [r.channel for r in results] == ["north_m", "east_m"]
    assert isinstance(results[0], Reading) and results[0].value == pytest.approx(111.36, abs=0.02)


def test_a_speed_log_in_knots_becomes_metres_per_second() -> None:
    key = topics.key("twin", "ship", "speed_through_water_knots", "log")
    result = one(key, messages.encode_float(10.0, NS))
    assert isinstance(result, Reading)
    assert result.channel == "surge_velocity_through_water_mps"
    assert result.value == pytest.approx(5.1444, abs=1e-4)


def test_keelsons_waves_from_fill_our_wave_direction() -> None:
    key = topics.key("twin", "ship", "wave_true_direction_deg", "radar")
    result = one(key, messages.encode_float(270.0, NS))
    assert isinstance(result, Reading) and result.channel == "wave_direction_deg"


@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_I1_a_number_that_is_not_finite_is_refused(value: float) -> None:
    assert code(HEADING, messages.encode_float(value, NS)) is Quality.NOT_FINITE
    assert code(FIX, messages.encode_fix(57.7, value, NS)) is Quality.NOT_FINITE


SCALARS = [c for c in CHANNELS if c.name not in topics.POSITION]


@pytest.mark.parametrize("channel", SCALARS, ids=lambda c: c.name)
def test_I2_a_value_a_thousand_times_too_large_is_refused(channel: Channel) -> None:
    subject = next(t.subject for t in topics.INPUTS if channel.name in t.channels)
    key = topics.key("twin", "ship", subject, "x")
    good = 0.5 * (channel.low + channel.high) + 1.0 * (channel.high < 1e3)
    assert code(key, messages.encode_float(min(good, channel.high), NS)) is Quality.OK
    assert code(key, messages.encode_float(channel.high * 1000.0 + 1.0, NS)) is Quality.OUT_OF_RANGE


def test_I15_no_time_stamp_or_one_from_1970_is_refused() -> None:
    assert code(HEADING, messages.Float(value=3.0).SerializeToString()) is Quality.NO_TIMESTAMP
    assert code(HEADING, messages.encode_float(3.0, 0)) is Quality.NO_TIMESTAMP
    assert code(HEADING, messages.encode_float(3.0, 5_000_000_000)) is Quality.NO_TIMESTAMP
    assert code(FIX, messages.encode_fix(57.7, 11.9, 1)) is Quality.NO_TIMESTAMP
    assert code(HEADING, b"") is Quality.NO_TIMESTAMP


@pytest.mark.parametrize("raw", [65535, 65534, 65533])
def test_I16_nmea_2000s_not_available_is_no_heading(raw: int) -> None:
    exact = raw * 1e-4 * 57.29577951308232
    for value in (exact, round(exact, 2)):
        assert code(HEADING, messages.encode_float(value, NS)) is Quality.SENTINEL


def test_I16_ais_and_old_loggers_say_not_available_in_many_numbers() -> None:
    assert code(HEADING, messages.encode_float(511.0, NS)) is Quality.SENTINEL
    rudder = topics.key("twin", "ship", "rudder_angle_deg", "x")
    assert code(rudder, messages.encode_float(-999.0, NS)) is Quality.SENTINEL
    for latitude, longitude in ((91.0, 181.0), (0.0, 0.0), (214.7483647, 214.7483647)):
        assert code(FIX, messages.encode_fix(latitude, longitude, NS)) is Quality.SENTINEL


def test_no_code_for_not_available_is_a_value_of_every_day() -> None:
    usual = [0.0, 1.0, 5.0, 10.0, 90.0, 180.0, 359.9, -35.0, 35.0, 187.737]
    for name in CODES:
        for value in usual:
            if BY_NAME[name].low <= value <= BY_NAME[name].high:
                assert check(name, value) is Quality.OK


def test_I20_positions_across_the_antimeridian_are_no_jump_and_the_pole_is_refused() -> None:
    decoder = Decoder(Chart(datum(-17.0, 179.9995)))
    fixes = [messages.wrap(messages.encode_fix(-17.0, lon, NS), NS) for lon in (179.9999, -179.9999)]
    west, east = (decoder.decode(FIX, fix, 7.0)[1] for fix in fixes)
    assert isinstance(west, Reading) and isinstance(east, Reading)
    assert (west.value, east.value) == (pytest.approx(42.6, abs=0.1), pytest.approx(63.9, abs=0.1))
    assert code(FIX, messages.encode_fix(89.9, 10.0, NS), decoder) is Quality.OUTSIDE_AREA
    assert code(FIX, messages.encode_fix(10.0, 10.0, NS), decoder) is Quality.OUTSIDE_AREA


def test_one_wild_first_position_does_not_become_the_datum() -> None:
    decoder = Decoder()
    codes = [code(FIX, messages.encode_fix(lat, 11.9, NS), decoder) for lat in (12.0, 57.7, 57.7001)]
    assert codes == [Quality.UNCONFIRMED, Quality.UNCONFIRMED, Quality.OK]
    assert decoder.chart is not None and decoder.chart.at.latitude_deg == 57.7


def test_a_position_far_away_is_believed_once_none_nearer_has_come_for_an_hour() -> None:
    """Expected: refused up to an hour after the last near one, then, like the first of all, with the second of its
    kind; 5 degrees of latitude are 557 km; from then on what was near is far."""
    decoder = Decoder(Chart(datum(57.0, 11.9)))

    def at(latitude: float, received_s: float) -> float | Quality:
        fix = messages.wrap(messages.encode_fix(latitude, 11.9, NS), NS)
        (north, _) = decoder.decode(FIX, fix, received_s)
        return north.quality if isinstance(north, Rejected) else round(north.value, -3)

    far, first = Quality.OUTSIDE_AREA, Quality.UNCONFIRMED
    assert [at(57.0, 0.0), at(62.0, 1.0), at(57.0, 10.0), at(62.0, 3610.0)] == [0.0, far, 0.0, far]
    assert [at(62.0, 3611.0), at(62.0, 3612.0)] == [first, 557e3]
    assert [at(57.0, 3613.0), at(62.001, 3614.0)] == [far, 557e3]


def wrong_types() -> list[bytes]:
    """What other subjects' publishers send."""
    samples = []
    for name, value in (
        ("Double", 12.5),
        ("Int", 12),
        ("String", "12.5"),
        ("Bool", True),
        ("Bytes", b"12"),
    ):
        message = keelson_class(f"keelson.Timestamped{name}")(value=value)
        messages.stamp(message.timestamp, NS)
        samples.append(message.SerializeToString())
    period = keelson_class("keelson.TimestampedFloatPeriod")(value=12.5)
    period.period.seconds = 600
    messages.stamp(period.timestamp, NS)
    return [*samples, period.SerializeToString(), messages.encode_vector(1.0, 2.0, 3.0, NS)]


@pytest.mark.parametrize("payload", wrong_types())
def test_I26_another_message_type_on_a_scalars_key_is_refused(payload: bytes) -> None:
    assert code(HEADING, payload) is Quality.WRONG_TYPE


def test_I26_a_scalar_and_a_position_on_each_others_keys_are_refused() -> None:
    assert code(FIX, messages.encode_float(12.5, NS)) is Quality.WRONG_TYPE
    assert code(HEADING, messages.encode_fix(57.7, 11.9, NS)) in (Quality.WRONG_TYPE, Quality.GARBAGE)


GARBAGE = [b"\xff" * 40, b"{" * 4000, bytes(10_000_000), b"\x0a\xff\xff\xff\xff\x0f", b"text"]


@pytest.mark.parametrize("data", GARBAGE, ids=lambda data: str(len(data)))
def test_I27_garbage_has_a_code_and_no_reading(data: bytes) -> None:
    for key in (HEADING, FIX):
        for result in Decoder().decode(key, data, 7.0):
            assert isinstance(result, Rejected)


def test_a_key_the_table_does_not_have_is_said_to_be_unknown() -> None:
    for key in ("x/y", topics.key("twin", "ship", "battery_voltage_v", "x"), "../../etc/passwd"):
        (result,) = Decoder().decode(key, messages.wrap(messages.encode_float(1.0, NS), NS), 7.0)
        assert isinstance(result, Rejected) and result.quality is Quality.UNKNOWN_KEY


def test_the_twin_does_not_listen_to_itself() -> None:
    key = topics.key("twin", "ship", "heading_true_north_deg", "twin/estimate")
    assert Decoder().decode(key, messages.wrap(messages.encode_float(1.0, NS), NS), 7.0) == []


def test_a_million_keys_do_not_fill_the_memory() -> None:
    decoder = Decoder()
    for i in range(2000):
        decoder.decode(f"twin/@v0/ship/pubsub/s{i}/x", b"", 0.0)
    assert len(decoder._keys) <= 512


def test_a_logged_message_without_its_envelope_reads_the_same() -> None:
    payload = messages.encode_float(123.5, NS)
    assert Decoder().decode_stripped(HEADING, payload, 7.0) == [one(HEADING, payload)]


def test_a_row_goes_through_the_same_gate() -> None:
    row = messages.Row(time_s=5.0)
    messages.fill(row, {"heading_true_north_deg": 511.0, "rudder_angle_deg": -5.0, "roll_deg": nan})
    results = {r.channel: r for r in from_row(row, 5.0, 5.0, "import")}
    assert results["rudder_angle_deg"] == Reading("rudder_angle_deg", -5.0, 5.0, 5.0, "import")
    refused = {name: r.quality for name, r in results.items() if isinstance(r, Rejected)}
    assert refused == {"heading_true_north_deg": Quality.SENTINEL, "roll_deg": Quality.NOT_FINITE}


def test_every_code_has_its_words() -> None:
    assert set(WORDS) == set(Quality) and all(WORDS.values())
    assert all(BY_NAME[name] for name in CODES)

"""A log as columns: wide rows, ticks, and the scalars of a foreign log."""

from pathlib import Path
from time import process_time

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from twin.errors import DataError
from twin.live.keelson import messages, proto_file, topics
from twin.live.log.record import LogFile, read_rows

START = 1_750_000_000
ROW_TOPIC = "twin/@v0/ship/pubsub/voyage_row/import"
TICK_TOPIC = "twin/@v0/ship/pubsub/twin_tick/twin"


def scalar(log: LogFile, subject: str, value: float, ns: int) -> None:
    log.add(topics.key("twin", "ship", subject, "x"), topics.FLOAT, messages.encode_float(value, ns), ns)


def other_tick(fields: list[tuple[str, str]]) -> bytes:
    """The schema of a message that is called Tick and is another."""
    tick = proto_file.message("Tick", fields, "shiptwin")
    return proto_file.set_of([proto_file.file("x.proto", "shiptwin", (), [tick])])


def test_rows_come_back_exactly_and_what_is_absent_is_nan(tmp_path: Path) -> None:
    with LogFile(tmp_path / "a.mcap") as log:
        for i in range(100):
            row = messages.Row(time_s=i * 0.1)
            messages.fill(row, {"north_m": i * 1.5, "heading_true_north_deg": 0.0})
            if i % 3 == 0:
                messages.fill(row, {"rudder_angle_deg": -float(i)})
            log.add(ROW_TOPIC, "shiptwin.Row", row.SerializeToString(), i)
    time_s, columns = read_rows(tmp_path / "a.mcap")
    assert time_s.tolist() == [i * 0.1 for i in range(100)]
    assert columns["north_m"].tolist() == [i * 1.5 for i in range(100)]
    assert not columns["heading_true_north_deg"].any()
    assert np.flatnonzero(np.isfinite(columns["rudder_angle_deg"])).tolist() == list(range(0, 100, 3))
    assert set(columns) == {"north_m", "heading_true_north_deg", "rudder_angle_deg"}


def test_an_hour_at_10_hz_is_read_within_a_second(tmp_path: Path) -> None:
    names = [field.name for field in messages.Row.DESCRIPTOR.fields][1:21]
    with LogFile(tmp_path / "a.mcap") as log:
        for i in range(36_000):
            row = messages.Row(time_s=i * 0.1, **dict.fromkeys(names, i * 0.37))
            log.add(ROW_TOPIC, "shiptwin.Row", row.SerializeToString(), i)
    began = process_time()
    time_s, columns = read_rows(tmp_path / "a.mcap")
    assert time_s.size == 36_000 and len(columns) == 20
    assert process_time() - began < 1.0


def test_a_held_value_in_ticks_is_one_sample_at_its_own_stamp(tmp_path: Path) -> None:
    """A 1 Hz receiver in a 10 Hz log: a line through the fixes, 0.2 s late, and no staircase."""
    with LogFile(tmp_path / "a.mcap") as log:
        for i in range(101):
            now = 50.0 + i * 0.1
            sampled = np.floor(now - 0.2 + 1e-9)
            tick = messages.Tick(time_s=now, wall_s=START + now)
            messages.fill(tick.measured, {"north_m": 5.0 * sampled, "draught_mean_m": 9.0})
            messages.fill(tick.age_s, {"north_m": now - sampled, "draught_mean_m": now})
            log.add(TICK_TOPIC, "shiptwin.Tick", tick.SerializeToString(), i)
    time_s, columns = read_rows(tmp_path / "a.mcap")
    assert time_s[0] == pytest.approx(START + 50.0)
    good = np.isfinite(columns["north_m"])
    assert good.sum() > 85
    truth = 5.0 * (time_s - START)
    assert np.abs(columns["north_m"] - truth)[good].max() < 1e-3
    assert (columns["draught_mean_m"] == 9.0).all()


def test_a_foreign_log_of_keelson_scalars_is_put_on_one_base(tmp_path: Path) -> None:
    with LogFile(tmp_path / "a.mcap") as log:
        for i in range(200):
            ns = START * 10**9 + i * 100_000_000
            fix = messages.encode_fix(57.7 + i * 1e-5, 11.9, ns)
            log.add(topics.key("twin", "ship", "location_fix", "gps"), topics.FIX, fix, ns)
            if i % 2 == 0:
                scalar(log, "heading_true_north_deg", (350.0 + i * 0.1) % 360.0, ns)
            if i % 50 == 0:
                scalar(log, "wave_height_significant_m", 2.0, ns)
            if not 60 < i < 140:
                scalar(log, "rudder_angle_deg", 5.0, ns)
    notes: list[str] = []
    time_s, columns = read_rows(tmp_path / "a.mcap", notes)
    assert time_s.size == 199 and np.allclose(np.diff(time_s), 0.1)
    assert columns["north_m"][0] == pytest.approx(1.114, abs=0.01)
    assert any("UNCONFIRMED" not in note and "north_m" in note for note in notes)
    heading = columns["heading_true_north_deg"]
    expected = (350.0 + np.arange(1, 200) * 0.1) % 360.0
    assert np.nanmax(np.abs((heading - expected + 180.0) % 360.0 - 180.0)) < 0.01
    rudder = columns["rudder_angle_deg"]
    assert np.isnan(rudder[70:130]).all() and (rudder[:60] == 5.0).all()
    assert (columns["wave_height_significant_m"] == 2.0).all()


def test_positions_of_a_foreign_log_may_lead_as_far_as_they_like(tmp_path: Path) -> None:
    """Test: 5 degrees of latitude, and a second receiver far away. Expected: the length of the meridian by hand."""
    with LogFile(tmp_path / "a.mcap") as log:
        for i in range(5001):
            ns = START * 10**9 + i * 1_000_000_000
            for source, latitude in (("gps", 57.0 + i * 1e-3), ("other", 57.5)):
                if source == "gps" or i > 10:
                    fix = messages.encode_fix(latitude, 11.9, ns)
                    log.add(topics.key("twin", "ship", "location_fix", source), topics.FIX, fix, ns)
            scalar(log, "heading_true_north_deg", 0.0, ns)
    _, columns = read_rows(tmp_path / "a.mcap")
    north = columns["north_m"][np.isfinite(columns["north_m"])]
    assert north.size > 4990
    assert north[-1] - north[0] == pytest.approx(556.9e3, rel=2e-3)


def test_a_log_without_measurements_is_one_clear_line(tmp_path: Path) -> None:
    with LogFile(tmp_path / "a.mcap") as log:
        log.add("a/b", "keelson.TimestampedString", messages.encode_string("x", 1), 1)
    with pytest.raises(DataError, match="no measurements in it"):
        read_rows(tmp_path / "a.mcap")


def test_a_row_that_is_not_one_is_left_out_and_said(tmp_path: Path) -> None:
    with LogFile(tmp_path / "a.mcap") as log:
        for i in range(4):
            row = messages.Row(time_s=float(i), north_m=1.0).SerializeToString()
            log.add(ROW_TOPIC, "shiptwin.Row", b"\x0d\x01" if i == 2 else row, i)
    notes: list[str] = []
    time_s, columns = read_rows(tmp_path / "a.mcap", notes)
    assert time_s.tolist() == [0.0, 1.0, 3.0] and columns["north_m"].tolist() == [1.0, 1.0, 1.0]
    assert notes == ["1 left out: shiptwin.Row that cannot be decoded"]


def test_a_log_cut_short_gives_its_whole_chunks_and_says_so(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with LogFile(path) as log:
        for i in range(20_000):
            row = messages.Row(time_s=float(i), north_m=float(i))
            log.add(ROW_TOPIC, "shiptwin.Row", row.SerializeToString(), i)
    path.write_bytes(path.read_bytes()[:-80_000])
    notes: list[str] = []
    time_s, _ = read_rows(path, notes)
    assert 1000 < time_s.size < 20_000 and time_s.tolist() == list(range(time_s.size))
    assert len(notes) == 1 and "breaks off" in notes[0]


@pytest.mark.parametrize(
    "type_name, schema",
    (
        ("shiptwin.Row", b"\x0a\x05\x22\x03\x0a\x01\x8c"),  # a name that is no UTF-8
        ("shiptwin.Row", b"\x0a\x02\x22\x00"),  # a message without a name
        ("shiptwin.Row", b"\x08"),  # cut off
        ("shiptwin.Row", b""),
        ("shiptwin.Tick", other_tick([("time_s", "double"), ("wall_s", "double")])),
        (
            "shiptwin.Tick",
            other_tick([(name, "string") for name in ("time_s", "wall_s", "measured", "age_s")]),
        ),
    ),
)
def test_a_log_whose_own_schema_is_none_or_another_is_one_clear_line(tmp_path, type_name, schema):
    """Found by the fuzzer: a UnicodeDecodeError of a log's own schema."""
    writer = Writer(str(tmp_path / "odd.mcap"), compression=CompressionType.NONE)
    writer.start()
    kind = writer.register_schema(type_name, "protobuf", schema)
    channel = writer.register_channel(ROW_TOPIC, "protobuf", kind)
    writer.add_message(channel, 10**9, messages.Row(time_s=1.0).SerializeToString(), 10**9)
    writer.finish()
    with pytest.raises(DataError, match=f"its schema of {type_name} cannot be read"):
        read_rows(tmp_path / "odd.mcap")

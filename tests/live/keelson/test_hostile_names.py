"""A sender that takes a new name for every message: the others are heard, the log goes on, memory and names
are bounded."""

import subprocess
import sys
from time import monotonic, sleep, time_ns

import pytest

from twin.live.clock import Instant
from twin.live.inbox import Inbox
from twin.live.keelson import messages
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.seats import MAX_SOURCES, SILENT_S, Seats
from twin.live.keelson.topics import key
from twin.live.log.record import MAX_CHANNELS, Recorder, read

SCALAR = "keelson.TimestampedFloat"


def named(source, subject="heading_true_north_deg"):
    return key("twin", "ship", subject, source)


def sample(value=12.0):
    return messages.wrap(messages.encode_float(value, time_ns()), time_ns())


def test_of_65535_invented_names_a_few_are_heard_and_logged_and_the_true_one_is():
    """Test: a compass, then 65 535 names in 25 s. Expected: never more than MAX_SOURCES keys in the log, the compass
    in every tick."""
    bus, logged = MemoryBus(), set()
    inbox = Inbox(bus, lambda topic, *_: logged.add(topic))
    invented, true_ones = iter(range(65_535)), 0
    for tick in range(250):
        bus.put(named("gyro"), sample())
        for _, number in zip(range(265), invented, strict=False):
            bus.put(named(f"invented-{number}"), sample(99.0))
        now_s = 100.0 + 0.1 * tick
        true_ones += any(r.source == "gyro" for r in inbox.read(Instant(tick, now_s, 1.7e9 + now_s)))
    assert true_ones == 250 and named("gyro") in logged and len(logged) == MAX_SOURCES
    assert inbox.seats.refused == 65_535 - (MAX_SOURCES - 1)
    alarm = inbox.seats.alarm(now_s)
    assert "heading_true_north_deg" in alarm and "invented-" in alarm and "[sources]" in alarm
    assert inbox.seats.alarm(now_s + 60.0) == ""


def test_a_name_that_falls_silent_gives_its_seat_up_and_the_named_source_always_has_one():
    seats = Seats({"heading_true_north_deg": "gyro"})
    assert all(seats.taken(named(f"x{i}"), 0.0) for i in range(MAX_SOURCES))
    assert not seats.taken(named("late"), 1.0)
    assert seats.taken(named("gyro"), 1.0) and seats.taken(named("rudder", "rudder_angle_deg"), 1.0)
    assert seats.taken(named("late"), SILENT_S + 2.0)


def test_a_key_without_end_is_not_heard():
    seats = Seats()
    assert not seats.taken(named("x" * 60_000), 0.0) and len(seats.alarm(0.0)) < 300


@pytest.mark.parametrize("batch", [1, 1000])
def test_a_log_with_more_topics_than_a_file_can_hold_goes_on_in_the_next(tmp_path, batch):
    """Test: more topics than one file takes. Expected: no alarm, every message in some file."""
    total = 2 * MAX_CHANNELS + 100
    with Recorder(tmp_path) as recorder:
        for i in range(total):
            recorder.write(named(f"n{i}"), SCALAR, b"", i)
            if i % batch == 0:
                sleep(0.00001)
            while i - recorder.state.written > 2000:
                sleep(0.01)
        end = monotonic() + 20.0
        while recorder.state.written < total and monotonic() < end:
            sleep(0.05)
        assert recorder.state.alarm == ""
    files = sorted(tmp_path.glob("*.mcap"))
    assert len(files) == 3 and sum(1 for file in files for _ in read(file)) == total


BOMB = """
import sys
from struct import pack
from zlib import crc32
import zstandard
from twin.live.log.mcap_index import *
message = record(MESSAGE, pack("<HIQQ", 1, 0, 0, 0))
raw = record(SCHEMA, pack("<H", 1), text("x"), text("protobuf"), pack("<I", 0))
raw += record(CHANNEL, pack("<HH", 1, 1), text("t"), text("protobuf"), text_map({}))
raw += message * int(sys.argv[2])
data = zstandard.ZstdCompressor(level=19).compress(raw)
head = pack("<QQQI", 0, 0, len(raw), crc32(raw)) + text("zstd")
with open(sys.argv[1], "wb") as file:
    file.write(MAGIC + record(HEADER, text(""), text("shiptwin")) + record(CHUNK, head, pack("<Q", len(data)), data))
"""
PEAK = """
import sys
def peak():  # [kB] of this process alone: ru_maxrss begins at its parent's
    return int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0])
"""
RECOVERED = """
from twin.live.log.recover import recover_folder
before = peak()
print(*recover_folder(sys.argv[1]))
print(peak() - before)
"""
READ = """
from twin.errors import DataError
from twin.live.log.mcap_read import McapReader
before, reader = peak(), McapReader(sys.argv[1])
try:
    print(sum(1 for _ in reader.messages()))
except DataError as error:
    print(error)
print(peak() - before)
"""


def run(script, *words):
    return subprocess.run(
        [sys.executable, "-c", PEAK + script, *map(str, words)],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    ).stdout


def test_Q6_a_small_file_in_the_log_folder_that_unpacks_to_millions_of_messages_costs_no_memory(tmp_path):
    """Test: a few kB named like a log, one chunk of millions of empty messages. Expected: left as it is and
    named, under 20 MB."""
    path = tmp_path / "twin-000001-20261125T000000Z.mcap"
    run(BOMB, path, 3_000_000)
    before = path.read_bytes()
    assert len(before) < 50_000
    said, kilobytes = run(RECOVERED, tmp_path).splitlines()
    assert path.name in said and "left as it is" in said
    assert int(kilobytes) < 20_000 and path.read_bytes() == before


@pytest.mark.parametrize("count, answer", [(1_500_000, "1500000"), (4_000_000, "nothing in it can be read")])
def test_Q6_such_a_file_is_read_ashore_in_bounded_memory(tmp_path, count, answer):
    run(BOMB, tmp_path / "bomb.mcap", count)
    said, kilobytes = run(READ, tmp_path / "bomb.mcap").splitlines()
    assert answer in said and int(kilobytes) < 250_000


def test_Q6_an_unfinished_log_of_another_recorder_is_not_cut(tmp_path):
    """Test: one chunk of 2 MB, which no twin writes. Expected: byte for byte as it was."""
    path = tmp_path / "twin-000001-20261125T000000Z.mcap"
    run(BOMB, path, 70_000)
    before = path.read_bytes()
    assert "no log of the twin's" in run(RECOVERED, tmp_path) and path.read_bytes() == before

"""What a crash leaves behind is finished at the next start: kill -9 (C6), torn and garbled tails (S5)."""

import os
import random
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import sleep

import pytest
from mcap.reader import make_reader

from twin.live.keelson import messages
from twin.live.log.mcap_read import McapReader
from twin.live.log.mcap_write import McapWriter
from twin.live.log.record import Recorder, read
from twin.live.log.recover import recover, recover_folder

TOPIC = "twin/@v0/ship/pubsub/heading_true_north_deg/gyro"
KILLS = 20
WRITER = """
import os, sys, time
from twin.live.keelson import messages
from twin.live.log.record import Recorder
with Recorder(sys.argv[1]) as recorder:
    for i in range(100000):
        now, tick = time.monotonic_ns(), messages.Tick(index=i).SerializeToString()
        recorder.write("a/@v0/b/pubsub/twin_tick/twin", "shiptwin.Tick", tick, now)
        os.write(1, b"%d %d\\n" % (i, now))
        time.sleep(0.01)
"""


def whole_log(parts: int = 5) -> bytes:
    """Fifty messages in five chunks."""
    data: list[bytes] = []
    writer = McapWriter(data.append)
    writer.start()
    channel = writer.channel(TOPIC, "keelson.TimestampedFloat", messages.schema_bytes)
    for i in range(parts * 10):
        writer.add(channel, messages.encode_float(float(i), i), i, i)
        if i % 10 == 9:
            writer.flush()
    writer.metadata("voyage", {"ship": "x"})
    writer.finish()
    return b"".join(data)


def is_whole(path: Path) -> int:
    """How many messages the mcap library finds, by the index and with every checksum."""
    with open(path, "rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None and summary.statistics is not None
        count = sum(1 for _ in reader.iter_messages())
        assert summary.statistics.message_count == count
        return count


def test_a_whole_log_is_left_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(whole_log())
    assert recover(path) == ""
    assert path.read_bytes() == whole_log()


def test_S5_a_log_cut_anywhere_is_finished_and_the_loss_is_said(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    good = whole_log()
    rng = random.Random(5)
    for cut in sorted(rng.sample(range(1, len(good)), 120)):
        path.write_bytes(good[:cut])
        said = recover(path)
        assert said
        if not path.exists():
            assert "renamed" in said
            path.with_suffix(".unreadable").unlink()
            continue
        count = is_whole(path)
        assert f"{count} messages kept" in said and count % 10 == 0
        assert recover(path) == ""


@pytest.mark.parametrize("tail", [bytes(3000), b"\xff" * 3000, random.Random(1).randbytes(3000)])
def test_S5_a_garbled_tail_costs_only_itself(tmp_path: Path, tail: bytes) -> None:
    path = tmp_path / "a.mcap"
    good = whole_log()
    end = good.rindex(b"\x0f\x04\x00\x00\x00\x00\x00\x00\x00")  # DataEnd
    path.write_bytes(good[:end] + tail)
    assert "50 messages kept, 3000 bytes at the end lost" in recover(path)
    assert is_whole(path) == 50


def test_a_repaired_log_is_the_log_that_was_never_cut(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    good = whole_log()
    path.write_bytes(good[:-100])
    recover(path)
    assert path.read_bytes() == good


def test_a_chunk_whose_index_was_cut_off_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    good = whole_log(1)
    end = good.rindex(b"\x0f\x04\x00\x00\x00\x00\x00\x00\x00")
    index = good.index(b"\x07", 0)
    for cut in range(end - 200, end):
        path.write_bytes(good[:cut])
        recover(path)
        if path.exists() and is_whole(path):
            assert [m.log_ns for m in read(path)] == list(range(10))
    assert index < end


def test_a_file_without_one_record_is_set_aside_and_never_deleted(tmp_path: Path) -> None:
    (tmp_path / "twin-000001-x.mcap").write_bytes(b"")
    (tmp_path / "twin-000002-x.mcap").write_bytes(b"no log at all")
    said = recover_folder(tmp_path)
    assert len(said) == 2 and all("renamed" in sentence for sentence in said)
    assert (tmp_path / "twin-000002-x.unreadable").read_bytes() == b"no log at all"


@pytest.mark.parametrize(
    "name", ["monday.mcap", "twin-monday.mcap", "twins-000001-x.mcap", "bow-000001-x.mcap"]
)
def test_a_voyage_that_is_being_copied_into_the_log_folder_is_left_as_it_is(
    tmp_path: Path, name: str
) -> None:
    """Test: half a voyage under a name that this log gives none of its files. Expected: byte for byte as it was."""
    (tmp_path / name).write_bytes(whole_log()[:-500])
    with Recorder(tmp_path) as recorder:
        assert recorder.repaired == []
    assert (tmp_path / name).read_bytes() == whole_log()[:-500]


def test_a_recorder_repairs_the_logs_of_its_own_name(tmp_path: Path) -> None:
    (tmp_path / "bow-000001-x.mcap").write_bytes(whole_log()[:-50])
    with Recorder(tmp_path, "bow") as recorder:
        assert len(recorder.repaired) == 1


def test_a_log_that_somebody_is_writing_is_left_alone(tmp_path: Path) -> None:
    with Recorder(tmp_path) as recorder:
        recorder.write(TOPIC, "keelson.TimestampedFloat", messages.encode_float(1.0, 1), 1)
        while not recorder.state.written:
            sleep(0.02)
        assert recover_folder(tmp_path) == []
        path = Path(recorder.state.path)
    assert is_whole(path) == 1


def test_the_recorder_repairs_at_its_start_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "twin-000001-x.mcap").write_bytes(whole_log()[:-50])
    with Recorder(tmp_path) as recorder:
        assert len(recorder.repaired) == 1 and "50 messages kept" in recorder.repaired[0]
    assert is_whole(tmp_path / "twin-000001-x.mcap") == 50


def killed(folder: Path, after_s: float) -> list[list[bytes]]:
    """Kills a recorder `after_s` after its first message; what it had queued: [number, time]."""
    process = subprocess.Popen([sys.executable, "-c", WRITER, str(folder)], stdout=subprocess.PIPE)
    assert process.stdout is not None
    first = process.stdout.readline()
    sleep(after_s)
    os.kill(process.pid, signal.SIGKILL)
    lines = [first, *process.stdout.read().splitlines(keepends=True)]
    process.wait()
    return [line.split() for line in lines if line.endswith(b"\n")]


def test_C6_kill_9_at_any_instant_loses_half_a_second_at_most(tmp_path: Path) -> None:
    """Test: 20 recorders killed at random instants. Expected: each file readable, at most 0.5 s missing."""
    rng = random.Random(9)
    folders = [tmp_path / str(i) for i in range(KILLS)]
    with ThreadPoolExecutor(4) as pool:
        queues = pool.map(killed, folders, [rng.uniform(0.3, 1.3) for _ in folders])
    for folder, queued in zip(folders, queues, strict=True):
        assert len(recover_folder(folder)) == 1
        files = list(folder.glob("*.mcap"))
        kept = [m.log_ns for m in read(files[0])] if files else []
        assert sum(map(is_whole, files)) == len(kept)
        assert kept == [int(at) for _, at in queued[: len(kept)]]
        last = kept[-1] if kept else int(queued[0][1])
        assert (int(queued[-1][1]) - last) * 1e-9 <= 0.5


@pytest.mark.parametrize("start", (1, 10**6, 2**63, 2**64 - 1))
def test_an_end_that_points_outside_of_the_file_costs_no_message(tmp_path, start):
    """Test: the last record says that the index begins where there is none; 2^63 is more than a file can be
    long (found by the fuzzer). Expected: all fifty messages."""
    data, path = whole_log(), tmp_path / "l.mcap"
    path.write_bytes(data[:-28] + start.to_bytes(8, "little") + data[-20:])
    assert len(list(McapReader(path).messages())) == 50

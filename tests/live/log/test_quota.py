"""The log's share of the disk: the oldest own files go, the one being written and other people's files stay,
and it is said."""

import os
import subprocess
import time
from pathlib import Path

import pytest

from twin.live.log.quota import DAY_S, Quota, own_files, trim
from twin.live.log.record import Recorder

TOPIC = "twin/@v0/ship/pubsub/heading_true_north_deg/gyro"
SCALAR = "keelson.TimestampedFloat"


def file(folder, number, kilobytes=100, days=0.0):
    path = folder / f"twin-{number:06d}-20261125T000000Z.mcap"
    path.write_bytes(bytes(1000 * kilobytes))
    then = time.time() - days * DAY_S
    os.utime(path, (then, then))
    return path


def left(folder):
    return [f.number for f in own_files(folder, "twin")]


def test_the_oldest_go_until_all_together_fit(tmp_path):
    for number in range(1, 11):
        file(tmp_path, number)
    said = trim(tmp_path, "twin", Quota(max_mb=0.55))
    assert left(tmp_path) == [6, 7, 8, 9, 10]
    assert (
        "5 oldest files" in said
        and "twin-000001" in said
        and "twin-000005" in said
        and "log.max_mb = 0.55" in said
    )
    assert trim(tmp_path, "twin", Quota(max_mb=0.55)) == ""


def test_files_older_than_the_newest_by_more_than_the_days_go(tmp_path):
    for number in range(1, 11):
        file(tmp_path, number, days=10.0 - number)
    assert "log.keep_days = 3.5" in trim(tmp_path, "twin", Quota(keep_days=3.5))
    assert left(tmp_path) == [7, 8, 9, 10]


def test_a_clock_that_is_years_ahead_deletes_nothing(tmp_path, monkeypatch):
    for number in range(1, 5):
        file(tmp_path, number)
    monkeypatch.setattr(time, "time", lambda: 4e9)
    assert trim(tmp_path, "twin", Quota(keep_days=1.0)) == "" and len(left(tmp_path)) == 4


def test_what_is_written_and_what_is_not_ours_stays(tmp_path):
    """Test: no megabyte is allowed. Expected: other names, a folder, a link and a file that a recorder writes
    are still there."""
    mine = file(tmp_path, 1)
    for name in ("voyage.mcap", "twin-notes.txt", "other-000001-x.mcap"):
        (tmp_path / name).write_bytes(bytes(5000))
    (tmp_path / "twin-000009-x.mcap").mkdir()
    (tmp_path / "twin-000010-x.mcap").symlink_to(tmp_path / "voyage.mcap")
    with Recorder(tmp_path) as recorder:
        recorder.write(TOPIC, SCALAR, b"", 1)
        while not recorder.state.path or not recorder.state.written:
            time.sleep(0.02)
        writing = Path(recorder.state.path)
        trim(tmp_path, "twin", Quota(max_mb=1e-6))
        assert writing.exists() and not mine.exists() and len(list(tmp_path.iterdir())) == 6


def test_the_recorder_deletes_its_oldest_files_while_it_writes_and_says_so(tmp_path, monkeypatch):
    """Test: files of 100 kB, one megabyte in all. Expected: never much more, the newest kept, the alarm names
    the setting."""
    monkeypatch.setattr("twin.live.log.record.TRIM_S", 0.0)
    most, said = 0, set()
    with Recorder(tmp_path, max_bytes=100_000, quota=Quota(max_mb=1.0)) as recorder:
        for i in range(20):
            recorder.write(TOPIC, SCALAR, os.urandom(100_000), i)
            before = recorder.state.written
            while recorder.state.written == before:
                time.sleep(0.005)
            most = max(most, sum(f.stat().st_size for f in tmp_path.iterdir()))
            said.add(recorder.state.alarm)
            assert recorder.state.ok
    assert most < 1.35e6
    assert any("log.max_mb = 1" in alarm for alarm in said)
    assert left(tmp_path)[-1] >= 20 and len(left(tmp_path)) <= 10


@pytest.mark.skipif(os.geteuid() != 0, reason="mounting needs root")
def test_what_must_stay_free_stays_free_and_the_log_stops_only_when_nothing_is_left_to_delete(tmp_path):
    """Test: a disk of 4 MB, 2 to stay free. Expected: old files make room; then ballast: the log stops, says
    why, and resumes without it."""
    if subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=4m", "none", str(tmp_path)], capture_output=True
    ).returncode:
        pytest.skip("this machine lets nobody mount")
    try:
        for number in range(1, 4):
            file(tmp_path, number, 900)
        with Recorder(tmp_path, quota=Quota(free_mb=2.0)) as recorder:
            assert until(recorder, lambda s: s.written > 0 and s.ok)
            assert (
                "log.free_mb = 2" in recorder.state.alarm
                and left(tmp_path)[0] == 2
                and os.statvfs(tmp_path).f_bavail * 4096 > 2e6
            )
            (tmp_path / "ballast").write_bytes(bytes(2_300_000))
            recorder._trim_at = 0.0
            assert until(recorder, lambda s: not s.ok)
            assert "log.free_mb keeps 2" in recorder.state.alarm
            (tmp_path / "ballast").unlink()
            assert until(recorder, lambda s: s.ok)
    finally:
        subprocess.run(["umount", str(tmp_path)], check=False)


def until(recorder, true, seconds=10.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        recorder.write(TOPIC, SCALAR, b"", 1)
        if true(recorder.state):
            return True
        time.sleep(0.05)
    return False

"""Disks that are full, read-only, slow or gone: the log stops and comes back, the twin goes on (S1-S3)."""

import os
import resource
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, sleep

import pytest

from twin.live.keelson import messages
from twin.live.log.record import QUEUE, Recorder, read

TOPIC = "twin/@v0/ship/pubsub/heading_true_north_deg/gyro"


def until(true, seconds: float = 5.0) -> None:
    end = monotonic() + seconds
    while not true():
        assert monotonic() < end, "it did not happen in time"
        sleep(0.02)


def feed(recorder: Recorder, payload: bytes = b"") -> bool:
    recorder.write(TOPIC, "keelson.TimestampedFloat", payload or messages.encode_float(1.0, 1), 1)
    return False


@contextmanager
def no_file_beyond(size: int) -> Iterator[None]:
    """The kernel cuts every write at `size` bytes of a file, as a full disk does."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_S1_a_full_disk_stops_the_log_and_not_the_twin(tmp_path: Path) -> None:
    """Test: writes fail from 600 kB on. Expected: alarm within 5 s, no wait, whole file, and it resumes."""
    with Recorder(tmp_path) as recorder:
        with no_file_beyond(600_000):
            slowest = 0.0
            end = monotonic() + 5.0
            while recorder.state.ok:
                assert monotonic() < end
                began = monotonic()
                feed(recorder, os.urandom(2000))
                slowest = max(slowest, monotonic() - began)
                sleep(0.002)
            assert slowest < 0.1
            alarm = recorder.state.alarm
            assert "log stopped" in alarm and str(tmp_path) in alarm and "resumes by itself" in alarm
            kept = recorder.state.written
            path = Path(recorder.state.path)
            assert kept > 0 and len(list(read(path))) == kept
            until(lambda: recorder.state.lost > 0)
        until(lambda: feed(recorder) or (recorder.state.ok and recorder.state.written > kept), 5.0)
    state = recorder.state
    assert len(list(read(path))) == state.written


@pytest.mark.skipif(os.geteuid() != 0, reason="mounting needs root")
def test_S1_a_full_tmpfs(tmp_path: Path) -> None:
    mount = ["mount", "-t", "tmpfs", "-o", "size=256k", "none", str(tmp_path)]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("this machine lets nobody mount")
    try:
        ballast = tmp_path / "ballast"
        ballast.write_bytes(bytes(150_000))
        with Recorder(tmp_path) as recorder:
            until(lambda: feed(recorder, os.urandom(2000)) or not recorder.state.ok)
            assert "No space left" in recorder.state.alarm
            ballast.unlink()
            until(lambda: feed(recorder) or recorder.state.ok)
        files = [file for file in tmp_path.iterdir() if file.suffix == ".mcap"]
        assert sum(len(list(read(file))) for file in files) == recorder.state.written
    finally:
        subprocess.run(["umount", str(tmp_path)], check=False)


def test_S2_a_folder_that_cannot_be_written_is_no_reason_not_to_start(tmp_path: Path) -> None:
    """Test: a file lies where the folder should be. Expected: starts, alarm, resumes when it is gone."""
    folder = tmp_path / "logs"
    folder.write_text("in the way")
    with Recorder(folder) as recorder:
        until(lambda: feed(recorder) or not recorder.state.ok)
        assert "log stopped" in recorder.state.alarm
        folder.unlink()
        until(lambda: feed(recorder) or recorder.state.written > 0)
        assert recorder.state.ok


@pytest.mark.skipif(os.geteuid() != 0, reason="mounting needs root")
def test_S2_a_disk_that_turns_read_only(tmp_path: Path) -> None:
    mount = ["mount", "-t", "tmpfs", "-o", "size=8m", "none", str(tmp_path)]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("this machine lets nobody mount")
    try:
        subprocess.run(["mount", "-o", "remount,ro", str(tmp_path)], check=True)
        with Recorder(tmp_path) as recorder:
            until(lambda: feed(recorder) or not recorder.state.ok)
            assert "Read-only" in recorder.state.alarm
            subprocess.run(["mount", "-o", "remount,rw", str(tmp_path)], check=True)
            until(lambda: feed(recorder) or recorder.state.written > 0)
    finally:
        subprocess.run(["umount", str(tmp_path)], check=False)


def test_S3_a_slow_disk_drops_the_oldest_and_never_the_loops_time(tmp_path: Path) -> None:
    """Test: each sync takes 1 s. Expected: write() stays quick, the newest are kept, the rest counted."""

    def slow(fd: int) -> None:
        sleep(1.0)

    recorder = Recorder(tmp_path, sync=slow)
    with recorder:
        feed(recorder)
        sleep(0.6)  # the thread is now inside its sync
        began = monotonic()
        for i in range(QUEUE + 100):
            recorder.write(TOPIC, "keelson.TimestampedFloat", messages.encode_float(float(i), i), i)
        assert monotonic() - began < 0.5
        assert recorder.state.dropped >= 100 and "too slow" in recorder.state.alarm
        until(lambda: recorder.state.written > QUEUE)
        path = Path(recorder.state.path)
    assert [m.log_ns for m in read(path)][-1] == QUEUE + 99


def test_S8_a_folder_deleted_while_logging_is_made_again(tmp_path: Path) -> None:
    folder = tmp_path / "logs"
    with Recorder(folder) as recorder:
        until(lambda: feed(recorder) or recorder.state.written > 0)
        shutil.rmtree(folder)
        until(lambda: feed(recorder) or (recorder.state.lost > 0 and any(folder.glob("*.mcap"))))
        assert "deleted" in recorder.state.alarm
    assert len(list(read(next(folder.glob("*.mcap"))))) == recorder.state.written

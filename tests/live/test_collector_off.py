"""The service switches the garbage collector off: whatever is done with must go without it."""

import gc
import resource
import tracemalloc
import weakref
from statistics import linear_regression

import pytest

from twin.live.keelson import messages
from twin.live.log.mcap_write import McapWriter, zstd
from twin.live.log.quota import Quota
from twin.live.log.record import Recorder
from twin.live.log.segment import Segment

TOPIC, SCALAR = "twin/@v0/ship/pubsub/heading_true_north_deg/gyro", "keelson.TimestampedFloat"


@pytest.fixture
def no_collector():
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def test_a_finished_log_file_leaves_nothing_in_memory(tmp_path, no_collector):
    """Test: 20 files, each written, finished and closed. Expected: no segment and no writer with its index is
    left."""
    left = []
    for _ in range(20):
        segment = Segment(tmp_path, "twin", 0.0, lambda fd: None, zstd())
        for i in range(50):
            segment.add(TOPIC, SCALAR, messages.encode_float(float(i), i), i, i)
        segment.sync()
        segment.finish()
        segment.close()
        left += [weakref.ref(segment), weakref.ref(segment._writer)]
    del segment
    assert len(list(tmp_path.glob("*.mcap"))) == 20 and [r for r in left if r() is not None] == []


def bytes_a_file(folder, files=200):
    """Slope of what the log holds over so many file changes [bytes a file], each file of four writes; the
    first quarter is warm-up."""
    recorder, now_s, held = Recorder(folder, max_seconds=1.0, quota=Quota(max_mb=0.05)), 0.0, []
    tracemalloc.start()
    try:
        for _ in range(files):
            for k in range(4):
                for i in range(20):
                    recorder.write(f"{TOPIC}{i % 9}", SCALAR, messages.encode_float(float(i), i), i)
                recorder._cycle(now_s + 0.25 * k)
            now_s += 1.0
            held.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
    assert recorder.state.written == files * 80 and recorder.state.path.split("-")[-2] == f"{files:06d}"
    begin = files // 4
    return linear_regression(range(begin, files), held[begin:]).slope


def test_memory_does_not_grow_over_two_hundred_log_files(tmp_path, no_collector):
    """Test: the recorder with a quota, 200 changes of file, its clock set by hand. Expected: no slope. 0.2 MB an
    hour of the service would be 50 000 bytes a file of 15 minutes."""
    assert abs(bytes_a_file(tmp_path)) < 100.0


def test_a_segment_that_is_kept_is_seen_in_the_slope(tmp_path, no_collector, monkeypatch):
    """Test: the same with each finished file kept in memory. Expected: kilobytes a file."""
    kept, close = [], Segment.close
    monkeypatch.setattr(Segment, "close", lambda segment: (kept.append(segment), close(segment)))
    assert bytes_a_file(tmp_path) > 3000.0 and len(kept) == 199


def test_a_file_that_could_not_be_begun_leaves_nothing_either(tmp_path, no_collector):
    """Test: a disk that refuses the first byte. Expected: the file is gone, and its writer with it."""
    before = sum(isinstance(o, McapWriter) for o in gc.get_objects())
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, usual[1]))
        with pytest.raises(OSError):
            Segment(tmp_path, "twin", 0.0, lambda fd: None, zstd())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)
    assert sum(isinstance(o, McapWriter) for o in gc.get_objects()) == before and not list(tmp_path.iterdir())


def test_a_thousand_ticks_of_the_service_leave_no_rings_behind(make_service, no_collector):
    """Test: a minute under way with certificate, residual and adaptation, and 40 s more. Expected: nothing
    for a collector to find."""
    bridge = make_service()
    bridge.run(60.0)
    gc.collect()
    bridge.run(40.0)
    bridge.ticks.clear()
    assert gc.collect() < 20

"""The service switches the garbage collector off: whatever is done with must go without it."""

import gc
import resource
import weakref

import pytest

from twin.live.keelson import messages
from twin.live.log.mcap_write import McapWriter, zstd
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

"""A log as the loop met it: every message of it is played, whatever the log's length."""

import pytest

from twin.live.keelson.messages import Tick, encode_float
from twin.live.keelson.topics import key
from twin.live.log.logfile import LogFile
from twin.live.log.played import PEEK, PlayedLog

HEADING = key("twin", "ship", "heading_true_north_deg", "gyro")
FLOAT = "keelson.TimestampedFloat"


@pytest.fixture
def long_log(tmp_path):
    """Two samples before each tick, more messages than are looked at to tell what kind of log it is."""
    path, count = tmp_path / "long.mcap", PEEK // 3 + 20
    with LogFile(path) as log:
        for k in range(count):
            ns = 1_700_000_000_000_000_000 + k * 100_000_000
            for _ in range(2):
                log.add(HEADING, FLOAT, encode_float(10.0, ns), ns)
            tick = Tick(index=k, time_s=0.1 * k, wall_s=ns * 1e-9)
            log.add("tick", "shiptwin.Tick", tick.SerializeToString(), ns)
    return path, count


def test_no_message_of_a_long_log_is_lost(long_log):
    """Expected: each tick with the two samples that came before it, also where the look ahead ends."""
    path, count = long_log
    batches = list(PlayedLog(path, 10.0).batches())
    assert len(batches) == count
    assert {len(batch.raw) for batch in batches} == {2}

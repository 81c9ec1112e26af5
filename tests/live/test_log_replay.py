"""A log through the same objects: twice the same bytes, and a voyage recorded live gives the same states."""

import pytest

from tests.live.conftest import Sailing
from twin.errors import DataError
from twin.live.clock import Instant
from twin.live.inbox import Inbox
from twin.live.keelson import messages
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.messages import encode_float, wrap
from twin.live.keelson.topics import BY_SUBJECT, key
from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.residual import bundled, load
from twin.live.log.mcap_read import McapReader
from twin.live.log.record import LogFile
from twin.live.log_replay import replay
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.physics.model import Model

WALL = 1.7e9


def settings(tmp_path, **more):
    return Settings({"state.folder": str(tmp_path / "state")} | more)


def ticks(path):
    return [
        messages.Tick.FromString(m.data)
        for m in McapReader(path).messages()
        if m.type_name == "shiptwin.Tick"
    ]


def spoken(readings, bus):
    """Readings as a ship's bus carries them; positions are left out, they would need a datum."""
    for r in readings:
        if r.channel in BY_SUBJECT:
            ns = round(r.time_s * 1e9)
            bus.put(key("twin", "ship", r.channel, "ship"), wrap(encode_float(r.value, ns), ns))


@pytest.fixture(scope="module")
def live_log(kvlcc2, tmp_path_factory):
    """A voyage of 60 s recorded live, with a stall, a lost sensor and garbage in it."""
    path, bus = tmp_path_factory.mktemp("live") / "live.mcap", MemoryBus()
    sailing = Sailing(kvlcc2, Model.of(kvlcc2))
    with LogFile(path) as log:
        learned = LearnedForce(kvlcc2, load(bundled(kvlcc2), kvlcc2))
        loop = Loop(kvlcc2, Inbox(bus, log.add), Outbox(Publisher(), "twin", "ship", bus, log.add), learned)
        now_s = 500.0
        for k in range(600):
            readings = sailing.readings(now_s)
            spoken([r for r in readings if not (200 < k < 300 and "yaw" in r.channel)], bus)
            if k % 50 == 0:
                bus.put(key("twin", "ship", "yaw_rate_degps", "ship"), b"\xff\xfe garbage")
            loop.tick(Instant(k, now_s, WALL + now_s, skipped=2 if k == 400 else 0))
            sailing.advance()
            now_s += 0.3 if k == 399 else 0.1
    return path


def test_a_voyage_recorded_live_replays_to_the_same_states(live_log, tmp_path):
    replay(live_log, settings(tmp_path), tmp_path / "again.mcap")
    live, again = ticks(live_log), ticks(tmp_path / "again.mcap")
    assert len(live) == len(again) == 600
    for one, other in zip(live, again, strict=True):
        assert one.estimate == other.estimate and one.sigma == other.sigma
        assert list(one.known) == list(other.known) and one.learned == other.learned
        assert list(one.predictions) == list(other.predictions)


def test_two_replays_give_the_same_bytes_and_so_does_a_replay_of_a_replay(live_log, tmp_path):
    paths = [tmp_path / f"{i}.mcap" for i in range(3)]
    replay(live_log, settings(tmp_path), paths[0])
    replay(live_log, settings(tmp_path), paths[1])
    replay(paths[0], settings(tmp_path), paths[2])
    assert paths[0].read_bytes() == paths[1].read_bytes() == paths[2].read_bytes()


def rows_log(path, sailing, seconds=200.0, every=1, rate=10.0):
    with LogFile(path) as log:
        for k in range(round(seconds * 10.0)):
            if k % every == 0:
                row = messages.Row(time_s=k / 10.0, **sailing.true())
                log.add("voyage", "shiptwin.Row", row.SerializeToString(), round(k * 1e8))
            sailing.advance()
    return path


def test_an_imported_voyage_is_sailed_and_judged(sailing, tmp_path):
    summary = replay(rows_log(tmp_path / "v.mcap", sailing), settings(tmp_path, **{"residual.file": "none"}))
    assert summary.kind == "an imported voyage" and summary.ticks == 2000 and summary.rejected == 0
    assert summary.modes == {"physics only": 2000}
    assert [(f.horizon_s, f.windows) for f in summary.foresight] == [(10.0, 6), (60.0, 4), (120.0, 2)]
    assert summary.foresight[2].position_m < 5.0 and summary.foresight[2].heading_deg < 1.0


def test_a_voyage_of_one_sample_a_second_has_ticks_in_between(sailing, tmp_path):
    summary = replay(
        rows_log(tmp_path / "v.mcap", sailing, 100.0, every=10),
        settings(tmp_path, **{"residual.file": "none"}),
    )
    assert summary.ticks == 991 and set(summary.modes) == {"physics only"}


def test_a_voyage_whose_time_begins_before_zero_is_replayed_into_a_log(sailing, tmp_path):
    """Test: seconds counted from the rudder's order, the first 3 s before it. Expected: a log, though MCAP has no
    time before 1970."""
    with LogFile(tmp_path / "v.mcap") as log:
        for k in range(50):
            row = messages.Row(time_s=k / 10.0 - 3.0, **sailing.true())
            log.add("voyage", "shiptwin.Row", row.SerializeToString(), round(k * 1e8))
            sailing.advance()
    chosen = settings(tmp_path, **{"residual.file": "none"})
    assert replay(tmp_path / "v.mcap", chosen, tmp_path / "out.mcap").ticks == 50
    assert [t.time_s for t in ticks(tmp_path / "out.mcap")][::49] == pytest.approx([-3.0, 1.9])


def test_a_log_of_scalars_without_a_twin_is_sailed_too(sailing, tmp_path):
    path = tmp_path / "foreign.mcap"
    with LogFile(path) as log:
        for k in range(600):
            ns = round((WALL + 0.1 * k) * 1e9)
            for r in sailing.readings(0.1 * k):
                if r.channel in BY_SUBJECT:
                    log.add(
                        key("rise", "alma", r.channel, "x"),
                        "keelson.TimestampedFloat",
                        encode_float(r.value, ns),
                        ns,
                    )
            sailing.advance()
    summary = replay(path, settings(tmp_path))
    assert (
        summary.kind == "a log of Keelson scalars" and summary.ticks == 600 and summary.modes["hybrid"] > 500
    )


@pytest.mark.parametrize("data", (b"", b"not a log", b"\x89MCAP0\r\n"))
def test_what_is_no_log_is_refused_in_one_line(tmp_path, data):
    (tmp_path / "x.mcap").write_bytes(data)
    with pytest.raises(DataError):
        replay(tmp_path / "x.mcap", settings(tmp_path), tmp_path / "out.mcap")
    assert not list(tmp_path.glob("*out.mcap*"))


def test_a_log_without_anything_the_twin_knows_is_refused(tmp_path):
    path = tmp_path / "x.mcap"
    with LogFile(path) as log:
        log.add(
            "rise/@v0/alma/pubsub/unknown/x", "keelson.TimestampedFloat", encode_float(1.0, 10**18), 10**18
        )
    with pytest.raises(DataError, match="no measurements in it"):
        replay(path, settings(tmp_path))


def test_a_log_that_was_cut_off_is_replayed_as_far_as_it_is_whole(live_log, tmp_path):
    data = live_log.read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 2])
    try:
        summary = replay(tmp_path / "cut.mcap", settings(tmp_path))
        assert summary.notes
    except DataError:
        pass  # a short log is one chunk

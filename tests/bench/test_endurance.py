"""The shocks of the service, once each and short: what is counted is what happened."""

import random
import time

import pytest
import zenoh

from bench.endurance import side_by_side, storm
from bench.endurance.killed_service import Said, ServiceFolder, said_of
from bench.endurance.lies import OTHERS, LieNoticed
from bench.endurance.run import of_kills, of_lies, of_shocks, of_storm
from bench.endurance.shocks import Killed, Shocked, clock_step_s, kills, pause_s, whole
from bench.endurance.side_by_side import ShocksKept, shocked
from bench.fuzz.aboard import LoopTarget, Watched
from bench.lie_kinds import LIES
from bench.reference import WEATHERS
from twin.live.keelson.messages import encode_float, wrap
from twin.live.keelson.topics import INPUTS, key
from twin.live.keelson.zenoh_config import BusSettings, configuration
from twin.live.left_open import LeftOpen


def say_waves(endpoint):
    """The wave height of the sea, which its own instrument says once a minute: no promise before."""
    (topic,) = (t for t in INPUTS if "wave_height_significant_m" in t.channels)
    now_ns = time.time_ns()
    with zenoh.open(configuration(BusSettings(connect=(endpoint,)))) as session:
        publisher = session.declare_publisher(key("twin", "ship", topic.subject, "sea"))
        time.sleep(0.5)  # until the twin hears it
        publisher.put(wrap(encode_float(WEATHERS["TS-01"].wave_height_m, now_ns), now_ns))
        time.sleep(0.2)


def test_a_service_that_is_killed_loses_at_most_half_a_second_and_all_its_logs_are_whole(tmp_path):
    """Test: two kills under way, everything on. Expected: as the page counts two hundred."""
    place, made = ServiceFolder(tmp_path, "kvlcc2"), []

    def keep(_, found):
        made.append(found)
        say_waves(place.endpoint)

    try:
        good, files = kills(place, iter((0, 1)), keep)
    finally:
        place.close()
    assert [k.lost_s <= 0.5 for k in made] == [True, True]
    assert good == files >= 3
    log = next(place.logs.glob("*.mcap"))
    log.write_bytes(log.read_bytes()[:-100] + bytes(100))
    assert not whole(log)


def test_shocks_go_on_where_the_last_run_ended(tmp_path, monkeypatch):
    """Test: two of three, then three, with a stand-in for the shock; the two services side by side. Expected:
    nothing is tried again, all come in their order, and what the ends count is added up."""
    tried = []

    def stand_in(place, numbers, keep):
        for k in numbers:
            tried.append(k)
            keep(k, Killed(1.0, 0.1 * k, 2.0))
        return 3, 4

    class NoService:
        def __init__(self, folder, hull):
            assert folder.is_dir() and hull == "tanker"

        def close(self):
            pass

    monkeypatch.setattr(side_by_side, "ServiceFolder", NoService)
    monkeypatch.setitem(side_by_side.KINDS_OF_SHOCK, "kills", (stand_in, Killed))
    shocked("kills", 2, 1, "tanker", tmp_path / "kept")
    found = shocked("kills", 3, 2, "tanker", tmp_path / "kept")
    assert sorted(tried) == [0, 1, 2]
    assert [s.lost_s for s in found.shocks] == pytest.approx([0.0, 0.1, 0.2])
    assert (found.good, found.ended) == (6, 8)


def test_two_hundred_pauses_and_clock_steps_cover_what_was_asked():
    """Expected: pauses from 0.1 s to 10 min, evenly in their logarithm; every tenth from -3 to 3 s, and steps to
    either side up to a day."""
    lengths = [pause_s(k) for k in range(200)]
    assert 0.1 <= min(lengths) < 0.12 and 540.0 < max(lengths) <= 600.0
    assert all(sum(low <= x < 10 * low for x in lengths) >= 40 for low in (0.1, 1.0, 10.0))
    steps = [clock_step_s(k) for k in range(200)]
    assert {round(x, 1) for x in steps} >= {sign * k / 10 for k in range(1, 31) for sign in (1, -1)}
    assert min(steps) < -3600 and max(steps) > 3600 and 80 <= sum(x < 0 for x in steps) <= 120


def test_a_storm_is_counted_and_finds_a_promise_that_is_not_kept(monkeypatch, tmp_path):
    """Test: a voyage of 300 ticks; then with the noise and age of samples forgotten. Expected: counts as they
    were made; the broken promise is found."""
    target = LoopTarget(tmp_path / "certificate.json")
    one = storm.voyage(target, random.Random(1), False, 300)
    assert one.ticks == one.honest_ticks == 300 and one.voyages == 1
    assert 0 < one.honest_inside <= 300 and 1000 < one.messages <= 2700 and one.pauses > 0
    assert storm.voyage(target, random.Random(2), True, 100).honest_ticks == 0
    monkeypatch.setattr(LeftOpen, "bounds", property(lambda _: ((0.0, 0.0, 0.0), 0.0)))
    with pytest.raises(Watched, match="a promise that is not kept"):
        storm.voyage(target, random.Random(1), False, 300)
    assert "100.0 % of them with a promise" in of_storm(storm.Storm(9, 4, 1, 1, 1, 2, 2))


def test_a_line_of_the_pipe_is_read():
    said = said_of("7 12.5 1 3 dead reckoning|lagging: 3 periods; x")
    assert said == Said(7, 12.5, True, 3, "dead reckoning", "lagging: 3 periods; x")


def test_twenty_four_lies_have_names_of_their_own_and_each_tells_something_else():
    names = [lie.name for lie in (*LIES, *OTHERS)]
    assert len(set(names)) == len(names) == 24
    for lie in OTHERS:
        row = dict.fromkeys(("north_m", "east_m", "heading_true_north_deg", "surge_velocity_mps", "sway_velocity_mps", "yaw_rate_degps", "rudder_angle_deg", "propeller_rate_rpm"), 3.0)  # fmt: skip
        memory = {"north_m": 1.0, "east_m": 1.0} if lie.name == "positions frozen" else {}
        before = dict(row)
        lie.tell(row, 10.0, memory)
        assert row != before, lie.name


def test_the_pages_say_what_was_counted():
    made = [Killed(1.0, 0.1, 2.0), Killed(1.0, 0.3, 2.5)]
    page = of_kills(ShocksKept(made, 3, 3))
    assert "2 of 2" in page and "0.300 at most" in page and "3 of 3" in page
    made = [Shocked("pause of 4 s", 4.0, 0.1, 0.2, None, 7), Shocked("pause of 5 s", 5.0, 0.3, None, 1.2, 2)]
    page = of_shocks("pauses", ShocksKept(made, 1, 1))
    assert "| 3 to 10 s | 2 | 0.3 | 1 | 0.2, 0.2 | 1.2, 1.2 | 1 | 4, 7 |" in page
    assert "* pause of 4 s: " in page and "* pause of 5 s: " not in page
    page = of_lies("kvlcc2", "TS-01", [LieNoticed("none", None, "", 1.0, 0.0, 0.03)])
    assert "| none | - |  | 100 % | 0.0 % | 0.03 |" in page

"""C9: clocks that are off, set, or drifting, ours and the instruments', on the loop that the service
builds."""

from math import isfinite

import pytest

from tests.thorough import one_of
from twin.live.keelson.stamps import Stamps
from twin.live.signals.readings import Quality, Reading

STEP_S, WALL = 0.1, 1.7e9  # as in conftest.py

# by tenths where what is said and done changes, else coarsely, to the half second beyond
FINE = [round(0.1 * k, 1) for k in range(-7, 4)]
TABLE = [-3.0, -2.5, -2.1, -1.6, -1.1, *FINE, 0.6, 1.1, 1.9, 2.4, 3.0]
WELL = ("hybrid", "physics only")


def off(by):
    """The instruments' clocks differ from ours by `by(bridge)` seconds."""
    return lambda readings, b: [r._replace(time_s=r.time_s + by(b)) for r in readings]


def reckoned_s(ticks):
    return STEP_S * sum(t.mode not in WELL for t in ticks)


def clocks(tick):
    return [reason for reason in tick.reasons if reason.startswith("clock of ")]


@pytest.mark.parametrize("by_s", TABLE)
def test_C9_instruments_whose_clocks_are_off_from_the_start_are_heard_after_six_seconds(served, by_s):
    """Test: every stamp off by up to 3 s. Expected: on measurements after 6 s and from then on; the offset in
    words, if it is one."""
    bridge = served()
    ticks = bridge.run(10.0, off(lambda b: by_s))
    assert all(t.mode in WELL for t in ticks[60:])
    said = clocks(ticks[-1])
    if by_s > 0.15 or by_s < -0.55:
        way = "ahead of" if by_s > 0.0 else "behind"
        assert said == [
            f"clock of ship: {abs(by_s):.1f} s {way} this computer's; its stamps are corrected by that"
        ]
    elif -0.5 < by_s <= 0.1:
        assert not said
    assert abs(bridge.error("heading_true_north_deg")) < 0.3 and abs(bridge.error("north_m")) < 4.0


@pytest.mark.parametrize("step_s", [*TABLE, 3600.0, -3600.0, -7200.0, 86400.0])
def test_C9_our_clock_may_be_set_by_anything_and_no_sample_is_lost(served, step_s):
    """Test: our clock is set, the instruments' are not. Expected: no tick in dead reckoning, nothing
    refused."""
    bridge = served()
    bridge.run(3.0)
    bridge.wall_less_mono += step_s
    ticks = bridge.run(4.0)
    assert all(t.mode in WELL for t in ticks) and ticks[-1].rejected == 0
    if abs(step_s) != 0.2:  # there a sum of floats decides
        assert bool(clocks(ticks[-1])) == (abs(step_s) > 0.2)


@pytest.mark.parametrize("step_s", [*TABLE, 3600.0, -7200.0])
def test_C9_nor_is_one_when_the_instruments_clocks_are_set_with_ours_or_later(served, step_s):
    bridge = served()
    bridge.run(3.0)
    bridge.wall_less_mono += step_s
    ticks = bridge.run(3.0) + bridge.run(4.0, off(lambda b: step_s))
    assert reckoned_s(ticks) <= 0.1 and all(t.mode in WELL for t in ticks[40:])


@pytest.mark.parametrize("step_s", TABLE)
def test_C9_an_instruments_clock_that_is_set_costs_two_seconds_at_most(served, step_s):
    """Test: the instruments' clocks jump in the run, ours does not. Expected: on measurements again within 3
    s."""
    bridge = served()
    bridge.run(3.0)
    ticks = bridge.run(8.0, off(lambda b: step_s))
    assert reckoned_s(ticks) < 2.5 and all(t.mode in WELL for t in ticks[30:])


@pytest.mark.parametrize("drift", one_of([3e-2, -3e-2, 1e-3, -1e-3, 1e-2, -1e-2], 2))
def test_C9_a_clock_that_drifts_is_followed(served, drift):
    """Test: the instruments' clocks run fast or slow, to 3 s off and more. Expected: never in dead reckoning,
    the size in words."""
    bridge = served()
    start_s, seconds = bridge.now_s, min(3.3 / abs(drift), 300.0)
    ticks = bridge.run(seconds, off(lambda b: drift * (b.now_s - start_s)))
    assert reckoned_s(ticks) == 0.0
    if seconds * abs(drift) > 1.0:
        assert ("ahead of" if drift > 0.0 else "behind") in clocks(ticks[-1])[0]


@pytest.mark.parametrize("smeared", [True, False], ids=["ours smeared", "ours stepped"])
def test_C9_a_leap_second_is_no_event(served, smeared):
    """Test: 23:59:60, the instruments repeat a second; our clock does the same or loses it over a minute."""
    bridge = served()
    bridge.run(3.0)
    ticks = []
    if smeared:
        for _ in range(30):
            bridge.wall_less_mono -= 1.0 / 60.0
            ticks += bridge.run(1.0)
        ticks += bridge.run(5.0, off(lambda b: -1.0))
    else:
        bridge.wall_less_mono -= 1.0
        ticks += bridge.run(5.0, off(lambda b: -1.0))
    assert reckoned_s(ticks) < 2.5 and ticks[-1].mode in WELL


def test_a_busy_bus_is_not_taken_for_a_clock():
    """Test: samples arrive up to 1.8 s late, one in ten at once. Expected: their stamps are believed as they
    are."""
    stamps = Stamps()
    for k in range(600):
        now_s = 100.0 + 0.1 * k
        stamps.observe(now_s, WALL + now_s)
        late_s = 0.05 if k % 10 == 0 else 0.9 + 0.9 * (k % 7) / 6.0
        t, quality = stamps.on_monotonic(Reading("yaw_rate_degps", 0.0, WALL + now_s - late_s, now_s, "gyro"))
        assert quality is Quality.OK and t == pytest.approx(now_s - late_s)
    assert not stamps.reasons(now_s) and not stamps.unsure(now_s)


def sampled(stamps, seconds, off_s, start_s=100.0, source="gyro", wild=lambda k: 0.0):
    said = []
    for k in range(round(10.0 * seconds)):
        now_s = start_s + 0.1 * k
        stamps.observe(now_s, WALL + now_s)
        said.append(
            stamps.on_monotonic(Reading("yaw_rate_degps", 0.0, WALL + now_s + off_s + wild(k), now_s, source))
        )
    return said, now_s


def test_two_wild_stamps_move_nothing():
    stamps = Stamps()
    said, now_s = sampled(stamps, 20.0, -1.2, wild=lambda k: 9.0 if k in (3, 30) else 0.0)
    assert said[-1] == (pytest.approx(now_s), Quality.OK)


def test_I14_a_recording_is_not_taken_for_a_clock_that_is_off():
    """Test: stamps a minute, an hour, a year old or ahead, for a minute. Expected: refused to the end."""
    for off_s in (-60.0, -3600.0, -3e7, 60.0, 3600.0):
        said, _ = sampled(Stamps(), 60.0, off_s)
        assert {quality for _, quality in said} == {Quality.OLD if off_s < 0.0 else Quality.FUTURE}


def test_where_lateness_may_be_the_transports_it_is_said_and_of_a_set_clock_it_is_not():
    slow, clock_set = Stamps(), Stamps()
    _, now_s = sampled(slow, 10.0, -1.2)
    assert "its samples come late" in slow.unsure(now_s)
    sampled(clock_set, 10.0, 0.0)
    _, now_s = sampled(clock_set, 10.0, -1.2, 110.0)
    assert clock_set.reasons(now_s) and not clock_set.unsure(now_s)


def test_a_source_that_falls_silent_is_spoken_of_no_more():
    stamps = Stamps()
    _, now_s = sampled(stamps, 10.0, 1.5)
    assert stamps.reasons(now_s) == [
        "clock of gyro: 1.5 s ahead of this computer's; its stamps are corrected by that"
    ]
    assert not stamps.reasons(now_s + 121.0)


def test_sources_without_end_do_not_fill_the_memory():
    stamps = Stamps()
    for k in range(5000):
        sampled(stamps, 0.1, 0.0, 100.0, f"source {k}")
    assert len(stamps._clocks) <= 512


@pytest.mark.parametrize("by_s", [-1.2, 0.8, 2.4])
def test_the_same_messages_give_the_same_bytes_whatever_the_clocks(served, by_s):
    one, other = (served().run(12.0, off(lambda b: by_s)) for _ in range(2))
    assert [t.SerializeToString(deterministic=True) for t in one] == [
        t.SerializeToString(deterministic=True) for t in other
    ]
    assert all(isfinite(t.estimate.north_m) for t in one[-10:])

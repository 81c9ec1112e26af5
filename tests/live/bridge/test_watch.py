"""What the bridge sees: the twin's numbers, how old they are, and what is wrong."""

import json
from math import nan

import pytest

from twin.errors import DataError, UsageError
from twin.live.bridge.alarms import HOLD_S, Alarms
from twin.live.bridge.feed import About, LogFeed, sound
from twin.live.bridge.scene import KNOT
from twin.live.bridge.text import Text, line, page
from twin.live.keelson.messages import Tick
from twin.live.log.logfile import LogFile
from twin.live.signals.readings import Quality


def test_a_picture_says_what_the_tick_says_in_the_bridges_units(watch, feed, ticks):
    tick = ticks[-1]
    feed.give(*ticks)
    frame = watch.step(5.0)
    states = {s["name"]: s for s in frame["states"]}
    assert states["speed ahead"]["estimate"] == pytest.approx(
        tick.estimate.surge_velocity_mps / KNOT, abs=0.006
    )
    assert states["rate of turn"]["measured"] == pytest.approx(60.0 * tick.measured.yaw_rate_degps, abs=0.06)
    assert states["heading"]["sigma"] == pytest.approx(tick.sigma.heading_true_north_deg, abs=0.06)
    assert frame["mode"]["name"] == tick.mode and not frame["feed"]["silent"]
    known = frame["forces"]["rows"][0]
    per = {"N": 1.0, "kN": 1e3, "MN": 1e6}[frame["forces"]["unit"]]
    assert known["X"] * per == pytest.approx(sum(f.X_N for f in tick.known), abs=0.06 * per)
    json.dumps(frame, allow_nan=False)


def test_where_the_ship_will_be_is_kept_until_it_is_said_again(watch, feed, ticks):
    """Test: the tick with predictions, then ticks without. Expected: both horizons with the published
    uncertainty, and the way through the published places."""
    said = [t for t in ticks if t.predictions][-1]
    feed.give(*ticks)
    ahead = watch.step(5.0)["ahead"]
    assert [p["horizon"] for p in ahead["shown"]] == [60.0, 120.0] and not ahead["old"]
    meant = {p.horizon_s: p for p in said.predictions}
    for shown in ahead["shown"]:
        p = meant[shown["horizon"]]
        assert shown["n"] == pytest.approx(p.state.north_m, abs=0.01)
        assert (shown["sn"], shown["status"]) == (pytest.approx(p.sigma.north_m, abs=0.01), p.status)
        assert min(abs(n - shown["n"]) + abs(e - shown["e"]) for n, e, _ in ahead["way"]) < 0.2


def test_what_reference_voyages_promise_is_shown_along_the_course_and_what_they_do_not_is_said(
    watch, feed, ticks
):
    """Test: a tube with a promise to 60 s, one without at 120 s. Expected: the ellipse of the first with its
    level and voyages, half its width beside the way; the reason for the second, and no smaller region of
    another kind that would look the surer one."""
    said = [t for t in ticks if t.predictions][-1]
    for p in said.predictions:
        promised = p.horizon_s < 60.5
        p.tube.along_m, p.tube.across_m, p.tube.course_deg, p.tube.heading_deg = 12.0, 7.0, 33.0, 2.5
        p.tube.level, p.tube.voyages = 0.9 if promised else 0.0, 20
        p.tube.status = "calibrated" if promised else "wind above the references'"
    feed.give(*ticks)
    frame = watch.step(5.0)
    first, second = frame["ahead"]["shown"]
    assert (first["tube"]["along"], first["tube"]["across"], first["tube"]["course"]) == (12.0, 7.0, 33.0)
    assert (first["tube"]["level"], first["tube"]["voyages"], second["tube"]["level"]) == (90, 20, 0)
    nearest = min(frame["ahead"]["way"], key=lambda p: abs(p[0] - first["n"]) + abs(p[1] - first["e"]))
    assert nearest[2] == pytest.approx(7.0, abs=0.2)
    assert second["sn"] is None and frame["ahead"]["way"][-1][2] is None
    words = page(frame)
    assert "90 %, on 20 voyages" in words and "no promise, wind above the references'" in words


def test_a_prediction_that_is_not_renewed_grows_old(watch, feed, ticks):
    first = next(i for i, t in enumerate(ticks) if t.predictions)
    for tick in ticks[first + 1 :]:
        tick.ClearField("predictions")
    feed.give(*ticks[first:])
    ahead = watch.step(1.0)["ahead"]
    assert ahead["old"] and ahead["age"] == pytest.approx(ticks[-1].time_s - ticks[first].time_s, abs=0.1)


def test_after_a_second_without_a_tick_the_picture_is_old(watch, feed, ticks):
    """Test: a twin that falls silent. Expected: live for a second, then marked, with the seconds counted, in
    the terminal too; live again with the next tick."""
    feed.give(ticks[0])
    assert not watch.step(10.0)["feed"]["silent"]
    assert not watch.step(10.9)["feed"]["silent"]
    frame = watch.step(13.0)
    assert frame["feed"]["silent"] and frame["feed"]["silent_s"] == 3.0
    assert "NOTHING HEARD FOR 3 s" in page(frame) and line(frame).startswith("NOTHING HEARD FOR 3 s")
    ages = {i["name"]: i["age"] for i in frame["instruments"]}
    assert ages["yaw rate"] == pytest.approx(ticks[0].age_s.yaw_rate_degps + 3.0, abs=0.06)
    feed.give(ticks[1])
    frame = watch.step(13.1)
    assert not frame["feed"]["silent"] and "NOTHING HEARD" not in page(frame)


def test_a_twin_that_was_never_heard_is_not_a_twin_that_is_well(watch):
    frame = watch.step(2.0)
    assert frame["feed"]["silent"] and "mode" not in frame
    assert "NOTHING HEARD YET" in page(frame) and "NOTHING HEARD YET" in line(frame)


def test_an_instrument_that_is_lost_is_said_with_its_age(watch, feed, ticks):
    tick = ticks[-1]
    tick.quality.rudder_angle_deg, tick.age_s.rudder_angle_deg = Quality.STALE, 7.5
    feed.give(tick)
    frame = watch.step(1.0)
    (rudder,) = [i for i in frame["instruments"] if i["name"] == "rudder angle"]
    assert (rudder["age"], rudder["level"]) == (7.5, "bad")
    assert "rudder angle 7.5 s (the last good sample is too old)" in " ".join(page(frame).split())


def test_the_way_behind_is_forgotten_when_another_voyage_begins(watch, feed, ticks):
    feed.give(*ticks)
    watch.step(1.0)
    assert len(watch.trail) == 4
    feed.give(ticks[0])
    watch.step(1.1)
    assert len(watch.trail) == 1


def test_an_alarm_keeps_its_time_while_its_numbers_change():
    alarms = Alarms()
    alarms.observe(["heading lost, for 3 s"], 0.0, 100.0)
    alarms.observe(["heading lost, for 4 s"], 1.0, 101.0)
    (alarm,) = alarms.listed()
    assert (alarm["since_s"], alarm["text"], alarm["over"]) == (100.0, "heading lost, for 4 s", False)


def test_an_alarm_that_is_over_stays_until_it_is_acknowledged():
    alarms = Alarms()
    alarms.observe(["bus: out of reach"], 0.0, 100.0)
    alarms.observe([], HOLD_S + 1.0, 104.0)
    (alarm,) = alarms.listed()
    assert alarm["over"] and not alarm["acknowledged"]
    assert alarms.acknowledge(alarm["key"]) and not alarms.listed()
    assert not alarms.acknowledge("never there")


def test_an_alarm_that_was_acknowledged_and_comes_again_is_new():
    alarms = Alarms()
    alarms.observe(["x"], 0.0, 100.0)
    alarms.acknowledge("")
    alarms.observe(["x"], 1.0, 101.0)
    assert alarms.listed()[0]["acknowledged"]
    alarms.observe([], 10.0, 110.0)
    assert not alarms.listed()
    alarms.observe(["x"], 11.0, 111.0)
    assert [(a["since_s"], a["acknowledged"]) for a in alarms.listed()] == [(111.0, False)]


@pytest.mark.parametrize("wrong", [nan, float("inf"), -1e300])
def test_a_record_with_a_number_that_is_none_is_not_the_twins(ticks, wrong):
    assert sound(ticks[-1])
    ticks[-1].known[0].X_N = wrong
    assert not sound(ticks[-1])


def test_a_record_with_thousands_of_forces_is_not_the_twins():
    tick = Tick(time_s=1.0)
    for _ in range(1000):
        tick.known.add(name="x")
    assert not sound(tick)


def test_what_a_twin_says_of_itself_may_be_anything():
    for said in (None, [], {"length_m": "x", "ship": 5}, {"length_m": nan, "beam_m": -3}, {"origin": None}):
        about = About.of(said)
        assert (about.length_m, about.beam_m) == (0.0, 0.0) and isinstance(about.ship, str)


def test_a_log_is_played_at_its_own_pace_with_the_ships_size(log, ticks, kvlcc2):
    feed = LogFeed(log, speed=2.0)
    assert (feed.about.ship, feed.about.length_m, feed.about.origin) == (kvlcc2.name, kvlcc2.L_pp, "log")
    assert len(feed.poll(100.0)) == 1
    assert len(feed.poll(101.0)) == pytest.approx(20, abs=1)
    assert not feed.over
    rest = feed.poll(120.0)
    assert feed.over and rest[-1].index == ticks[-1].index


def test_a_log_without_a_tick_is_one_line_that_says_what_to_do(tmp_path):
    with LogFile(tmp_path / "empty.mcap"):
        pass
    with pytest.raises(DataError, match="twin replay"):
        LogFeed(tmp_path / "empty.mcap")
    with pytest.raises(UsageError, match="--speed"):
        LogFeed(tmp_path / "empty.mcap", 0.0)


def test_the_terminal_draws_pages_or_lines_as_often_as_is_good(watch, feed, ticks):
    from io import StringIO

    for pages, most in ((True, 8), (False, 1)):
        stream = StringIO()
        text = Text(stream, pages)
        for i in range(20):
            feed.give(ticks[i])
            text.show(watch.step(0.1 * i), 0.1 * i)
        drawn = stream.getvalue().count("\x1b[J") if pages else stream.getvalue().count("\n")
        assert 1 <= drawn <= most
        assert all(len(row) <= 120 for row in stream.getvalue().splitlines()) or not pages


def test_two_instruments_whose_names_differ_by_a_digit_have_two_alarms():
    """Test: the first is acknowledged, then the second goes wrong. Expected: the second one is new, and stands; each
    is still the same alarm when its number changes."""
    alarms = Alarms()
    first, second = (
        "clock of gyro/1: {} s behind this computer's",
        "clock of gyro/2: {} s behind this computer's",
    )
    alarms.observe([first.format(3.2)], 0.0, 0.0)
    assert alarms.acknowledge("")
    alarms.observe([first.format(3.3), second.format(-9.9)], 1.0, 1.0)
    alarms.observe([first.format(3.4), second.format(-10.1)], 2.0, 2.0)
    assert [(a["text"], a["acknowledged"]) for a in alarms.listed()] == [
        (second.format(-10.1), False),
        (first.format(3.4), True),
    ]

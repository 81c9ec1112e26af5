"""The guard by itself, on made-up measurements: each step of the ladder, each reason, and where its limits are."""

from math import radians
from types import SimpleNamespace

import pytest

from twin.live.guard import BETTER, WORSE, Guard, LatchedFault
from twin.live.learning.learned_force import Learned
from twin.live.signals.measured import Measured

READY = SimpleNamespace(ready=True)
ALL = {"x": 0.0, "y": 0.0, "psi": 0.1, "u": 5.0, "v": 0.0, "r": 0.0, "delta": 0.0, "n": 1.0}
HOLD_S = 30.0


def learning(with_learned=1.0, without=1.0, judged=True, residual=True, stuck=""):
    """A learned force with this evidence."""
    evidence = SimpleNamespace(judged=judged, with_learned=with_learned, without=without)
    return SimpleNamespace(
        residual=residual or None,
        why_not="none is there",
        evidence=evidence,
        helm=SimpleNamespace(stuck=stuck),
    )


@pytest.fixture
def guard(kvlcc2):
    return Guard(kvlcc2, learning(), hold_s=HOLD_S)


def measured(now_s, without=(), derived=(), steps=None, clock_step_s=0.0):
    """All that the ladder needs, less what is missing."""
    si = {a: x for a, x in ALL.items() if a not in without}
    return Measured(now_s, si, steps=steps or {}, derived=set(derived), clock_step_s=clock_step_s)


def judged(guard, now_s, sensors=(), doubts=(), estimate=READY, **missing):
    return guard.judge(measured(now_s, **missing), estimate, list(sensors), 0.1, list(doubts))


def test_the_ladders_steps_and_what_is_said_at_each(guard):
    """Test: everything; no compass; a heading carried by gyro and course; no position or speed at all. Expected:
    the mode, the reason, whether the learned force acts and why learning stands still."""
    assert judged(guard, 0.0) == ("hybrid", [], True, "", "")
    verdict = judged(guard, 0.1, without=("psi",))
    assert verdict[:4] == (
        "dead reckoning", ["no heading, for 0 s; the model runs on alone"], True, "no heading",
    )  # fmt: skip
    verdict = judged(guard, 0.2, derived=("psi",))
    assert verdict[:4] == (
        "dead reckoning", ["no heading from the compass: gyro and course carry it"], True, "no heading",
    )  # fmt: skip
    verdict = judged(guard, 0.3, without=("x", "u"))
    assert verdict.frozen == "no position and speed"
    for one in ("x", "u", "u_r"):
        left = {"x", "u", "u_r"} - {one}
        held = measured(0.4, without=left)
        held.si[one] = 1.0
        assert guard.judge(held, READY, [], 0.1).mode == "hybrid", one
    verdict = judged(guard, 0.5, without=("psi", "x", "u", "delta"))
    assert verdict.frozen == "no rudder_angle_deg, no heading, no position and speed"


def test_dead_reckoning_is_invalid_after_its_time_and_its_clock_begins_anew_each_time(kvlcc2):
    """Expected: invalid only beyond sixty seconds, however often something was heard before; a heading that gyro
    and course carry counts as heard."""
    guard = Guard(kvlcc2, learning())
    assert guard.reckoning_s == 60.0
    lost = {"without": ("psi",)}
    assert judged(guard, 0.0, **lost).mode == "dead reckoning"
    verdict = judged(guard, 60.0, **lost)
    assert verdict.mode == "dead reckoning" and verdict.use_learned and "for 60 s" in verdict.reasons[0]
    verdict = judged(guard, 60.1, **lost)
    assert verdict.mode == "invalid" and not verdict.use_learned
    for heard in ({}, {"derived": ("psi",)}):
        judged(guard, 70.0, **heard)
        assert judged(guard, 71.0, **lost).reasons[0].startswith("no heading, for 0 s")
        assert judged(guard, 131.1, **lost).mode == "invalid"


def test_before_the_first_estimate_it_says_what_it_waits_for(guard):
    waiting = SimpleNamespace(ready=False)
    said = lambda **missing: judged(guard, 0.0, estimate=waiting, **missing)
    assert said() == ("starting", ["waiting for the next sample"], False, "no estimate yet", "")
    assert said(without=("psi",)).reasons == ["waiting for heading"]
    assert said(without=("x", "u")).reasons == ["waiting for position or speed"]
    assert said(without=("x",)).reasons == said(without=("u",)).reasons == ["waiting for the next sample"]
    assert said(without=("psi", "x", "u")).reasons == ["waiting for heading and position or speed"]
    assert judged(guard, 0.0, estimate=waiting, doubts=["a", "b"]).odd == "a"


def test_what_contradicts_stops_learning_and_the_learned_force(guard):
    """Expected: a doubt of instruments switches the learned force off at once and for the hold after it has
    ended; a channel that counts stops learning only, any other nothing; a stuck rudder stops learning."""
    verdict = judged(guard, 0.0, doubts=["compass against gyro"])
    assert verdict == (
        "physics only", ["learned force off: compass against gyro", "compass against gyro"], False,
        "compass against gyro", "compass against gyro",
    )  # fmt: skip
    assert judged(guard, HOLD_S - 0.1).mode == "physics only" and judged(guard, HOLD_S).mode == "hybrid"
    for channel, stops in (
        ("heading_true_north_deg", True), ("surge_velocity_mps", True), ("sway_velocity_mps", True),
        ("yaw_rate_degps", True), ("rudder_angle_deg", True), ("propeller_rate_rpm", True),
        ("north_m", False), ("water_depth_m", False),
    ):  # fmt: skip
        verdict = judged(guard, 40.0, sensors=[f"{channel}: stays the same"])
        assert verdict.mode == "hybrid" and verdict.reasons == [f"{channel}: stays the same"]
        assert bool(verdict.frozen) is stops and verdict.odd == "", channel
    guard.learned = learning(stuck="the rudder is stuck")
    verdict = judged(guard, 50.0)
    assert verdict.frozen == verdict.odd == "the rudder is stuck" in verdict.reasons


def test_a_learned_force_that_makes_it_worse_is_off_until_it_is_clearly_better(kvlcc2):
    """Expected: off above the one limit, not at it; on again after the hold, once below the other, not at it."""
    guard = Guard(kvlcc2, learning(with_learned=WORSE), hold_s=HOLD_S)
    assert judged(guard, 0.0).mode == "hybrid"
    guard.learned.evidence.with_learned = WORSE + 0.01
    verdict = judged(guard, 1.0)
    assert verdict.mode == "physics only" and not verdict.use_learned
    assert verdict.reasons == ["learned force off: the learned force made it worse than the physics alone"]
    guard.learned.evidence.with_learned = BETTER + 0.01
    assert judged(guard, 100.0).mode == "physics only"
    guard.learned.evidence.with_learned = BETTER
    assert judged(guard, 100.0 + HOLD_S - 0.1).mode == "physics only"
    assert judged(guard, 100.0 + HOLD_S).mode == "hybrid"
    guard.learned.evidence.with_learned, guard.learned.evidence.judged = 9.0, False
    assert judged(guard, 200.0).mode == "hybrid"
    guard.learned = learning(residual=False)
    assert judged(guard, 201.0).reasons == ["no learned force: none is there"]


@pytest.mark.parametrize("lost", ({"without": ("x", "u")}, {"derived": ("psi",)}))
def test_a_learned_force_that_is_off_stays_off_in_dead_reckoning(kvlcc2, lost):
    """Test: it made it worse, and then position, or the compass, is lost. Expected: off, and said so."""
    guard = Guard(kvlcc2, learning(with_learned=2.0), hold_s=HOLD_S)
    worse = "learned force off: the learned force made it worse than the physics alone"
    assert judged(guard, 0.0)[:3] == ("physics only", [worse], False)
    verdict = judged(guard, 0.1, **lost)
    assert verdict.mode == "dead reckoning" and not verdict.use_learned and verdict.reasons[1] == worse


def test_what_the_learned_force_says_of_itself(guard):
    """Expected: what broke is held, what only has no say now is not; a force that is shrunk acts and says so."""
    for why, held in (
        ("it gives NaN", True),
        ("it failed", True),
        ("an absurd number", True),
        ("asleep", False),
    ):
        now_s = 1000.0 * (1 + len(why))
        guard.note(Learned(why=why), 0.1)
        assert judged(guard, now_s).reasons == [f"learned force off: {why}"], why
        guard.note(Learned(weight=1.0), 0.1)
        assert (judged(guard, now_s + 1.0).mode == "physics only") is held, why
        assert judged(guard, now_s + HOLD_S).mode == "hybrid", why
    guard.note(Learned(why="far off", shadow=(0.0, 0.1, 0.0)), 0.1)
    verdict = judged(guard, 1e5)
    assert verdict.mode == "hybrid" and verdict.reasons == ["learned force shrunk: far off"]
    guard.note(Learned(weight=0.5, why="far off"), 0.1)
    assert judged(guard, 1e5).reasons == []
    guard.note(Learned(shadow=(0.1, 0.0, 0.0)), 0.1)
    assert judged(guard, 1e5).reasons == []
    guard.note(Learned(weight=1.0), 0.1, "the bound was broken")
    assert judged(guard, 1e5).reasons == ["learned force off: the bound was broken"]
    guard.note(Learned(weight=1.0), 0.1)
    assert judged(guard, 1e5 + HOLD_S - 0.1).mode == "physics only"
    assert judged(guard, 1e5 + HOLD_S).mode == "hybrid"


def test_a_force_at_its_bound_is_off_when_it_is_there_half_of_ten_seconds(guard):
    """Expected: the share fades over ten seconds, one long tick counts for half at most; off above a half only."""
    for k in range(68):  # 1 - 0.99^68 = 0.495
        guard.note(Learned(weight=1.0, clipped=True), 0.1)
        assert judged(guard, 0.1 * k).mode == "hybrid"
    guard.note(Learned(weight=1.0, clipped=True), 0.1)  # 0.500083
    assert judged(guard, 6.9).reasons == ["learned force off: the learned force stays at its bound"]
    guard.note(Learned(weight=1.0), 0.1)
    assert judged(guard, 6.9 + HOLD_S).mode == "hybrid"


def test_one_long_tick_counts_for_half_at_most(kvlcc2):
    guard = Guard(kvlcc2, learning(), hold_s=HOLD_S)
    guard.note(Learned(weight=1.0, clipped=True), 60.0)
    assert judged(guard, 0.0).mode == "hybrid"
    guard.note(Learned(weight=1.0, clipped=True), 60.0)
    assert judged(guard, 1.0).mode == "physics only"


def test_the_hold_is_three_ship_lengths_unless_it_is_given(kvlcc2):
    guard, long_s = Guard(kvlcc2, learning()), 3.0 * kvlcc2.L_pp / kvlcc2.U_0
    judged(guard, 0.0, doubts=["compass against gyro"])
    assert judged(guard, long_s - 0.1).mode == "physics only" and judged(guard, long_s + 0.1).mode == "hybrid"


def test_steps_in_the_channels_unit_and_a_set_clock_are_told_for_ten_seconds_eight_at_most(guard):
    said = judged(guard, 0.0, steps={"x": 200.0, "psi": radians(-12.5)}, clock_step_s=-1.2).reasons
    assert said == [
        "north_m stepped by 200 and stayed: the new value is believed",
        "heading_true_north_deg stepped by -12.5 and stayed: the new value is believed",
        "the wall clock was set by -1.2 s; the state is not touched",
    ]
    assert judged(guard, 9.9).reasons == said and judged(guard, 10.0).reasons == []
    for k in range(9):
        judged(guard, 20.0 + 0.1 * k, clock_step_s=1.0 + k)
    assert len(judged(guard, 21.0).reasons) == 8
    assert "+2.0 s" in judged(guard, 21.0).reasons[0]


def test_nothing_is_wrong_before_anything_was():
    assert LatchedFault(1e19).feed("", 0.0) == ""

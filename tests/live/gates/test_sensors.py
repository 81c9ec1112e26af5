"""What goes wrong with instruments, and what the twin then does: FAULTS by number, on a whole loop."""

from math import isfinite, nan

import pytest

from tests.thorough import one_of
from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.residual import bundled, load
from twin.live.signals.readings import Quality, Rejected

HEADING, NORTH, SURGE, YAW = "heading_true_north_deg", "north_m", "surge_velocity_mps", "yaw_rate_degps"


def only(name, change):
    """A fault of one channel: `change(reading, bridge)` gives what arrives instead (one reading, a list,
    or nothing)."""

    def alter(readings, bridge):
        out = []
        for r in readings:
            made = change(r, bridge) if r.channel == name else r
            out += made if isinstance(made, list) else [made] if made is not None else []
        return out

    return alter


def said(ticks, text):
    return [t for t in ticks if any(text in reason for reason in t.reasons)]


@pytest.mark.parametrize(
    "quality",
    (
        Quality.NOT_FINITE,
        Quality.OUT_OF_RANGE,
        Quality.NO_TIMESTAMP,
        Quality.SENTINEL,
        Quality.WRONG_TYPE,
        Quality.GARBAGE,
    ),
)
def test_I1_I2_I15_I16_I26_I27_a_refused_sample_is_counted_named_and_bridged(bridge, quality):
    """Test: the decoder refuses every heading for 1 s. Expected: counted, coded, said in words; the
    heading is predicted."""
    bridge.run(20.0)
    refused = lambda r, b: Rejected(r.channel, quality, "test", r.received_s, r.source)
    ticks = bridge.run(0.8, only(HEADING, refused))
    assert ticks[-1].rejected == 8
    assert ticks[0].quality.heading_true_north_deg == quality
    assert said(ticks[:1], HEADING)
    assert abs(bridge.error(HEADING)) < 0.3
    assert bridge.run(0.5)[-1].quality.heading_true_north_deg == Quality.OK


@pytest.mark.parametrize("value", (nan, float("inf"), 1e12))
def test_I1_I2_the_gate_itself_refuses_what_no_decoder_should_let_through(bridge, value):
    bridge.run(5.0)
    tick = bridge.run(0.1, only(SURGE, lambda r, b: r._replace(value=value)))[-1]
    assert tick.quality.surge_velocity_mps in (Quality.NOT_FINITE, Quality.OUT_OF_RANGE)
    assert isfinite(tick.estimate.surge_velocity_mps)


@pytest.mark.parametrize("name, jump", ((NORTH, 500.0), (HEADING, 90.0)))
def test_I3_a_jump_of_one_sample_is_refused(bridge, name, jump):
    """Test: +500 m or +90 deg once. Expected: refused at once, the estimate does not move."""
    bridge.run(20.0)
    tick = bridge.run(0.1, only(name, lambda r, b: r._replace(value=r.value + jump)))[-1]
    assert getattr(tick.quality, name) == Quality.JUMP
    assert abs(bridge.error(name)) < 1.0


def test_I4_a_step_that_lasts_is_refused_first_and_then_believed_and_announced(bridge):
    """Test: +200 m from now on. Expected: refused for a second, then an announced reset within 2 s."""
    bridge.run(20.0)
    step = only(NORTH, lambda r, b: r._replace(value=r.value + 200.0))
    first = bridge.run(1.0, step)
    assert all(t.quality.north_m == Quality.JUMP for t in first)
    assert abs(bridge.error(NORTH)) < 1.0
    later = bridge.run(1.0, step)
    assert said(later, "north_m stepped by")
    assert abs(bridge.error(NORTH) - 200.0) < 2.0


@pytest.mark.parametrize("name", (HEADING, NORTH, SURGE, YAW))
def test_I6_a_frozen_value_with_live_stamps_is_found_within_five_seconds(bridge, name):
    """Test: the last value again and again in a turn. Expected: refused as frozen within 5 s; learning
    stands still."""
    bridge.run(60.0)
    value = {}

    def freeze(r, b):
        value.setdefault("v", r.value)
        return r._replace(value=value["v"])

    ticks = bridge.run(5.2, only(name, freeze))
    assert getattr(ticks[-1].quality, name) == Quality.FROZEN
    assert said(ticks[-1:], "stays the same while the ship moves")
    assert getattr(bridge.run(0.5)[-1].quality, name) == Quality.OK


def test_I6_a_coarse_compass_on_a_straight_course_is_not_called_frozen(make_bridge):
    """Test: heading in steps of 0.1 deg, no rudder. Expected: never frozen."""
    bridge = make_bridge(helm_deg=lambda t: 10.0 if t < 40.0 else 0.0)
    coarse = only(HEADING, lambda r, b: r._replace(value=round(b.sailing.true()[HEADING], 1) % 360.0))
    ticks = bridge.run(90.0, coarse)
    assert not [t for t in ticks if t.quality.heading_true_north_deg == Quality.FROZEN]


def test_I7_the_same_message_again_and_again_grows_stale(bridge):
    """Test: one heading message republished. Expected: not used again; stale after ten of its periods."""
    bridge.run(20.0)
    kept = {}

    def again(r, b):
        return kept.setdefault("r", r)._replace(received_s=r.received_s)

    ticks = bridge.run(1.5, only(HEADING, again))
    assert ticks[-1].quality.heading_true_north_deg == Quality.STALE
    assert ticks[-1].mode == "dead reckoning"


def test_I8_a_lost_sensor_is_predicted_and_its_uncertainty_grows(bridge):
    """Test: the rate gyro falls silent. Expected: stale after ten periods, said; the estimate goes on."""
    bridge.run(60.0)
    sigma = bridge.ticks[-1].sigma.yaw_rate_degps
    ticks = bridge.run(3.0, only(YAW, lambda r, b: None))
    assert ticks[11].quality.yaw_rate_degps == Quality.STALE
    assert max(t.sigma.yaw_rate_degps for t in ticks) > sigma
    bridge.run(20.0, only(YAW, lambda r, b: None))
    assert abs(bridge.error(YAW)) < 0.02  # derived from the heading meanwhile


def test_I8_without_speed_over_ground_it_is_derived_from_positions(make_bridge):
    bridge = make_bridge()
    silent = lambda readings, b: [r for r in readings if "surge" not in r.channel and "sway" not in r.channel]
    ticks = bridge.run(120.0, silent)
    assert ticks[-1].mode == "physics only"
    assert not ticks[-1].measured.HasField(SURGE)
    assert abs(bridge.error(SURGE)) < 0.2 and abs(bridge.error("sway_velocity_mps")) < 0.2


def test_I8_a_rate_that_came_from_a_compass_is_lost_with_it(make_bridge):
    """Test: no gyro, hard over, and the compass lost in the turn, which then ends. Expected: the rate of the
    moment in which it was lost is no measurement; the model carries the heading."""
    turned = make_bridge(helm_deg=lambda t: 20.0 if t < 60.0 else 0.0)
    no_gyro = lambda readings, b: [r for r in readings if r.channel != YAW]
    turned.run(60.0, no_gyro)
    turned.run(150.0, lambda readings, b: [r for r in no_gyro(readings, b) if r.channel != HEADING])
    assert "r" not in turned.loop.last.measured.si
    assert abs(turned.error(YAW)) < 0.05 and abs(turned.error(HEADING)) < 8.0


def test_I9_without_any_sensor_the_model_runs_on_and_then_nothing_is_promised(bridge):
    """Test: everything silent. Expected: dead reckoning when the channels are stale, invalid after 60 s."""
    bridge.run(30.0)
    ticks = bridge.run(65.0, lambda readings, b: [])
    modes = [t.mode for t in ticks]
    assert modes[15] == "dead reckoning" and modes[-1] == "invalid"
    assert ticks[-1].sigma.north_m > 15.0
    assert all(isfinite(t.estimate.north_m) for t in ticks)
    assert not ticks[-1].predictions
    assert bridge.run(1.0)[-1].mode == "physics only"


def test_I10_half_of_the_samples_lost_is_said_within_five_seconds(bridge):
    bridge.run(20.0)
    ticks = bridge.run(6.0, only(HEADING, lambda r, b: r if b.number % 3 == 0 else None))
    assert said(ticks[:-5], "samples are lost")


def test_I11_samples_out_of_order_are_refused(bridge):
    """Test: two headings swapped in time. Expected: the later one is used, the earlier refused."""
    bridge.run(20.0)
    late = {}

    def swap(r, b):
        if b.number % 2 == 0:
            late["r"] = r
            return None
        return [r, late["r"]._replace(received_s=r.received_s)]

    ticks = bridge.run(2.0, only(HEADING, swap))
    assert ticks[-1].rejected == 10
    assert abs(bridge.error(HEADING)) < 0.2


def test_I12_a_doubled_message_is_dropped_without_a_word(bridge):
    bridge.run(20.0)
    ticks = bridge.run(2.0, only(HEADING, lambda r, b: [r, r]))
    assert ticks[-1].quality.heading_true_north_deg == Quality.OK
    assert not said(ticks, HEADING)


@pytest.mark.parametrize(
    "shift, quality", ((-3.0, Quality.OLD), (3600.0, Quality.FUTURE), (-3600.0, Quality.OLD))
)
def test_I13_I14_stamps_far_from_now_are_refused(bridge, shift, quality):
    bridge.run(10.0)
    ticks = bridge.run(0.5, only(HEADING, lambda r, b: r._replace(time_s=r.time_s + shift)))
    assert ticks[-1].quality.heading_true_north_deg == quality


def test_I13_samples_older_than_their_channel_may_be_are_of_no_use_and_do_no_harm(bridge):
    """Test: every channel suddenly 1.5 s late (its ten periods are 1 s). Expected: stale, dead reckoning,
    no crash; back again."""
    bridge.run(20.0)
    late = []

    def delayed(readings, b):
        late.append(readings)
        return [r._replace(received_s=b.now_s) for r in late[-16]] if len(late) > 15 else []

    ticks = bridge.run(6.0, delayed)
    assert ticks[-1].mode == "dead reckoning" and ticks[-1].quality.heading_true_north_deg == Quality.STALE
    assert bridge.run(2.0)[-1].mode == "physics only"


@pytest.mark.parametrize(
    "factor, word",
    ((57.2958, "degrees where radians"), (0.0174533, "radians where degrees"), (-1.0, "wrong sign")),
)
def test_I17_I18_a_yaw_rate_in_the_wrong_unit_or_sign_is_named(bridge, factor, word):
    """Test: the rate of turn times 57.3, over 57.3, or negated. Expected: said within two ship lengths of
    turning."""
    ticks = bridge.run(
        160.0, only(YAW, lambda r, b: r._replace(value=max(min(r.value * factor, 89.0), -89.0)))
    )
    assert said(ticks, word)
    assert all(isfinite(t.estimate.yaw_rate_degps) for t in ticks)


def test_I17_a_speed_in_knots_is_named(bridge):
    def knots(readings, b):
        return [r._replace(value=r.value * 1.943844) if "velocity" in r.channel else r for r in readings]

    assert said(bridge.run(150.0, knots), "is in knots")


def test_I18_a_rudder_of_the_wrong_sign_is_named(bridge):
    ticks = bridge.run(300.0, only("rudder_angle_deg", lambda r, b: r._replace(value=-r.value)))
    assert said(ticks, "against its rudder")


def test_I19_the_heading_runs_through_north_without_a_jump(make_bridge):
    """Test: a turn through north. Expected: no refusal, no error at the seam."""
    bridge = make_bridge(helm_deg=lambda t: 30.0, heading_deg=352.0)
    worst = 0.0
    for _ in range(80):
        bridge.run(1.0)
        worst = max(worst, abs(bridge.error(HEADING)))
    assert bridge.ticks[-1].rejected == 0 and worst < 0.3
    assert max(t.estimate.heading_true_north_deg for t in bridge.ticks) > 355.0
    assert min(t.estimate.heading_true_north_deg for t in bridge.ticks) < 5.0


def test_I8_a_sensor_silent_for_hours_is_only_stale(bridge):
    """Test: the rate gyro falls silent, and two hours pass. Expected: the gates go on; nothing is raised."""
    bridge.run(60.0)
    gates = bridge.loop.sensors.gates
    late_s = bridge.now_s + 7200.0
    assert any(gate.losing(late_s) for gate in gates.values())
    bridge.run(1.0, only(YAW, lambda r, b: None))
    bridge.now_s = late_s
    assert isfinite(bridge.run(1.0, only(YAW, lambda r, b: None))[-1].estimate.yaw_rate_degps)


@pytest.mark.parametrize("name", one_of((HEADING, SURGE, YAW)))
def test_I6_of_a_reading_that_is_stuck_for_minutes_nothing_is_learned(kvlcc2, make_bridge, name):
    """Test: a zigzag with learning on, then one instrument says the same for three minutes. Expected:
    learning stands still after five seconds, and what they taught moved no number by a hundredth."""
    learned = LearnedForce(kvlcc2, load(bundled(kvlcc2), kvlcc2))
    bridge = make_bridge(loop={"learned": learned})
    bridge.run(400.0)
    adaptation, value = learned.adaptation, {}
    before, updates = adaptation.numbers(), adaptation.updates
    bridge.run(180.0, only(name, lambda r, b: r._replace(value=value.setdefault("v", r.value))))
    assert updates > 500 and adaptation.updates - updates < 55
    moved = [
        abs(a - b)
        for new, old in zip(adaptation.numbers(), before, strict=True)
        for a, b in zip(new, old, strict=True)
    ]
    assert max(moved) < 0.01

"""The whole tick on a ship that sails: it follows, it says known and learned apart, it never says a number
that is none."""

from math import hypot, isfinite, radians

import pytest

from twin.live.clock import Instant
from twin.live.signals.readings import Reading


def test_the_estimate_follows_a_zigzag_closer_than_the_instruments_say(bridge):
    bridge.run(60.0)
    errors = {
        name: [] for name in ("north_m", "heading_true_north_deg", "surge_velocity_mps", "yaw_rate_degps")
    }
    for _ in range(600):
        bridge.run(0.1)
        for name, found in errors.items():
            found.append(bridge.error(name))
    rms = {name: (sum(e * e for e in found) / len(found)) ** 0.5 for name, found in errors.items()}
    assert rms["north_m"] < 0.3 and rms["heading_true_north_deg"] < 0.05
    assert rms["surge_velocity_mps"] < 0.03 and rms["yaw_rate_degps"] < 0.003


def test_a_clean_voyage_gives_no_alarm(bridge):
    ticks = bridge.run(300.0)
    assert {tick.mode for tick in ticks} == {"physics only"}
    assert {reason for tick in ticks for reason in tick.reasons} == {"no learned force: none in this test"}
    assert ticks[-1].rejected == 0


def test_known_forces_are_said_by_name_and_apart_from_the_learned_one(bridge):
    tick = bridge.run(5.0)[-1]
    assert [force.name for force in tick.known] == ["hull", "coriolis", "propeller", "rudder"]
    assert tick.learned.X_N == tick.learned.Y_N == tick.learned.N_Nm == 0.0


def test_before_anything_is_measured_the_twin_says_what_it_waits_for(make_bridge):
    bridge = make_bridge()
    tick = bridge.run(0.1, lambda readings, _: [])[-1]
    assert tick.mode == "starting" and "heading" in tick.reasons[0]
    assert not tick.estimate.HasField("north_m")


def test_C2_a_stall_of_200_ms_is_counted_and_not_made_up(bridge):
    bridge.run(20.0)
    bridge.now_s += 0.2
    for _ in range(2):
        bridge.sailing.advance()
    tick = bridge.run(0.1, skipped=2)[-1]
    assert tick.overruns == 2
    bridge.run(2.0)
    assert abs(bridge.error("heading_true_north_deg")) < 0.2 and abs(bridge.error("north_m")) < 1.0


def test_C10_after_ten_seconds_of_suspension_the_estimate_begins_anew(bridge):
    bridge.run(20.0)
    bridge.now_s += 10.0
    for _ in range(100):
        bridge.sailing.advance()
    bridge.run(0.1)
    assert bridge.loop.observer.restarts == 1
    bridge.run(1.0)
    assert abs(bridge.error("north_m")) < 2.0


@pytest.mark.parametrize("step_s", (3600.0, -7200.0))
def test_C9_the_wall_clock_may_be_set_without_touching_the_state(make_bridge, step_s):
    plain, stepped = make_bridge(), make_bridge()
    for bridge in (plain, stepped):
        bridge.run(30.0)
    stepped.wall_less_mono += step_s
    one = plain.run(20.0)
    other = stepped.run(20.0)
    assert any("wall clock was set" in reason for reason in other[0].reasons)
    assert [t.estimate for t in one] == [t.estimate for t in other]
    assert other[-1].rejected == 0


def test_sources_whose_clock_steps_too_are_still_heard(make_bridge):
    bridge = make_bridge()
    bridge.run(30.0)
    bridge.wall_less_mono += 3600.0
    late = lambda readings, _: [r._replace(time_s=r.time_s + 3600.0) for r in readings]
    assert bridge.run(10.0, late)[-1].rejected == 0


def test_the_same_messages_give_the_same_bytes(make_bridge):
    one, other = make_bridge().run(30.0), make_bridge().run(30.0)
    assert [t.SerializeToString(deterministic=True) for t in one] == [
        t.SerializeToString(deterministic=True) for t in other
    ]


def test_nothing_that_is_not_finite_is_ever_said(bridge, numbers):
    def wild(readings, bridge):
        value = float(bridge.sailing.random.choice([1e300, -1e300, 1e9, 0.0, 359.99, -359.0]))
        return [Reading(r.channel, value, r.time_s, r.received_s, r.source) for r in readings]

    bridge.run(5.0)
    for tick in bridge.run(10.0, wild):
        assert all(isfinite(x) for _, x in numbers(tick))


def test_the_parts_can_be_timed(bridge):
    parts = bridge.loop.measure_parts()
    bridge.run(2.0)
    assert set(parts.ns) >= {
        "read",
        "sensors",
        "correct",
        "known",
        "learned",
        "adapt",
        "predict",
        "publish",
        "record",
        "tick",
    }
    assert len(parts.ns["tick"]) == 20 and min(parts.ns["tick"]) > 0


def test_a_tick_holds_its_time_and_its_pace(bridge):
    tick = bridge.loop.tick(Instant(7, 50.0, 1.7e9 + 50.0))
    assert (tick.index, tick.time_s, tick.wall_s, tick.rate_hz) == (7, 50.0, 1.7e9 + 50.0, 10.0)
    assert not tick.HasField("slack_us")  # no clock measured it


def test_a_known_fault_of_an_instrument_is_taken_off(kvlcc2, make_bridge):
    """Test: a compass 3 deg off and a log 0.4 m/s off, both in the ship file. Expected: the estimate knows
    better; the log of what was measured does not."""
    from twin.physics.effects import find

    ship = kvlcc2.with_effects(find("HeadingBias")(bias=radians(3.0)), find("SpeedLogBias")(bias=0.4))
    bridge = make_bridge(ship=ship, noise=0.2)

    def wrong(readings, b):
        out = []
        for r in readings:
            out.append(
                r._replace(value=(r.value + 3.0) % 360.0) if r.channel == "heading_true_north_deg" else r
            )
            if r.channel == "surge_velocity_mps":
                out.append(r._replace(channel="surge_velocity_through_water_mps", value=r.value + 0.4))
        return out

    tick = bridge.run(60.0, wrong)[-1]
    assert abs(bridge.error("heading_true_north_deg")) < 0.1
    assert hypot(tick.estimate.current_north_mps, tick.estimate.current_east_mps) < 0.05
    gap = tick.measured.heading_true_north_deg - bridge.truth["heading_true_north_deg"]
    assert gap % 360.0 > 2.5

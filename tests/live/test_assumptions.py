"""The assumptions of the certificate are watched: each is broken here on the loop that the service builds."""

from copy import deepcopy
from math import hypot

import pytest

from tests.thorough import one_of
from twin.live.build import saturation_of
from twin.live.certificate.certificate import certify
from twin.live.certificate.observer_tube import NOTHING, Tube
from twin.live.keelson import messages
from twin.live.learning.residual import bundled
from twin.live.learning.residual import load as load_residual
from twin.live.observer.estimate import Estimate
from twin.live.parity import POSITION_M, WINDOW_S, Parity
from twin.live.signals.measured import Measured
from twin.physics.model import Model


def off_by(**more):
    """Instruments that say too much, by channel."""
    return lambda readings, bridge: [r._replace(value=r.value + more.get(r.channel, 0.0)) for r in readings]


def why(bridge):
    return bridge.loop.stabilizer.outside or ""


def errors(bridge):
    e, true = bridge.loop.observer.estimate, bridge.sailing.state[3:]
    return [abs(a - b) for a, b in zip((e.u, e.v, e.r), true, strict=True)]


def every(bridge, steps, count):
    """Ticks that come each so many tenths of a second; the ticks."""
    made = []
    for _ in range(count):
        made += bridge.run(0.1)
        for _ in range(steps - 1):
            bridge.sailing.advance()
        bridge.now_s += 0.1 * (steps - 1)
    return made


@pytest.mark.parametrize("steps", one_of((10, 2, 3, 5, 30), 2))
def test_A5_late_ticks_widen_the_bound_and_count_no_measurement(make_service, steps):
    """Test: ticks each 0.2 to 3 s where 0.105 s are certified. Expected: the first widens the bound by more
    than a usual tick could; while they last the bound grows beyond the usual one, until it is what the
    instruments leave open, and no error leaves it; the usual one is back a minute later."""
    bridge, widest = make_service(), 0.0
    usual = bridge.run(60.0)[-1].certificate.bound
    every(bridge, steps, 1)
    first = bridge.run(0.1)[-1].certificate
    # 3 s carry the bound so far that it says nothing, and it begins anew from the samples of that tick
    assert first.bound > usual or not first.inside or steps == 30
    for _ in range(60):
        tick = every(bridge, steps, 1)[-1]
        e, true = tick.estimate, bridge.truth
        off = hypot(
            e.surge_velocity_mps - true["surge_velocity_mps"], e.sway_velocity_mps - true["sway_velocity_mps"]
        )
        widest = max(widest, tick.certificate.bound)
        assert off <= tick.certificate.bound or not tick.certificate.inside
    assert widest > 1.1 * usual
    after = bridge.run(90.0)[-1].certificate
    assert after.inside and after.bound == pytest.approx(usual, rel=0.25)


def test_A5_a_tick_beyond_the_table_begins_the_bound_anew_and_says_why(make_service):
    """Test: one tick 3.4 s late. Expected: no promise in it, the reason on the bus with both periods."""
    bridge = make_service()
    bridge.run(30.0)
    for _ in range(33):
        bridge.sailing.advance()
    bridge.now_s += 3.3
    tick = bridge.run(0.1)[-1]
    assert not tick.certificate.inside and any(
        "certificate: the tick came late, after = 3.4 s where 0.1" in text for text in tick.reasons
    )
    assert bridge.run(20.0)[-1].certificate.inside


def test_A5_a_tick_of_many_periods_is_bounded_as_at_least_as_many_single_ones(kvlcc2):
    """Expected: E over j h in one step is at least what j steps without a measurement give, and not twice as
    much."""
    c = certify(Model.of(kvlcc2), 0.3, 0.1)
    for periods in (2, 3, 5, 10):
        one, many = Tube(c), Tube(c)
        for _ in range(periods):
            one.step((False, False, False))
        many.step((True, True, True), dt=0.1 * periods)
        assert all(a <= b * (1 + 1e-9) < 2.0 * a for a, b in zip(one.beta, many.beta, strict=True))


def test_A5_a_short_tick_pulls_by_less_and_the_bound_knows(kvlcc2):
    """Test: a thousand ticks of half a period, all measured. Expected: the bound settles above that of whole
    periods."""
    c = certify(Model.of(kvlcc2), 0.3, 0.1)
    whole, half = Tube(c), Tube(c)
    for _ in range(1000):
        whole.step((True, True, True))
        half.step((True, True, True), dt=0.05)
    assert all(a < b for a, b in zip(whole.beta, half.beta, strict=True))


def test_A3_without_a_wave_height_there_is_no_promise_and_the_reason_says_so(make_service):
    """Test: a ship without a wave sensor. Expected: no promise in any tick, the reason on the bus; with a
    sensor it is given."""
    silent = make_service(H_s=None).run(20.0)
    assert (
        not any(t.certificate.inside for t in silent) and "certificate: no wave height" in silent[-1].reasons
    )
    assert make_service().run(20.0)[-1].certificate.inside


def test_A4_a_speed_that_is_off_for_good_is_found_by_the_positions(make_service):
    """Test: the log walks off by 1 m/s and stays there, in small steps, so that no gate sees it. Expected:
    innovations say nothing; within two minutes of being off by more than the bound the promise is taken back,
    and the positions are the reason."""
    bridge, wrong = make_service(), 0
    assert bridge.run(120.0)[-1].certificate.inside
    for k in range(3000):
        tick = bridge.run(0.1, off_by(surge_velocity_mps=min(k / 600.0, 1.0)))[-1]
        wrong += tick.certificate.inside and errors(bridge)[0] > bridge.loop.stabilizer.tube.beta[0]
    assert not tick.certificate.inside and not bridge.loop.stabilizer.broken
    assert why(bridge).startswith("positions against ") and any(why(bridge) in text for text in tick.reasons)
    assert wrong < 1200, wrong
    assert bridge.run(180.0)[-1].certificate.inside


def test_A4_a_rate_of_turn_that_is_off_for_good_is_not_promised_upon(make_service):
    """Test: the gyro walks off by 0.5 deg/s in a minute. Expected: no tick says that its bound holds while
    the rate of turn is beyond it for longer than the minute that the headings take."""
    bridge, wrong = make_service(), 0
    assert bridge.run(120.0)[-1].certificate.inside
    for k in range(2400):
        tick = bridge.run(0.1, off_by(yaw_rate_degps=min(k / 600.0, 1.0) * 0.5))[-1]
        wrong += tick.certificate.inside and errors(bridge)[2] > bridge.loop.stabilizer.tube.beta[2]
    assert not tick.certificate.inside and wrong < 600, wrong


def test_A4_headings_tell_of_a_rate_of_turn_by_hand():
    """Test: a ship that holds its heading, estimated to turn, with beta_r = 0.001 rad/s. Expected: named from
    0.001 + 2 n_psi/T on."""
    for r, found in ((0.00110, False), (0.00125, True)):
        parity, e = Parity(0.005), Estimate(r=r, ready=True)
        for k in range(900):
            m = Measured(0.1 * k, {"psi": 1.0}, {"psi": 0.1})
            m.time = {"psi": 0.1 * k}
            parity.feed(m, e, (0.1, 0.1, 0.001), 0.1 if k else 0.0)
        assert bool(parity.why) is found and ("headings against" in parity.why) is found


def test_A4_what_the_instruments_contradict_each_other_in_takes_the_promise_back(make_service):
    """Test: the rate of turn comes in degrees a minute. Expected: once that is named, the same words are the
    certificate's reason."""
    bridge = make_service()
    bridge.run(60.0)
    wrong = lambda readings, b: [
        r._replace(value=-r.value) if r.channel == "yaw_rate_degps" else r for r in readings
    ]
    named = [
        t
        for t in bridge.run(400.0, wrong)
        if any(text.startswith("yaw_rate_degps against the turning heading") for text in t.reasons)
    ]
    assert named and not any(t.certificate.inside for t in named)
    assert any("certificate: yaw_rate_degps against" in text for text in named[-1].reasons)


def test_healthy_instruments_are_not_suspected_by_the_positions_or_headings(make_service):
    """Test: ten minutes of zigzag with a usual receiver's noise. Expected: a promise in every tick after the
    first minute."""
    bridge = make_service()
    bridge.run(60.0)
    assert all(t.certificate.inside for t in bridge.run(540.0))


def test_the_limit_of_the_positions_is_by_hand():
    """Test: a ship that lies at u = 2 m/s, beta (0.1, 0, 0), measured to sail at 2.0 + x. Expected: named
    from 0.1 + 2 n_eta/T on, for x ahead."""
    for x, found in (
        (0.1 + 2.0 * POSITION_M / WINDOW_S - 0.02, False),
        (0.1 + 2.0 * POSITION_M / (WINDOW_S - 5.0) + 0.02, True),
    ):
        parity, e = Parity(0.0), Estimate(u=2.0, ready=True)
        for k in range(900):
            m = Measured(
                0.1 * k, {"x": (2.0 + x) * 0.1 * k, "y": 0.0, "psi": 0.0}, {"x": 0.1, "y": 0.1, "psi": 0.1}
            )
            m.time = {"x": 0.1 * k, "psi": 0.1 * k}
            parity.feed(m, e, (0.1, 0.0, 0.0), 0.1 if k else 0.0)
        assert bool(parity.why) is found


def test_the_learned_force_is_in_the_disturbance_while_it_acts_and_only_then(make_service, kvlcc2):
    """Expected: D = what physics may miss + what the learned force can reach; the bound is smaller with
    physics only."""
    bridge = make_service()
    c = bridge.loop.stabilizer.tube.certificate
    assert c.saturation == saturation_of(load_residual(bundled(kvlcc2), kvlcc2)) and min(c.saturation) > 0.0
    hybrid = bridge.run(60.0)[-1]
    alone = make_service(settings={"residual.file": "none", "observer.certificate": ""})
    assert hybrid.mode == "hybrid" and hybrid.certificate.bound > 1.05 * alone.run(60.0)[-1].certificate.bound
    acts, rests = Tube(c), Tube(c)
    for _ in range(2000):
        acts.step((True, True, True), acts=True)
        rests.step((True, True, True), acts=False)
    assert all(a > 1.05 * b for a, b in zip(acts.beta, rests.beta, strict=True))


def test_the_estimated_headings_error_is_a_fourth_state(make_service):
    """Expected: in the settled loop it is more than the compass's own and near n_psi + b_r/K; without a
    heading it grows."""
    bridge = make_service()
    bridge.run(120.0)
    tube = bridge.loop.stabilizer.tube
    c, settled = tube.certificate, tube.psi
    assert c.estimated_heading and c.heading_noise + tube.beta[2] / c.K[2] < 1.05 * settled < 1.6 * (
        c.heading_noise + tube.beta[2] / c.K[2]
    )
    deaf = deepcopy(tube)
    for _ in range(100):
        tube.step((True, True, True))
        deaf.step((True, True, True), heading=False)
    assert deaf.psi > 2.0 * tube.psi and all(a > b for a, b in zip(deaf.beta, tube.beta, strict=True))


def test_what_a_late_measurement_looks_back_on_outlives_a_fresh_start_of_the_bound(kvlcc2):
    c = certify(Model.of(kvlcc2), 0.3, 0.1, delay_samples=5)
    tube = Tube(c)
    for _ in range(600):
        tube.step((False, False, False))
    far = tube.widest
    tube.reset(c.noise)
    assert tube.beta == c.noise
    tube.step((True, True, True))
    assert tube.widest == far
    for _ in range(tube.window):
        tube.step((True, True, True))
    assert all(a < b < NOTHING for a, b in zip(tube.widest, far, strict=True))


def test_the_bound_of_yaw_and_the_margin_of_one_sample_are_said(make_service):
    tick = make_service().run(60.0)[-1]
    assert (
        0.0 < tick.certificate.yaw_bound_degps < 0.3
        and 0.0 < tick.certificate.step_margin < 0.1 < tick.certificate.margin
    )


def test_a_log_from_before_these_numbers_is_still_read():
    """Expected: what an old tick did not say is 0."""
    old = messages.Tick()
    old.certificate.margin, old.certificate.bound, old.certificate.inside = 0.7, 0.3, True
    found = messages.Tick.FromString(old.SerializeToString())
    assert (
        found.certificate.inside and found.certificate.yaw_bound_degps == found.certificate.step_margin == 0.0
    )

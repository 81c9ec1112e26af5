"""Samples that correct the estimate of their own time, and what is promised of it."""

from dataclasses import replace
from math import degrees, hypot

import pytest

from twin.live.certificate.certificate import Certificate, certify, on_board
from twin.live.certificate.rolled import radius
from twin.live.certificate.rolled_tube import RolledTube
from twin.live.observer.dynamics import KnownDynamics
from twin.live.observer.observer import Observer
from twin.live.observer.rollback import FULL_GAIN, Path, Pull, RollBack, Stretch, inner_steps
from twin.live.signals.measured import Measured
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Force, Situation

NONE = Force(0.0, 0.0, 0.0)
INPUTS = {"delta": 0.15, "n": 12.0}


def truth(boat, seconds):
    """(t, state) every hundredth of a second of a boat under constant helm, from a straight run."""
    model, state, sailed = Model.of(boat), (0.0, 0.0, 0.3, 1.2, 0.0, 0.0), []
    for k in range(round(100 * seconds) + 1):
        sailed.append((0.01 * k, state))
        state = model.step(state, Situation(**INPUTS), 0.01)
    return sailed


def fed(observer, boat, at, samples):
    """One tick at time `at`; samples: state -> (time, value)."""
    m = Measured(at, {"psi": 0.3, "u": 1.2} | INPUTS)
    for name, (time_s, value) in samples.items():
        m.si[name], m.fresh[name], m.time[name] = value, 0.1, time_s
        m.heard[name], m.hold_s[name] = at, 0.12
    estimate = observer.correct(m)
    s = Situation(*estimate.state(), t=at, **INPUTS)
    observer.remember(KnownDynamics(Model.of(boat)), s, NONE)
    return estimate


@pytest.fixture(scope="module")
def boat():
    return load("usv")


@pytest.fixture(scope="module")
def of_boat(boat):
    return certify(Model.of(boat), None, 0.105, **on_board(boat, 1, False, (0.0, 0.0, 0.0), 10))


def test_only_a_ship_that_is_fast_for_her_loop_is_stepped_within_a_period(boat):
    assert [inner_steps(load(s), 0.1) for s in ("kvlcc2", "container", "kvlcc2_model", "usv")] == [
        1,
        1,
        3,
        10,
    ]
    assert inner_steps(boat, 0.02) == 1


def test_a_late_sample_leaves_the_same_estimate_as_one_in_time_that_the_model_ran_on_from(boat):
    """Test: the same sample of u, r once at its own tick and once a tick late. Expected: from then on the same
    estimate, to rounding."""
    sailed, ends = {round(t, 2): x for t, x in truth(boat, 0.6)}, []
    for late in (0.0, 0.1):
        observer = RollBack(boat, 0.0105)
        fed(observer, boat, 0.0, {"psi": (0.0, 0.3), "u": (0.0, 1.2), "r": (0.0, 0.0), "v": (0.0, 0.0)})
        for k in range(1, 6):
            now, said = 0.1 * k, {}
            if k == 3 + round(10 * late):
                said = {"u": (0.3, sailed[0.3][3] + 0.05), "r": (0.3, sailed[0.3][5] - 0.02)}
            fed(observer, boat, now, said)
        ends.append(observer.estimate.state())
    assert ends[1] == pytest.approx(ends[0], rel=1e-9, abs=1e-12)


def test_without_samples_the_inner_steps_follow_the_true_boat_closer_than_one_step_does(boat):
    sailed, off = truth(boat, 1.0)[-1][1], []
    for observer in (RollBack(boat, 0.0105), Observer(boat)):
        fed(observer, boat, 0.0, {"psi": (0.0, 0.3), "u": (0.0, 1.2), "v": (0.0, 0.0), "r": (0.0, 0.0)})
        for k in range(1, 11):
            e = observer.estimate
            s = Situation(*e.state(), **INPUTS)
            physics = KnownDynamics(Model.of(boat))
            observer.steer(physics.mean_rates(s, physics.forces(s), NONE, 0.1))
            fed(observer, boat, 0.1 * k, {})
        off.append(abs(observer.estimate.r - sailed[5]))
    assert off[0] < 0.3 * off[1] and off[0] < 1e-3


def test_a_sample_is_answered_once_and_by_its_share(boat):
    """Test: one sample of u that is 0.02 m/s more. Expected: the estimate moves by 0.8 of it in that tick,
    and by nothing in the next, beyond what the model does."""
    quiet, pulled = RollBack(boat, 0.0105), RollBack(boat, 0.0105)
    for observer, more in ((quiet, None), (pulled, 0.02)):
        fed(observer, boat, 0.0, {"psi": (0.0, 0.3), "u": (0.0, 1.2), "v": (0.0, 0.0), "r": (0.0, 0.0)})
        said = {} if more is None else {"u": (0.1, quiet.estimate.u + more)}
        fed(observer, boat, 0.1, said)
    assert pulled.estimate.u - quiet.estimate.u == pytest.approx(FULL_GAIN * 0.02, rel=1e-9)
    fed(quiet, boat, 0.2, {})
    fed(pulled, boat, 0.2, {})
    assert 0.0 < pulled.estimate.u - quiet.estimate.u < FULL_GAIN * 0.02


def test_the_boat_at_ten_ticks_a_second_has_a_certificate_as_narrow_as_at_fifty(of_boat):
    """Expected: the bound of docs/stability.md at 50 Hz (0.12, 0.15 m/s, 14 deg/s) is kept."""
    u, v, r = of_boat.bound
    assert of_boat.ok and u < 0.12 and v < 0.15 and degrees(r) < 14.0
    assert of_boat.step_margin == pytest.approx(1.0 - radius(of_boat.G)) and of_boat.step_margin > 0.5
    assert Certificate.from_json(of_boat.to_json()) == of_boat


def test_a_promise_that_does_not_follow_is_not_believed(of_boat):
    assert of_boat.follows() and not replace(of_boat, inner=5).follows()


def test_the_tube_settles_at_the_bound_of_the_certificate(of_boat):
    """Test: every axis sampled once a period, a period late. Expected: outside the set, where nothing better is
    known, E of the theorem; at sea speed less than half of it in yaw, by the slopes and the damping there."""
    state, full = (0.0,) * 6, [Pull(i, True, 0.0) for i in (2, 3, 4, 5)]

    def settled(u):
        tube, now, still = RolledTube(of_boat), 0.0, [(u, 0.0, 0.0, 0.0)] * 10
        for _ in range(200):
            then, now = now, now + of_boat.h
            way = [Stretch(then, [], full, state), Stretch(now, still, [], state)]
            beta = tube.follow(Path(then, state, way), 0.0, True)
        return beta, tube.left

    whole, left = settled(9.0)
    assert left and whole == pytest.approx(of_boat.bound, rel=1e-6)
    (u, v, r), left = settled(1.2)
    assert not left and u < 0.75 * whole[0] and v < 0.7 * whole[1] and r < 0.45 * whole[2]


def test_a_sample_that_does_not_count_widens_the_bound_by_what_it_moved(of_boat):
    tube, state = RolledTube(of_boat, (0.1, 0.1, 0.05)), (0.0,) * 6
    tube.follow(Path(0.0, state, [Stretch(0.0, [], [Pull(3, False, 0.03)], state)]))
    assert tube.beta == pytest.approx((0.13, 0.1, 0.05))


def test_what_drove_the_model_before_its_first_estimate_is_not_kept(make_service):
    """Test: a boat at its berth, every instrument off. Expected: no memory of the ticks that pass."""
    bridge = make_service("usv")
    bridge.run(60.0, lambda readings, bridge: [])
    assert isinstance(bridge.loop.observer, RollBack) and len(bridge.loop.observer._drives) == 1


def test_the_boats_own_loop_promises_at_ten_ticks_a_second_and_keeps_it(make_service):
    """Test: the loop that the service builds on the bundled boat with the usual settings. Expected: it promises
    for most of a gentle run, and no tick's error is beyond what it promised."""
    bridge, promised = make_service("usv", helm_deg=lambda t: 2.0, noise=0.3), 0
    bridge.run(10.0)
    for _ in range(300):
        tick = bridge.run(0.1)[-1]
        e, (u, v, r) = bridge.loop.observer.estimate, bridge.sailing.state[3:]
        beta = bridge.loop.stabilizer.tube.beta
        if tick.certificate.inside:
            promised += 1
            assert hypot(e.u - u, e.v - v) <= tick.certificate.bound
            assert all(abs(a - b) <= c for a, b, c in zip((e.u, e.v, e.r), (u, v, r), beta, strict=True))
    assert isinstance(bridge.loop.observer, RollBack) and promised > 200, promised

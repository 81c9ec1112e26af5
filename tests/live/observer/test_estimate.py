"""The observer on its own: gain, late samples, missing channels, the current, and what it says of its own
doubt."""

from math import hypot, pi, radians

import pytest

from twin.live.observer.estimate import A_MAX, CurrentFilter, Estimate, gain_for
from twin.live.observer.observer import Observer
from twin.live.signals.measured import Measured
from twin.physics.ship import load
from twin.physics.state import Rates


def measured(now_s, si, fresh=None, age_s=0.0, hold_s=0.12):
    m = Measured(now_s, dict(si))
    for a in si:
        m.time[a], m.heard[a], m.hold_s[a] = now_s - age_s, now_s, hold_s
    m.fresh = dict.fromkeys(si, 0.1) if fresh is None else fresh
    return m


START = {"x": 0.0, "y": 0.0, "psi": 0.0, "u": 5.0, "v": 0.0, "r": 0.0}


def test_the_gain_is_the_ships_own_time(kvlcc2):
    assert gain_for(kvlcc2) == pytest.approx(0.3, abs=0.01)
    assert gain_for(load("usv")) > 1.0


def test_a_constant_error_fades_by_K(kvlcc2):
    """nu 0.02 m/s off for 1/K seconds: 1/e of it is left."""
    observer = Observer(kvlcc2, gain=0.3)
    observer.correct(measured(0.0, START))
    observer.estimate.u = 5.02
    k = 0
    while k * 0.1 < 1.0 / 0.3:
        k += 1
        observer.correct(measured(0.1 * k, {**START, "x": observer.estimate.x}))
    assert observer.estimate.u - 5.0 == pytest.approx(0.02 / 2.718, rel=0.05)


def test_a_late_sample_is_compared_with_its_own_time(kvlcc2):
    """Accelerating at 0.1 m/s2, measured exactly but 1 s late: no innovation."""
    observer = Observer(kvlcc2, gain=0.3)
    observer.correct(measured(0.0, START))
    observer.steer(Rates(0.1, 0.0, 0.0))
    for k in range(1, 40):
        then = max(0.1 * k - 1.0, 0.0)
        e = observer.correct(measured(0.1 * k, {"psi": 0.0, "u": 5.0 + 0.1 * then}, age_s=0.1 * k - then))
        observer.steer(Rates(0.1, 0.0, 0.0))
    assert e.u == pytest.approx(5.0 + 0.1 * 3.9, abs=1e-7)


def test_a_slow_sensor_pulls_until_its_next_sample_and_no_longer(kvlcc2):
    observer = Observer(kvlcc2, gain=0.3)
    observer.correct(measured(0.0, START))
    sample = measured(0.1, {**START, "u": 5.05}, hold_s=1.0)
    pulled = []
    for k in range(1, 31):
        m = measured(0.1 * k, START, fresh={"u": 1.0} if k == 1 else {}, hold_s=1.0)
        m.si["u"], m.time["u"], m.heard["u"] = 5.05, sample.time["u"], sample.heard["u"]
        observer.correct(m)
        pulled.append(observer.received["u"])
    assert pulled[:11] == [True] * 11 and not any(pulled[11:])


def test_a_very_late_or_slow_sensor_pulls_less_than_K(kvlcc2):
    observer = Observer(kvlcc2, gain=9.0)
    observer.correct(measured(0.0, START))
    observer.correct(measured(0.1, {**START, "u": 5.1}, hold_s=1.0))
    assert 0.0 < observer.estimate.u - 5.0 < 0.1 * 0.07
    assert A_MAX <= 0.5


def test_an_outlier_pulls_no_more_than_four_usual_deviations_and_is_not_counted_as_received(kvlcc2):
    observer = Observer(kvlcc2, gain=0.3)
    observer.correct(measured(0.0, START))
    observer.correct(measured(0.1, {**START, "u": 9.0}))
    assert observer.estimate.u < 5.05 and not observer.received["u"]


def test_the_heading_is_pulled_the_short_way_round(kvlcc2):
    observer = Observer(kvlcc2)
    observer.correct(measured(0.0, {**START, "psi": radians(359.9)}))
    e = observer.correct(measured(0.1, {**START, "psi": radians(0.1)}))
    assert e.psi > pi or e.psi < radians(0.2)


def test_what_is_not_measured_is_predicted_and_its_doubt_grows(kvlcc2):
    observer = Observer(kvlcc2)
    observer.correct(measured(0.0, START))
    for k in range(1, 50):
        observer.correct(measured(0.1 * k, {**START, "x": 0.5 * k}))
    held = observer.estimate.sigma
    for k in range(50, 150):
        e = observer.correct(measured(0.1 * k, {"psi": 0.0}))
    assert e.x == pytest.approx(0.1 * 149 * 5.0, abs=0.2)
    assert e.sigma[0] > held[0] and e.sigma[3] > held[3] + 0.02


def test_speed_through_water_and_the_current_stand_in_for_speed_over_ground(kvlcc2):
    observer = Observer(kvlcc2, current=(0.5, 0.0))
    water = {"psi": 0.0, "u_r": 4.5, "v_r": 0.0}
    observer.correct(measured(0.0, water))
    for k in range(1, 100):
        e = observer.correct(measured(0.1 * k, water))
    assert e.u == pytest.approx(5.0, abs=1e-6)


def test_the_current_is_what_ground_and_water_speed_differ_by(kvlcc2):
    current = CurrentFilter(kvlcc2, 0.0, 0.0)
    e = Estimate(psi=radians(90.0))
    for k in range(20000):
        m = measured(0.1 * k, {"u": 5.5, "u_r": 5.0, "v": 0.2, "v_r": 0.0})
        north, east = current.feed(m, e)
    assert (north, east) == (pytest.approx(-0.2, abs=1e-3), pytest.approx(0.5, abs=1e-3))


def test_a_mad_speed_log_cannot_make_more_current_than_there_is_in_any_sea(kvlcc2):
    current = CurrentFilter(kvlcc2, 0.0, 0.0)
    for k in range(20000):
        found = current.feed(measured(0.1 * k, {"u": 5.0, "u_r": -35.0}), Estimate())
    assert hypot(*found) <= current.bound <= 5.0


def test_without_a_log_there_is_no_news_of_the_current(kvlcc2):
    current = CurrentFilter(kvlcc2, 0.3, -0.1)
    assert current.feed(measured(0.0, START), Estimate()) == (0.3, -0.1)


def test_after_a_long_pause_it_begins_anew_from_what_is_measured(kvlcc2):
    observer = Observer(kvlcc2)
    observer.correct(measured(0.0, START))
    e = observer.correct(measured(20.0, {**START, "x": 90.0}))
    assert observer.restarts == 1 and e.x == 90.0


def test_whatever_the_model_says_the_estimate_stays_within_what_a_ship_can_do(kvlcc2):
    observer = Observer(kvlcc2)
    observer.correct(measured(0.0, START))
    for k in range(1, 100):
        observer.steer(Rates(1e9, -1e9, 1e9))
        e = observer.correct(measured(0.1 * k, {"psi": 0.0}))
    assert abs(e.u) < 40.0 and abs(e.v) < 40.0 and abs(e.r) < 0.3

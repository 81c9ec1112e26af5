"""What each instrument effect shows of one moment, by hand."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from twin.physics.effects import find
from twin.physics.state import Situation


def test_instruments_by_hand(ship):
    s = Situation(
        x=10.0,
        y=20.0,
        psi=radians(30),
        u=4.0,
        v=-0.5,
        r=0.02,
        u_r=3.9,
        v_r=-0.4,
        wind_to=1.0,
        u_dot=0.1,
        v_dot=-0.05,
    )
    compass = find("HeadingBias")(bias=0.02, turned=0.03).read(s, ship)
    assert (compass.psi, compass.wind_to) == (pytest.approx(radians(30) + 0.02), pytest.approx(1.02))
    assert (compass.u, compass.v) == (
        pytest.approx(4 - 0.5 * 0.03, abs=2e-3),
        pytest.approx(-0.5 - 4 * 0.03, abs=1e-3),
    )
    assert find("SpeedLogBias")(bias=0.2).read(s, ship).u_r == pytest.approx(4.1)
    log = find("SpeedLogScale")(scale=0.05).read(s, ship)
    assert (log.u_r, log.v_r) == (pytest.approx(4.095), pytest.approx(-0.42))
    askew = find("SpeedLogMisalignment")(angle=radians(3)).read(s, ship)
    assert (askew.u_r, askew.v_r) == (pytest.approx(3.87373, rel=1e-4), pytest.approx(-0.60356, rel=1e-4))
    mast = find("AntennaOffset")(ahead=20.0, starboard=4.0).read(s, ship)
    assert (mast.x, mast.y) == (pytest.approx(10 + 17.32051 - 2), pytest.approx(20 + 10 + 3.46410))
    assert (mast.u, mast.v) == (pytest.approx(4 - 0.08), pytest.approx(-0.5 + 0.4))
    heeled = find("AntennaOffset")(ahead=20.0, starboard=4.0, above=10.0).read(
        replace(s, phi=radians(6), p=0.02), ship
    )
    # 4 + 10 sin 6 deg = 5.04528 m aside
    assert (heeled.x, heeled.y) == (pytest.approx(10 + 17.32051 - 2.52264), pytest.approx(20 + 10 + 4.36934))
    assert (heeled.u, heeled.v) == (
        pytest.approx(4 - 0.10091, abs=1e-5),
        pytest.approx(-0.5 + 0.4 + 0.19890, abs=1e-5),
    )
    level = find("AntennaOffset")(ahead=20.0, starboard=4.0, above=10.0).read(s, ship)
    assert (level.x, level.y, level.v) == (mast.x, mast.y, mast.v)
    late = find("SensorDelay")(delay=0.5, turned=0.5).read(s, ship)
    # 0.25 s ago: 29.71352 deg
    there = 0.5 * (3.975 * 0.8685145 + 0.4875 * 0.4956637), 0.5 * (3.975 * 0.4956637 - 0.4875 * 0.8685145)
    assert (late.x, late.y) == (pytest.approx(10 - there[0]), pytest.approx(20 - there[1]))
    assert find("SensorDelay")(delay=0.5, turned=0.5).prompt() == (
        0.5,
        find("SensorDelay")(delay=0.0, turned=0.5),
    )
    # turned by 0.01 rad: 3.95 x 0.99995 - 0.475 x 0.0099998, -0.475 x 0.99995 - 3.95 x 0.0099998
    assert (late.u, late.v) == (pytest.approx(3.9450526), pytest.approx(-0.5144756))
    assert find("GyroBias")(bias=0.001).read(s, ship).r == pytest.approx(0.021)
    assert find("GyroScale")(scale=-0.05).read(s, ship).r == pytest.approx(0.019)


def test_a_late_velocity_is_turned_by_what_the_ship_turned_since(ship):
    """Test: a boat at 4 m/s whose rate of turn grows to 0.15 rad/s with a time constant of 4 s, a receiver 2 s late,
    its velocity turned by the present heading; asked at the moment when it is shown and at the one that it shows.
    Expected: aside what the exact angle gives, within 0.06 m/s; to first order it is off by more than 0.2 m/s."""

    def psi(t):
        return 0.15 * (t - 4.0 * (1.0 - np.exp(-t / 4.0)))

    t, late = np.linspace(2.0, 20.0, 37), find("SensorDelay")(delay=2.0, turned=2.0)
    exact = -4.0 * np.sin(psi(t) - psi(t - 2.0))
    for then, effect, least in ((t, late, 0.06), (t - 2.0, late.prompt()[1], 0.06)):
        r, r_dot = 0.15 * (1.0 - np.exp(-then / 4.0)), 0.15 / 4.0 * np.exp(-then / 4.0)
        shown = effect.read(Situation(psi=psi(then), u=4.0, v=0.0, r=r, r_dot=r_dot), ship)
        off, by_rate = np.abs(shown.v - exact).max(), np.abs(-8.0 * r - exact).max()
        assert off < least and by_rate > 0.2, (off, by_rate)


def test_an_antennas_speed_changes_with_the_turning(ship):
    """A receiver that is late or smooths shows that change: 20 m ahead, 4 m to starboard, 0.003 rad/s2."""
    s = Situation(psi=radians(30), u=4.0, v=-0.5, r=0.02, u_dot=0.1, v_dot=-0.05, r_dot=0.003)
    mast = find("AntennaOffset")(ahead=20.0, starboard=4.0, above=0.0).read(s, ship)
    assert (mast.u_dot, mast.v_dot) == (pytest.approx(0.1 - 0.012), pytest.approx(-0.05 + 0.06))


def test_a_slow_compass_by_hand(ship):
    s = Situation(psi=radians(30), u=4.0, v=-0.5, r=0.02, r_dot=0.003)
    # 2 (0.02 - 0.003) = 0.034 rad behind; the velocity turned by 3 (0.02 - 0.0045) = 0.0465 rad
    slow = find("HeadingLag")(lag=2.0, turned=3.0, filtered=0.0).read(s, ship)
    assert slow.psi == pytest.approx(radians(30) - 0.034)
    assert (slow.u, slow.v) == (
        pytest.approx(4 * 0.9989191 + 0.5 * 0.0464832, rel=1e-6),
        pytest.approx(-0.5 * 0.9989191 + 4 * 0.0464832, rel=1e-6),
    )


def test_a_slow_compass_shows_the_heading_of_then_where_a_turn_begins(ship):
    """Test: a rate of turn that grows to 0.02 rad/s with a time constant of 8 s, a compass 2 s late, 3 to 30 s after
    the rudder. Expected: the heading of 2 s ago to a thousandth of a radian, a tenth of what the rate of turn alone is
    off."""

    def psi(t):
        return 0.02 * (t - 8.0 * (1.0 - np.exp(-t / 8.0)))

    t = np.linspace(3.0, 30.0, 28)
    r, r_dot = 0.02 * (1.0 - np.exp(-t / 8.0)), 0.02 / 8.0 * np.exp(-t / 8.0)
    late = find("HeadingLag")(lag=2.0, filtered=0.0)
    slow = late.read(Situation(psi=psi(t), u=4.0, v=0.0, r=r, r_dot=r_dot), ship)
    off, by_rate = slow.psi - psi(t - 2.0), psi(t) - 2.0 * r - psi(t - 2.0)
    assert np.abs(off).max() < 1e-3 and np.all(np.abs(off) < 0.1 * np.abs(by_rate))


def test_a_compass_that_filters_lags_otherwise_than_one_that_is_late(ship):
    """Test: the same turn, shown by a filter of first order with a time constant of 2 s. Expected: half as far off
    as if it were late, and the heading of the filter (its differential equation solved) to a fifth of a degree."""
    t, T = np.linspace(3.0, 30.0, 28), 2.0
    eased = np.exp(-t / 8.0)
    s = Situation(
        psi=0.02 * (t - 8.0 * (1.0 - eased)), u=4.0, v=0.0, r=0.02 * (1.0 - eased), r_dot=0.0025 * eased
    )
    shown = 0.02 * (t - T - 8.0 + 8.0 * eased / (1.0 - T / 8.0))
    off = [np.abs(find("HeadingLag")(lag=T, filtered=k).read(s, ship).psi - shown).max() for k in (1.0, 0.0)]
    assert off[0] < 0.5 * off[1] and off[0] < radians(0.2)


def test_a_compass_with_iron_about_it_by_hand(ship):
    # heading 30 deg: 0.01 + 0.02 x 0.5 + 0.03 x 0.8660254 + 0.04 x 0.8660254 + 0.05 x 0.5 = 0.1056218 rad;
    # half of it turns the velocity
    s = Situation(psi=radians(30), u=4.0, v=-0.5, wind_to=1.0)
    iron = find("CompassDeviation")(A=0.01, B=0.02, C=0.03, D=0.04, E=0.05, turned=0.5).read(s, ship)
    assert (iron.psi, iron.wind_to) == (pytest.approx(radians(30) + 0.1056218), pytest.approx(1.1056218))
    assert (iron.u, iron.v) == (
        pytest.approx(4 * 0.9986058 - 0.5 * 0.0527863, rel=1e-6),
        pytest.approx(-0.5 * 0.9986058 - 4 * 0.0527863, rel=1e-6),
    )


def test_a_receiver_that_smooths_by_hand(ship):
    # a = 2 x 0.02 = 0.04, 1 + a^2 = 1.0016
    s = Situation(x=7.0, u=4.0, v=-0.5, r=0.02, u_dot=0.1, v_dot=-0.05)
    smooth = find("ReceiverSmoothing")(time=2.0).read(s, ship)
    assert (smooth.u, smooth.v) == (
        pytest.approx((4 - 0.02) / 1.0016 - 0.2),
        pytest.approx((-0.5 - 0.16) / 1.0016 + 0.1),
    )
    assert smooth.x == 7.0  # the place is prompt

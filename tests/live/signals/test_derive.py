"""What follows from other measurements, by hand."""

from math import cos, pi, radians, sin

import pytest

from twin.live.signals.derive import RateFromHeading, SpeedFromPosition, apparent_wind, true_wind, turn


def test_the_short_way_round():
    assert turn(radians(350.0)) == pytest.approx(radians(-10.0))
    assert turn(radians(-190.0)) == pytest.approx(radians(170.0))


def test_apparent_wind_by_hand():
    """North wind 10 m/s on a ship heading north at 5 m/s: 15 m/s from dead ahead."""
    speed, angle = apparent_wind(10.0, pi, 0.0, 5.0, 0.0)
    assert (speed, angle) == (pytest.approx(15.0), pytest.approx(0.0, abs=1e-12))


def test_wind_on_the_starboard_beam_by_hand():
    """Heading east, wind from the south 8 m/s, ship stopped: from 90 deg to starboard."""
    speed, angle = apparent_wind(8.0, 0.0, radians(90.0), 0.0, 0.0)
    assert (speed, angle) == (pytest.approx(8.0), pytest.approx(radians(90.0)))


@pytest.mark.parametrize("wind_to, psi, u, v", ((0.3, 1.0, 5.0, 0.4), (4.0, 6.0, -2.0, 1.0)))
def test_true_and_apparent_wind_undo_each_other(wind_to, psi, u, v):
    felt = apparent_wind(9.0, wind_to, psi, u, v)
    speed, to = true_wind(*felt, psi, u, v)
    assert speed == pytest.approx(9.0) and turn(to - wind_to) == pytest.approx(0.0, abs=1e-12)


def test_speed_from_positions_in_a_steady_turn_has_no_lag():
    tracker, ready = SpeedFromPosition(0.3), False
    u, v, r = 7.0, -0.8, radians(0.4)
    x = y = 0.0
    for k in range(1000):
        psi = r * 0.1 * k
        ready = tracker.feed(x, y, psi % (2.0 * pi), 0.1 * k)
        middle = psi + 0.05 * r
        x, y = x + 0.1 * (u * cos(middle) - v * sin(middle)), y + 0.1 * (u * sin(middle) + v * cos(middle))
    assert ready and tracker.u == pytest.approx(u, abs=0.01) and tracker.v == pytest.approx(v, abs=0.02)


def test_rate_of_turn_from_headings_through_north():
    tracker, ready = RateFromHeading(0.9), False
    for k in range(300):
        ready = tracker.feed(radians(350.0 + 0.05 * k) % (2.0 * pi), 0.1 * k)
    assert ready and tracker.r == pytest.approx(radians(0.5), rel=1e-3)


def test_a_hole_in_the_positions_starts_the_filter_again():
    tracker = SpeedFromPosition(0.3)
    for k in range(300):
        ready = tracker.feed(0.7 * k, 0.0, 0.0, 0.1 * k)
    assert ready and not tracker.feed(1e5, 0.0, 0.0, 100.0)

"""Which assumption a lie breaks, by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from bench.broken_assumptions import exceeded
from twin.live.certificate.plant import Disturbance
from twin.physics.ship import load
from twin.study.reference.split import SplitVoyage

SHIP = load("kvlcc2")
FORCE, MOMENT = 1e5, 1e7  # D less what the learned force may reach [N, N m]
TUBE = SimpleNamespace(
    noise=(0.1, 0.2, 0.001),
    heading_noise=0.01,
    certificate=SimpleNamespace(
        disturbance=Disturbance((1.5 * FORCE, 1.5 * FORCE, 1.5 * MOMENT)),
        saturation=(0.5 * FORCE, 0.5 * FORCE, 0.5 * MOMENT),
    ),
)
LOOP = SimpleNamespace(ship=SHIP, stabilizer=SimpleNamespace(tube=TUBE))
STILL = SplitVoyage(0.1, np.array([[6.0], [0.0], [0.0]]), np.zeros(1), {}, np.zeros((2, 1)), 0.0, 8.0)
HONEST = {
    "north_m": 0.0,
    "heading_true_north_deg": 359.0,
    "surge_velocity_mps": 6.0,
    "sway_velocity_mps": 0.0,
    "yaw_rate_degps": 0.0,
    "rudder_angle_deg": 0.0,
    "propeller_rate_rpm": 60.0,
}


def lied(**by):
    return exceeded(LOOP, STILL, 0, HONEST, {name: x + by.get(name, 0.0) for name, x in HONEST.items()})


def test_a_reading_of_motion_or_heading_is_held_against_its_noise():
    """Test: by hand, 0.3 of 0.1 m/s, 2 deg across north of 0.01 rad. Expected: A4, and whether it is beyond."""
    assert (
        lied(surge_velocity_mps=0.3)[:] == (pytest.approx(3.0), "A4") and lied(surge_velocity_mps=0.3).breaks
    )
    assert lied(heading_true_north_deg=2.0).share == pytest.approx(np.radians(2.0) / 0.01)
    assert lied(yaw_rate_degps=0.02).share == pytest.approx(np.radians(0.02) / 0.001)
    assert not lied(sway_velocity_mps=0.1).breaks


def test_positions_are_no_part_of_the_bound():
    assert lied(north_m=200.0).share == 0.0 and not lied(north_m=200.0).breaks


def test_rudder_and_shaft_are_held_against_the_force_that_they_are_wrong_by():
    """Expected: A3; twice as far a rudder about twice as much; a sample that is missing says nothing."""
    five, ten = lied(rudder_angle_deg=5.0), lied(rudder_angle_deg=10.0)
    assert five.assumption == ten.assumption == "A3" and ten.share == pytest.approx(
        2.0 * five.share, rel=0.05
    )
    assert lied(propeller_rate_rpm=30.0).share > lied(propeller_rate_rpm=10.0).share > 0.0
    assert lied(rudder_angle_deg=float("nan")).share == 0.0

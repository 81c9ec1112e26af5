"""The reference sea against other people's figures."""

import os
from pathlib import Path

import numpy as np
import pytest

from bench.reference import sea_trials, trial_indices


@pytest.fixture(scope="module")
def model():
    return sea_trials.standard("kvlcc2_model")


def test_turning_circle_is_that_of_an_independent_program(model):
    """`shipmmg` keeps another wake law, which costs up to 13 % of diameter to port."""
    for angle, (advance, diameter) in sea_trials.SHIPMMG_TURN.items():
        assert model[0][angle][0] == pytest.approx(advance, rel=0.08)
        assert model[0][angle][1] == pytest.approx(diameter, rel=0.15)


def test_zigzag_overshoots_are_those_of_an_independent_program(model):
    for angle, theirs in sea_trials.SHIPMMG_ZIGZAG.items():
        assert model[1][angle] == pytest.approx(theirs, abs=1.5)


def test_the_ship_turns_wider_to_neither_side_but_overshoots_differently(model):
    """KVLCC2 has one screw: the same zigzag begun to port is another zigzag (Yasukawa & Yoshimura 2015)."""
    assert model[1][10][1] > model[1][-10][1] + 3
    assert abs(model[0][35][1] - model[0][-35][1]) < 0.1


def test_manoeuvres_are_inside_the_limits_of_imo(model):
    assert all("inside" in text for text in sea_trials.limits(*model))


def test_overshoots_and_turns_are_read_from_series_made_by_hand():
    time = np.arange(0, 100, 0.1)
    psi = 12 * np.sin(2 * np.pi * time / 50)
    rudder = np.where(np.cos(2 * np.pi * time / 50) > 0, 10.0, -10.0)
    over, reversals = trial_indices.overshoots(time, psi, rudder, 10)
    assert over[0] == pytest.approx(2, abs=0.1) and reversals[:2] == pytest.approx([12.5, 37.5], abs=0.2)
    angle = np.radians(np.arange(0, 200.0))
    advance, diameter = trial_indices.turn(np.sin(angle), 1 - np.cos(angle), np.degrees(angle), 1.0)
    assert (advance, diameter) == pytest.approx((1.0, 2.0), rel=1e-3)


@pytest.mark.skipif(
    "SHIPTWIN_DATA" not in os.environ, reason="SHIPTWIN_DATA does not name the folder of kvlcc2_simman/"
)
def test_measured_zigzags_are_read_with_rudder_to_starboard_positive():
    path = Path(os.environ["SHIPTWIN_DATA"]) / "kvlcc2_simman" / "hsva" / "HSVA_CPMC_KVLCC2_Z_20_10_S.dat"
    time, psi, rudder, angle, at, hull = sea_trials.read_run(path)
    assert (angle, at, hull) == (20, 10, "kvlcc2_model")
    turning = np.gradient(psi, time)
    assert np.corrcoef(np.roll(rudder, 60)[60:], turning[60:])[0, 1] > 0.5

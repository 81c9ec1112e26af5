"""Where a prediction begins when instruments are known to be at fault."""

import numpy as np
import pytest

from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.estimation.start import kinematics, true_motion
from twin.study.track.track import READINGS, Track

MODEL = Model.of(load("usv"))


def shown(read=lambda place, motion: place, noise=0.0):
    """A winding path as faulty instruments show it: `read` makes their place of the true one; (true motion,
    track)."""
    h, n = 0.04, 3000
    t = h * np.arange(n)
    psi = 0.8 * np.sin(0.2 * t)
    place = np.column_stack([np.cumsum(np.cos(psi)), np.cumsum(np.sin(psi)), psi]) * [h, h, 1.0]
    true = kinematics(place, h)
    # what the smoothing leaves of a fast scatter
    rough = noise * np.sin(2.0 * np.pi * t / 0.5)[:, None] * [1.0, 1.0, 0.0]
    state = kinematics(read(place, true) + rough, h)
    return true, Track(
        "t", t, h, state, 0 * t, 0 * t, {}, np.zeros((n, len(READINGS))), np.ones(8), np.ones(n, bool)
    )


@pytest.mark.parametrize("delay_s", [0.1, 0.4, 1.0])
def test_a_late_receiver_is_undone_without_making_the_scatter_larger(delay_s):
    """Fault: place as it was `delay` ago, with a ripple far faster than that. Expected: the ripple stays as
    it was."""

    def late(place, motion):
        t = 0.04 * np.arange(len(place))
        return np.column_stack([*(np.interp(t - delay_s, t, x) for x in place[:, :2].T), place[:, 2]])

    true, track = shown(late, noise=0.002)
    found, _ = true_motion(track, MODEL.but(find("SensorDelay").absent(MODEL.ship).but(delay=delay_s)))
    off = np.abs(found - true)[100:-100]
    ripple = 0.002 * 2.0 * np.pi / 0.5
    assert off[:, :2].max() < 0.003
    assert off[:, 3:5].max() < 0.02 + ripple


def test_lever_arm_and_compass_are_undone_together():
    def read(place, motion):
        x, y, psi = place.T
        return np.column_stack([x + 0.5 * np.cos(psi), y + 0.5 * np.sin(psi), psi + 0.1])

    true, track = shown(read)
    model = MODEL.but(find("AntennaOffset").absent(MODEL.ship).but(ahead=0.5)).but(
        find("HeadingBias").absent(MODEL.ship).but(bias=0.1)
    )
    found, _ = true_motion(track, model)
    assert np.abs(found - true)[2:-2, :5].max() < 2e-3

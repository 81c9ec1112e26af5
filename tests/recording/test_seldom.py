"""Logs whose place and heading come seldom: what they tell is told, and nothing is proved by what they do not."""

import numpy as np
import pytest

from tests.recording.test_checks import HEADING, RATE, RUDDER, SURGE, SWAY, TURNS, answers
from twin.recording.checks.joint_checks import OF_MOTION

PLACE = ("north_m", "east_m")


def logged(full, every):
    """The channels of `every`: (first sample, time between two) [s] of each."""
    t = np.round(full["time_s"], 1)
    return {"time_s": t} | {
        name: np.where(np.mod(t - first_s + 1e-6, wait_s) < 1e-3, full[name], np.nan)
        for name, (first_s, wait_s) in every.items()
    }


@pytest.mark.parametrize("behind_s", [0.0, 5.0], ids=["in the same rows", "in rows of their own"])
def test_a_ship_whose_place_and_heading_come_every_ten_seconds_makes_way(sail, behind_s, recwarn):
    """Test: place every 10 s, heading every 10 s, rudder and shaft every second; nothing else was recorded."""
    every = dict.fromkeys(PLACE, (0.0, 10.0)) | {HEADING: (behind_s, 10.0)}
    said = answers(logged(sail(noise=0.0), every | dict.fromkeys((RUDDER, TURNS), (0.0, 1.0))))
    assert said["duration"].ok
    assert float(said["duration"].text.split(", ")[1].split()[0]) == pytest.approx(6230.0, rel=0.05)
    assert said["propeller_rate"].informative and said["rudder_sign"].informative
    assert not recwarn.list


@pytest.mark.parametrize("wait_s", [30.0, 60.0, 120.0, 250.0])
@pytest.mark.parametrize("length_m", [30.0, 100.0, 320.0])
def test_nothing_is_proved_against_a_sound_log_that_is_too_seldom_for_its_turns(sail, length_m, wait_s):
    """Test: zigzags of 20 deg, all channels together every half minute to every four minutes."""
    channels = (*PLACE, HEADING, RATE, SURGE, SWAY, RUDDER, TURNS)
    said = answers(logged(sail(2700.0, length_m), dict.fromkeys(channels, (0.0, wait_s))))
    assert not [c.text for c in said.values() if c.unusable]
    if length_m <= 100.0:
        assert all("from one sample to the next" in said[name].text for name in OF_MOTION)


def test_too_few_windows_prove_no_stream(sail):
    """Test: place and velocities every 250 s of 900 s, heading, rudder and shaft every second."""
    seldom = dict.fromkeys((*PLACE, SURGE, SWAY), (0.0, 250.0))
    often = dict.fromkeys((HEADING, RATE, RUDDER, TURNS), (0.0, 1.0))
    assert not [c.text for c in answers(logged(sail(noise=0.0), seldom | often)).values() if c.unusable]

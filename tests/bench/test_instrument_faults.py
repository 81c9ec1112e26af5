"""Faults are planted as they are named, and two real circles agree about their log."""

import os
from pathlib import Path

import numpy as np
import pytest

from bench.instruments_plant import SIZES, planted
from bench.instruments_real import SOURCES, YACHT, log_lacks
from bench.reference import HULLS
from tests.thorough import thorough
from twin.recording.read import read_voyage
from twin.study.instruments.instrument_estimate import estimate

DATA = os.environ.get("SHIPTWIN_DATA")
HULL = HULLS["container"]


@pytest.fixture
def sailed():
    """A ship that turns steadily to starboard at 8 m/s and 0.01 rad/s, as healthy instruments of the sea show
    it: satellites 0.1 s late, log 0.2 s."""
    t = np.arange(0.0, 400.0, 0.1)

    def truth(t):
        psi = 0.01 * t
        return {
            "north": 800.0 * np.sin(psi),
            "east": 800.0 * (1.0 - np.cos(psi)),
            "psi": psi,
            "u": 8.0 + 0 * t,
            "v": 0 * t,
            "r": 0.01 + 0 * t,
            "u_r": 8.0 + 0 * t,
            "v_r": 0 * t,
        }

    late = truth(t - 0.1)
    columns = {
        "time_s": t,
        "north_m": late["north"],
        "east_m": late["east"],
        "heading_true_north_deg": np.degrees(0.01 * t) % 360.0,
        "surge_velocity_mps": late["u"],
        "sway_velocity_mps": late["v"],
        "yaw_rate_degps": np.degrees(truth(t)["r"]),
        "surge_velocity_through_water_mps": truth(t)["u_r"],
        "sway_velocity_through_water_mps": 0 * t,
        "apparent_wind_angle_deg": 0 * t,
    }
    return columns, truth(t)


@pytest.mark.parametrize(
    "fault, channel, more",
    [
        ("nothing", "heading_true_north_deg", 0.0),
        ("heading_delay", "heading_true_north_deg", -np.degrees(0.01 * 1.5)),
        ("heading_bias", "heading_true_north_deg", np.degrees(0.05)),
        ("gyro_bias", "yaw_rate_degps", np.degrees(3e-4)),
        ("log_scale", "surge_velocity_through_water_mps", 0.64),
        ("antenna", "sway_velocity_mps", 0.2 * 175.0 * 0.01),
        # a = 3 s x 0.01 rad/s: (u + a v)/(1 + a^2)
        ("smoothing", "surge_velocity_mps", 8.0 / (1.0 + 0.03**2) - 8.0),
        ("smoothing", "sway_velocity_mps", -8.0 * 0.03 / (1.0 + 0.03**2)),
    ],
)
def test_a_fault_is_planted_as_it_is_named(sailed, fault, channel, more):
    columns, truth = sailed
    out, size = planted(columns, truth, HULL, (fault,), False)
    assert set(SIZES[fault]) <= set(size)
    difference = out[channel][2000] - columns[channel][2000]
    assert difference == pytest.approx(more, abs=2e-4)


@thorough
@pytest.mark.skipif(not DATA, reason="SHIPTWIN_DATA says where real voyages are")
def test_two_real_circles_agree_about_the_log_within_eight_per_cent():
    shown = []
    for name in YACHT:
        path = Path(DATA) / "logs" / "nmea2000" / name
        found = estimate([read_voyage(path, sources=SOURCES, controls=False)])
        shown.append(1.0 - log_lacks(found) / found.readings[0].speed)
        assert {"smoothing"} <= set(found.faults)
    assert shown[0] == pytest.approx(shown[1], rel=0.08) and 0.6 < shown[0] < 0.9

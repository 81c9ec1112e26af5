"""What the course over ground says of the heading: an offset, and neither a stream nor the drift of a turn."""

import re
from pathlib import Path

import numpy as np
import pytest

from twin.recording.checks.compass import compass
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.raw import Raw
from twin.recording.voyage import Voyage

TURNING_S, STEADY_S = 10.0, 8.0
CIRCLE = ((150, 0), (270, -1.45), (25, 1.2), (60, 0))  # seconds at so many deg/s
ZIGZAG = ((25, -0.65), (25, 0.65), (25, 0.65), (25, -0.65)) * 3
AFTER = ((40, 0.5), (400, 0))


def sailed(turns, off_deg=0.0, stream=0.0j, aside_m=100.0, speed_mps=8.0):
    """The check of a ship that turns so, loses way and drifts in its turns, in a stream [m/s, north + i east]
    and with a compass that is so far off. `aside_m`: how far a turn of 1 rad/s pushes it aside per second."""
    ordered = np.radians(np.concatenate([np.full(s, rate) for s, rate in turns]))
    rng, n = np.random.default_rng(0), ordered.size
    r, v, u = np.zeros(n), np.zeros(n), np.full(n, speed_mps)
    for k in range(1, n):
        r[k] = r[k - 1] + (ordered[k - 1] - r[k - 1]) / TURNING_S
        v[k] = v[k - 1] + (-aside_m * r[k - 1] - v[k - 1]) / STEADY_S
        slowed = speed_mps * (1.0 - 0.6 * min(abs(r[k - 1]) / np.radians(1.4), 1.0))
        u[k] = u[k - 1] + (slowed - u[k - 1]) / 40.0
    psi = 0.3 + np.cumsum(r) - r / 2.0
    way = (u + 1j * v) * np.exp(1j * psi) + stream
    place = np.cumsum(way) + 0.3 * (rng.normal(size=n) + 1j * rng.normal(size=n))
    told = psi + np.radians(off_deg)
    seen = way * np.exp(-1j * told)
    columns = {
        "north_m": place.real,
        "east_m": place.imag,
        "heading_true_north_deg": np.mod(np.degrees(told) + 0.1 * rng.normal(size=n), 360.0),
        "surge_velocity_mps": seen.real,
        "sway_velocity_mps": seen.imag,
        "yaw_rate_degps": np.degrees(r) + 0.02 * rng.normal(size=n),
        "rudder_angle_deg": np.degrees(ordered) * 20.0,
        "propeller_rate_rpm": np.full(n, 110.0),
    }
    raw = Raw(Path("v.csv"), np.arange(2, n + 2), np.arange(float(n)), columns, {})
    return compass(VoyageView(Voyage.of(raw)))


@pytest.mark.parametrize("stream", (0.0j, 0.4 + 0.0j, -0.3 + 0.3j, -0.3j))
def test_neither_the_drift_after_a_circle_nor_a_stream_beside_a_slow_ship_is_an_offset(stream):
    found = sailed((*CIRCLE, *AFTER), stream=stream)
    assert found.ok, found.text


@pytest.mark.parametrize("off_deg", (-10.0, 10.0))
def test_a_compass_that_is_ten_degrees_off_is_told_beside_a_circle_and_a_stream(off_deg):
    found = sailed((*CIRCLE, (150, 0), (140, 0.9), (150, 0), *ZIGZAG), off_deg, stream=0.3 - 0.2j)
    told = re.search(r"the heading is (\S+) deg off the course over ground", found.text)
    assert told and abs(float(told[1]) - off_deg) < 2.0


def test_an_offset_on_headings_all_round_is_no_stream():
    """Test: four legs, each at right angles to the one before. Expected: no stream would look the same."""
    found = sailed(((120, 0), (100, 0.9)) * 4, 10.0, stream=0.4 + 0.0j)
    assert "so it is no stream" in found.text


def test_an_offset_on_headings_from_which_a_stream_would_come_from_one_side_is_told_with_that_stream():
    """Test: a compass that is 14 deg off, on two headings 60 deg apart at 8 m/s. Expected: abeam between them
    a stream of 8 sin 14 / cos 30 = 2.2 m/s would look the same, and that is said."""
    found = sailed(((150, 0), (67, 0.9), (180, 0)), 14.0, aside_m=0.0)
    assert "a stream of 2.2 m/s would look the same" in found.text, found.text

"""How much too much an anemometer shows, in a wind that comes in gusts: they are no scale of the instrument."""

import numpy as np
import pytest

from tests.study.instruments.test_instruments import HEADING, healthy, near, voyage
from twin.study.instruments.instrument_estimate import estimate

__all__ = ["healthy"]
MEMORY_S = 40.0


def blown(columns, seed, gust_mps, shown=1.0):
    """The ship in a wind of 9 m/s with gusts of that size, whose anemometer shows so many times the speed."""
    rng, t = np.random.default_rng(seed), columns["time_s"]
    keep = np.exp(-(t[1] - t[0]) / MEMORY_S)
    gusts = np.zeros((t.size, 2))
    for k in range(1, t.size):
        gusts[k] = keep * gusts[k - 1] + gust_mps * np.sqrt(1.0 - keep**2) * rng.normal(size=2)
    air = -9.0 * np.exp(1j * np.radians(60.0)) + gusts @ [1.0, 1j]
    over_ground = columns["surge_velocity_mps"] + 1j * columns["sway_velocity_mps"]
    seen = over_ground - air * np.exp(-1j * np.radians(columns[HEADING]))
    return columns | {
        "apparent_wind_speed_mps": shown * np.abs(seen) + 0.2 * rng.normal(size=t.size),
        "apparent_wind_angle_deg": np.degrees(np.angle(seen)),
    }


@pytest.mark.parametrize("seed", [1, 2])
def test_gusts_are_no_fault_of_the_anemometer(healthy, seed):
    """Expected: no fault, and none within two standard errors."""
    found = estimate([voyage(blown(healthy, seed, 1.5))], 100.0)
    e = found.of("wind_scale")
    assert "anemometer" not in found.faults and abs(e.value) < 2.0 * e.sd


@pytest.mark.parametrize("shown", [0.5, 1.5])
def test_an_anemometer_that_shows_too_much_is_found_with_its_size(healthy, shown):
    found = estimate([voyage(blown(healthy, 1, 0.5, shown))], 100.0)
    assert "anemometer" in found.faults
    near(found, "wind_scale", shown - 1.0)

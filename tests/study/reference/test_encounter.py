"""The encounter frequency is found in the readings of yaw, where the smooth path follows the waves no more."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.model import Model
from twin.study.estimation.start import wave_period_s
from twin.study.reference.encounter import met, one_frequency
from twin.study.reference.seaway import LATELY, SWIFT, WAVES_LOG_BAYES, swung
from twin.study.track.track import READINGS, track

PERIOD_S, YAW_RATE = 8.0, 5e-4  # of a swell [rad/s]
HEADING, RATE = READINGS.index("psi"), READINGS.index("r")


def in_swell(t, size=YAW_RATE):
    """The same readings of heading and rate of turn in an irregular swell, of which the smooth path shows
    nothing."""
    rng = np.random.default_rng(3)
    omega = 2.0 * np.pi / PERIOD_S * np.linspace(0.88, 1.12, 12)
    angle = np.outer(t.t, omega) + rng.uniform(0.0, 2.0 * np.pi, 12)
    measured = t.measured.copy()
    measured[:, RATE] += size * np.sqrt(2.0 / 12) * np.cos(angle).sum(1)
    measured[:, HEADING] += size * np.sqrt(2.0 / 12) * (np.sin(angle) / omega).sum(1)
    return replace(t, measured=measured)


@pytest.fixture(scope="module")
def calm(tanker, voyages):
    return track(voyages["nothing"], tanker)


def found(t, ship):
    time = float(ship.scale("time"))
    return met(t, SWIFT * time, LATELY * time, WAVES_LOG_BAYES)


def test_a_swell_that_only_the_readings_show_has_its_period_and_strength(calm, tanker):
    by_rate, by_heading = (x for x in found(in_swell(calm), tanker) if not x[:, 3:5].any())
    for swell in (by_rate, by_heading):
        assert 2.0 * np.pi / swell[0, 2] == pytest.approx(PERIOD_S, rel=0.15)
        assert not swell[:, 3:5].any() and np.ptp(swell, axis=0).max() == 0.0
    assert by_rate[0, 5] == pytest.approx(2.0 * np.pi / PERIOD_S * YAW_RATE, rel=0.3)


def test_what_it_swings_the_ship_in_sway_is_read_at_its_frequency(calm, tanker):
    """Test: the swell with a sway velocity of 0.1 m/s over ground. Expected: of each reading of yaw one that swings
    the ship in yaw alone, and one with this sway."""
    rough = in_swell(calm)
    measured = rough.measured.copy()
    measured[:, READINGS.index("v")] += 0.1 * np.sqrt(2.0) * np.sin(2.0 * np.pi / PERIOD_S * calm.t)
    alone, all_axes = found(replace(rough, measured=measured), tanker)[:2]
    assert not alone[:, 3:5].any() and one_frequency(replace(calm, swell=all_axes))
    assert all_axes[0, 4] == pytest.approx(0.1 * 2.0 * np.pi / PERIOD_S, rel=0.3)


def test_the_study_sees_that_swell_and_no_half_of_it_in_calm_water(calm, tanker):
    rough = swung(in_swell(calm), Model.of(tanker))
    assert one_frequency(rough) and wave_period_s(rough) == pytest.approx(PERIOD_S, rel=0.15)
    assert not one_frequency(calm)


@pytest.mark.parametrize("name", ["slow gear zigzag", "RudderBacklash", "Sloshing", "Wind"])
def test_no_zigzag_and_no_other_cause_is_a_swell(name, tanker, voyages):
    assert swung(track(voyages[name], tanker), Model.of(tanker)).swell is None


def test_readings_that_are_too_few_for_waves_show_none(calm, tanker):
    sparse = in_swell(calm).measured.copy()
    sparse[np.arange(len(calm)) % 50 != 0] = np.nan
    assert found(replace(calm, measured=sparse), tanker) == []
    assert found(replace(calm, measured=np.full_like(sparse, np.nan)), tanker) == []


def test_readings_that_are_the_path_itself_show_no_waves(calm, tanker):
    exact = calm.measured.copy()
    exact[:, HEADING], exact[:, RATE] = calm.state[:, 2], calm.state[:, 5]
    assert found(replace(calm, measured=exact), tanker) == []

"""Waves are taken out of a track when they are there, and only then."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.model import Model
from twin.study.seaway import calmed, wave_steps
from twin.study.track import READINGS, track

PERIOD_S = 10.0
V, R = READINGS.index("v"), READINGS.index("r")


@pytest.fixture(scope="module")
def calm(tanker, voyages):
    return track(voyages["nothing"], tanker)


@pytest.fixture(scope="module")
def rough(calm):
    """The same track in a sea that sways and turns her every ten seconds."""
    state, measured = calm.state.copy(), calm.measured.copy()
    for column, size in ((V, 0.3), (R, 0.004)):
        wave = size * np.sin(2.0 * np.pi / PERIOD_S * calm.t)
        state[:, column] += wave
        measured[:, column] += wave
    return replace(calm, state=state, measured=measured)


def test_a_calm_track_is_left_as_it_is(calm, tanker):
    assert wave_steps(calm, Model.of(tanker)) == 0
    assert calmed(calm, Model.of(tanker)) is calm


def test_the_period_of_the_waves_is_found(rough, tanker):
    assert wave_steps(rough, Model.of(tanker)) * rough.h == pytest.approx(PERIOD_S, rel=0.15)


def test_the_path_without_waves_is_the_calm_path(calm, rough, tanker):
    done, whole = calmed(rough, Model.of(tanker)), slice(20, -20)
    for column, size in ((V, 0.3), (R, 0.004)):
        left = done.state[whole, column] - calm.state[whole, column]
        assert np.sqrt(np.mean(left**2)) < 0.15 * size


def test_averaged_readings_stand_where_the_calm_path_does_and_say_how_sure_they_are(rough, calm, tanker):
    done = calmed(rough, Model.of(tanker))
    off = done.measured[:, R] - calm.state[:, 5]
    seen = np.isfinite(off)
    assert 0 < seen.sum() < 0.3 * len(calm)
    assert np.sqrt(np.mean(off[seen] ** 2)) < 0.2 * 0.004
    assert done.sd[R] < 0.5 * 0.004

"""Waves are taken out of a track when they are there, and only then."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.model import Model
from twin.study.seaway import calmed, tossed, wave_steps
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


def at_sea(sailed, height_m, period_s):
    waves = {"H_s": np.full(len(sailed), height_m), "T_p": np.full(len(sailed), period_s)}
    return replace(sailed, weather=dict(sailed.weather) | waves)


def test_waves_that_were_not_measured_or_that_a_ship_meets_faster_than_she_moves_toss_nobody(calm, tanker):
    model = Model.of(tanker)
    assert not tossed(calm, model).any()
    assert not tossed(at_sea(calm, 3.0, 8.0), model).any()


def test_waves_toss_a_ship_by_what_she_shows_and_by_no_more_than_the_water_itself(calm, rough, tanker):
    """Waves of 30 s that follow a tanker at 8 m/s meet her every 36 s, hardly faster than she moves (40 s): of 40 m they toss her by
    what she shows, of 1 m by the water's own acceleration."""
    model = Model.of(tanker)
    shown, water = tossed(at_sea(rough, 40.0, 30.0), model)[0], tossed(at_sea(rough, 1.0, 30.0), model)[0]
    assert shown[1] == pytest.approx(0.3 * 2.0 * np.pi / PERIOD_S / np.sqrt(2.0), rel=0.2)
    assert water[1] == pytest.approx(0.25 * (2.0 * np.pi / 30.0) ** 2)

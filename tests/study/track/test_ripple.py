"""Readings that scatter more at some times than at others are trusted less then, and make nothing else of the
voyage rougher."""

from dataclasses import replace

import numpy as np
import pytest

from twin.study.diagnosis.assemble import assemble
from twin.study.track.ripple import shaken
from twin.study.track.track import READINGS, track

GYRO = READINGS.index("r")
# shorter than what the smooth motion of a tanker holds; forty times its gyro's usual scatter
PERIOD_S, SWING_DEGPS = 4.0, 0.15


def rippled(voyage):
    """The same voyage with ripples that only the gyro shows, on the courses of the second half."""
    late = voyage.time_s > 0.5 * (voyage.time_s[0] + voyage.time_s[-1])
    swing = SWING_DEGPS * np.sin(2.0 * np.pi * voyage.time_s / PERIOD_S) * late
    return replace(
        voyage, columns=dict(voyage.columns) | {"yaw_rate_degps": voyage["yaw_rate_degps"] + swing}
    )


@pytest.fixture(scope="module")
def ripples(voyages):
    return rippled(voyages["RudderWear"])


def test_each_reading_has_its_own_scatter_at_each_moment(ripples, tanker):
    quiet_s = 8.0 * float(tanker.scale("time"))
    t = track(ripples, tanker)
    seen, half = shaken(t, float(tanker.scale("time"))).ripple, 0.5 * t.t[-1]
    calm, rough = t.t < half - quiet_s, t.t > half + quiet_s
    shown = seen[:, GYRO] * t.sd[GYRO]
    assert shown[rough].mean() == pytest.approx(np.radians(SWING_DEGPS), rel=0.25)
    assert np.all(seen[:, :GYRO] == 1.0) and np.all(seen[calm, GYRO] == 1.0)


def test_one_wild_reading_is_no_unrest(voyages, tanker):
    t, time = track(voyages["RudderWear"], tanker), float(tanker.scale("time"))
    wild = t.measured.copy()
    wild[len(t) // 2, :GYRO] += 1000.0 * t.sd[:GYRO]
    assert shaken(t, time).ripple is None and shaken(replace(t, measured=wild), time).ripple is None


def test_ripples_that_one_instrument_shows_are_no_rough_world_and_the_cause_is_found_in_them(
    ripples, voyages, tanker
):
    still, rippling = (assemble([v], tanker) for v in (voyages["RudderWear"], ripples))
    assert all(x.track.ripple is None for x in still.lines)
    assert all(x.track.ripple is not None for x in rippling.lines)
    assert rippling.noise_model == still.noise_model

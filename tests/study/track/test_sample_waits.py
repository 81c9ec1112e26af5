"""The step of a track: what the instruments give, however close the rows of a merged log stand."""

import numpy as np
import pytest

from twin.study.track.sample_waits import LONGEST_HOLD_S, hold_s_of, shortest_wait_s
from twin.study.track.track import track

OF_THE_RECEIVER = ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps")


def merged(voyage, late_s):
    """The same voyage as a bus records it: each message of the receiver has a row of its own."""
    none = np.full(len(voyage), np.nan)
    time_s = np.concatenate([voyage.time_s, voyage.time_s + late_s])
    columns = {
        n: np.concatenate([none, x] if n in OF_THE_RECEIVER else [x, none]) for n, x in voyage.columns.items()
    }
    order = np.argsort(time_s)
    return voyage.with_rows(time_s[order], {n: x[order] for n, x in columns.items()})


def test_a_merged_log_has_the_steps_of_its_instruments_and_not_of_its_rows(make, kvlcc2):
    """Test: rows 0.2 and 1.05 s apart by turns, instruments once in 1.25 s. Expected: the steps of
    the even table, and its motion, where the receiver's stamps are 0.2 s later."""
    even = make(seed=3)
    rows = merged(even, 0.2)
    assert rows.step_s < 0.9 * even.step_s
    a, b = track(even, kvlcc2), track(rows, kvlcc2)
    assert b.h == pytest.approx(a.h) and abs(len(a) - len(b)) <= 1
    n = min(len(a), len(b))
    off = np.hypot(*(a.state[:n, :2] - b.state[:n, :2]).T)
    assert np.median(off) == pytest.approx(0.2 * np.median(a.state[:n, 3]), rel=0.05)
    assert b.whole.mean() > 0.95


def test_the_shortest_wait_is_that_of_the_channel_that_is_read_most_often(make):
    voyage = merged(make(seed=3), 0.2)
    rare = voyage.columns["yaw_rate_degps"].copy()
    rare[np.flatnonzero(np.isfinite(rare))[::2]] = np.nan
    voyage = voyage.with_rows(voyage.time_s, voyage.columns | {"yaw_rate_degps": rare})
    usual = float(np.median(np.diff(make(seed=3).time_s)))
    assert shortest_wait_s(voyage, ("yaw_rate_degps", "north_m")) == pytest.approx(usual, rel=1e-6)
    assert shortest_wait_s(voyage, ("yaw_rate_degps",)) == pytest.approx(2.0 * usual, rel=1e-6)
    assert shortest_wait_s(voyage, ("roll_deg",)) == voyage.step_s


def test_a_control_is_held_through_short_holes_or_until_its_next_sample(make):
    voyage = make(seed=3)
    assert hold_s_of(voyage, "rudder_angle_deg") == LONGEST_HOLD_S
    assert hold_s_of(voyage, "roll_deg") == LONGEST_HOLD_S
    seldom = np.where(np.arange(len(voyage)) % 8 == 0, voyage["rudder_angle_deg"], np.nan)
    slow = voyage.with_rows(voyage.time_s, voyage.columns | {"rudder_angle_deg": seldom})
    assert hold_s_of(slow, "rudder_angle_deg") == pytest.approx(1.5 * 8 * voyage.step_s, rel=1e-3)

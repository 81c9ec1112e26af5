"""Holes in a voyage, of minutes to months: both sides are judged, nothing is made up between them, and what
was lost is said."""

import json

import numpy as np
import pytest

from twin.errors import DataError
from twin.num import as_given
from twin.physics.model import Model
from twin.recording.holes import pieces, slopes, steps_on
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.prediction.open_loop_comparison import compare
from twin.study.reference.seaway import swung
from twin.study.track.track import moved_as_read, track

MIDDLE = 750.0  # s, of the voyages of 1500 s
STEP_S = 1.2541  # of the voyages that `make` makes
HOLES_S = (2400.0, 87000.0, 7e6)  # a day to the second is a clock that was set


def with_hole(voyage, seconds, at_s=MIDDLE):
    """The logger stood still for so long, while the ship sailed on."""
    return voyage.with_rows(
        np.where(voyage.time_s < at_s, voyage.time_s, voyage.time_s + seconds), voyage.columns
    )


def blind(voyage, first_s, last_s, *names):
    """The same without some channels for a while."""
    gone = (voyage.time_s >= first_s) & (voyage.time_s < last_s)
    return voyage.with_rows(
        voyage.time_s, {n: np.where(gone, np.nan, x) if n in names else x for n, x in voyage.columns.items()}
    )


@pytest.mark.parametrize("hole_s", HOLES_S)
def test_both_sides_of_a_hole_are_judged_as_if_the_logger_had_stood_still_for_a_moment(
    make, sailed, kvlcc2, hole_s
):
    """Test: a hole from forty minutes to three months. Expected: the errors of the whole voyage, and data
    checks with the seconds."""
    whole = compare([sailed(make(seed=1))], Model.of(kvlcc2)).result
    found = compare([sailed(with_hole(make(seed=1), hole_s))], Model.of(kvlcc2))
    for row, known in zip(found.result["horizons"], whole["horizons"], strict=True):
        assert row["position_mae_m"] == pytest.approx(known["position_mae_m"], rel=0.2)
        assert 0.75 * known["windows"] < row["windows"] <= known["windows"]
    assert max(found.result["unexplained_force"].values()) < 0.01
    gaps = next(c for c in found.result["data_checks"] if c["check"] == "time_gaps")
    assert not gaps["ok"] and f"{as_given(hole_s + STEP_S)} s" in gaps["text"]
    assert {w["start_s"] < MIDDLE for w in found.result["worst_windows"]} == {True, False}
    json.dumps(found.result, allow_nan=False)


@pytest.mark.parametrize("hole_s", HOLES_S)
def test_the_motion_on_both_sides_is_what_it_is_without_the_hole_and_no_step_between_is_believed(
    make, kvlcc2, hole_s
):
    voyage = make(seed=2)
    alone, holed = track(voyage, kvlcc2), track(with_hole(voyage, hole_s), kvlcc2)
    assert len(holed) < len(alone) + 700.0 / alone.h, "the middle of a hole takes no memory"
    between = (holed.t > MIDDLE) & (holed.t < MIDDLE + hole_s - 2.0)
    assert not holed.whole[between].any() and holed.whole[~between].mean() > 0.99
    inside = holed.t < MIDDLE - 100.0
    np.testing.assert_allclose(
        holed.state[inside], alone.state[: np.count_nonzero(inside)], rtol=1e-4, atol=1e-3
    )
    u = holed.state[:, 3]
    assert u.min() > 0.0 and u.max() < 12.0, "no speed is made up of the distance that the hole lies over"
    assert np.isfinite(swung(holed, Model.of(kvlcc2)).state).all()


def test_a_diagnosis_reads_both_sides_of_a_hole(make, kvlcc2):
    found = diagnose([with_hole(make(seed=3), 40000.0)], kvlcc2)
    assert found.result["verdict"] in ("undecided", "nothing_missing"), "nothing is wrong with it"
    assert not found.result["moments"] and not found.result["missing"]
    parts = {t > MIDDLE for line in found.case.lines for t in line.track.t[line.track.whole]}
    assert parts == {True, False}


@pytest.mark.parametrize("first_s, last_s", [(400.0, 1000.0), (900.0, 1e9), (-1.0, 600.0)])
def test_a_receiver_or_a_compass_that_is_out_for_long_breaks_the_track_while_it_is(
    make, sailed, kvlcc2, first_s, last_s
):
    """Test: place and speeds, or compass and gyro, are missing for ten minutes, at the end or from the begin;
    helm and shaft are there."""
    place = ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps")
    for names in (place, ("heading_true_north_deg", "yaw_rate_degps")):
        t = track(voyage := blind(make(seed=4), first_s, last_s, *names), kvlcc2)
        inside = (t.t > max(first_s, 0.0) + 5.0) & (t.t < min(last_s, t.t[-1]) - 5.0)
        assert not t.whole[inside].any() and t.whole[~inside].mean() > 0.95
        assert np.isfinite(t.state).all()
        errors = compare([sailed(voyage)], Model.of(kvlcc2)).result["horizons"]
        assert errors[0]["position_mae_m"] < 2.0 * errors[0]["noise_floor"]["position_mae_m"]


def test_a_slow_receiver_is_no_hole(make, kvlcc2):
    """Test: place and speeds once in four minutes, six ship lengths. Expected: the track is whole."""
    voyage = make(seed=5, seconds=3000.0)
    rare = np.arange(len(voyage)) % 192 > 0
    names = ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps")
    voyage = voyage.with_rows(
        voyage.time_s, {n: np.where(rare, np.nan, x) if n in names else x for n, x in voyage.columns.items()}
    )
    assert track(voyage, kvlcc2).whole.mean() > 0.9


def test_the_grid_of_a_voyage_without_holes_has_every_step():
    time_s = 5.0 + np.arange(0.0, 1000.0, 0.7)
    np.testing.assert_array_equal(
        steps_on(time_s, 0.5, 600.0), np.arange(int(np.floor((time_s[-1] - 5.0) / 0.5)) + 1)
    )


@pytest.mark.parametrize("hole_s", [599.0, 601.0, 1e5, 3e8])
def test_the_grid_keeps_so_much_of_a_hole_and_stays_in_step(hole_s):
    time_s = np.r_[np.arange(0.0, 100.0), 99.0 + hole_s + np.arange(100.0)]
    k = steps_on(time_s, 0.3, 600.0)
    assert (np.diff(k) > 0).all() and k[-1] == int(time_s[-1] / 0.3)
    assert 0.3 * k.size <= 200.0 + min(hole_s, 600.0) + 1.0
    assert np.isin(np.rint(time_s[[0, 99, 100, -2]] / 0.3).astype(int), k).all()


def test_pieces_end_at_holes_and_their_slopes_know_nothing_of_each_other():
    there = np.ones(100, bool)
    there[40:70] = False
    assert pieces(there, 31) == [(0, 100)] and pieces(there, 30) == [(0, 40), (70, 100)]
    there[50:52] = True
    assert pieces(there, 5) == [(0, 40), (70, 100)], "two readings tell of no motion"
    values = np.where(np.arange(100) < 55, 3.0 * np.arange(100), 1e6 + 5.0 * np.arange(100))
    slope = slopes(values, [(0, 40), (70, 100)], 0.5)
    assert slope[39] == pytest.approx(6.0) and slope[70] == pytest.approx(10.0)
    assert 6.0 < slope[55] < 10.0


def test_readings_of_a_heading_alone_do_not_say_where_she_was():
    measured = np.full((400, 8), np.nan)
    measured[:, 2], measured[:100, :2], measured[300:, :2] = 0.1, 1.0, 1.0
    whole = moved_as_read(measured, 1.0, 10.0)
    assert whole[:98].all() and not whole[100:299].any() and whole[301:].all()


@pytest.mark.parametrize("name", ("north_m", "heading_true_north_deg"))
def test_a_voyage_that_was_made_without_place_or_heading_is_refused_in_one_line(make, kvlcc2, name):
    """Test: a voyage made in Python that has no such column. Expected: a word, no error of linear algebra."""
    voyage = make()
    bare = voyage.with_rows(voyage.time_s, {n: x for n, x in voyage.columns.items() if n != name})
    with pytest.raises(DataError, match="place and heading together"):
        track(bare, kvlcc2)

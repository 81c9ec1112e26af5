"""How far a healthy ship is usually off: a density that scores properly, that a ship file keeps, and that
knows only the past of a voyage."""

from dataclasses import replace

import numpy as np
import pytest

from twin.errors import SettingsError
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load, save
from twin.study.prediction.envelope import WIDEST, sailed, widening
from twin.study.prediction.left_out import horizons, path_error
from twin.study.prediction.openloop import MODEL, predict
from twin.study.prediction.own_water import settled
from twin.study.prediction.path_prior import errors_of, prior
from twin.study.reference.between import BetweenVoyages
from twin.study.reference.derivatives import noted
from twin.study.reference.path_error import CHANNELS, PathError, of_ship, tail
from twin.study.reference.structure import once_off
from twin.study.track.track import track

AHEAD = (10.0, 60.0, 120.0)


@pytest.fixture(scope="module")
def known():
    """Errors that grow with the time, place and heading in step; no log on board."""
    sd = np.array([1.0, 2.0, 0.02, 0.05, 0.05, 1e-4, np.nan, np.nan])
    R = np.eye(8)
    R[1, 2] = R[2, 1] = 0.6
    covariance = np.array([R * np.outer(sd, sd) * k**2 for k in (1.0, 4.0, 9.0)])
    return PathError(
        np.array(AHEAD),
        covariance,
        np.array([0.1, 0.2, 0.3]),
        5.0,
        np.outer([1.0, 4.0, 9.0], [2.0, 1.5, 0.02]),
        3,
        {"speed": (5.0, 7.0)},
    )


def test_the_density_of_one_reading_is_a_density(known):
    across = np.linspace(-400.0, 400.0, 80001)
    error = np.full((across.size, 8), np.nan)
    error[:, CHANNELS.index("across")] = across
    assert np.trapezoid(np.exp(known.log_density(error, 60.0)), across) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("factor", [0.5, 0.8, 1.25, 2.0])
def test_no_other_width_scores_better_than_the_true_one(known, factor):
    """Test: 20 000 errors drawn from the density itself. Expected: the mean log density is highest for it."""
    rng, S = np.random.default_rng(0), known.at(60.0)[:6, :6] * (known.tail - 2.0) / known.tail
    drawn = (
        rng.standard_normal((20000, 6))
        @ np.linalg.cholesky(S).T
        / np.sqrt(rng.chisquare(known.tail, 20000) / known.tail)[:, None]
    )
    error = np.column_stack([drawn, np.full((20000, 2), np.nan)])
    other = replace(known, covariance=known.covariance * factor**2)
    assert known.log_density(error, 60.0).mean() > other.log_density(error, 60.0).mean()
    assert known.log_density(error, 60.0).mean() > known.log_density(error, 60.0, factor).mean()


def test_a_large_error_costs_less_than_a_normal_density_would_have_it(known):
    far = np.full((1, 8), np.nan)
    far[0, 0] = 20.0 * np.sqrt(known.at(60.0)[0, 0])
    at = np.zeros((1, 8)) * far
    assert (
        known.log_density(np.nan_to_num(at) + np.where(np.isnan(far), np.nan, 0.0), 60.0)[0]
        - known.log_density(far, 60.0)[0]
        < 20.0
    )


def test_between_and_beyond_the_horizons_errors_grow_as_they_did(known):
    # halfway in the logarithm from 1 m to 4 m
    assert np.sqrt(known.at(24.5)[0, 0]) == pytest.approx(2.0, abs=0.01)
    assert np.sqrt(known.at(240.0)[0, 0]) == pytest.approx(18.0) and np.sqrt(
        known.at(240.0)[3, 3]
    ) == pytest.approx(0.45)
    assert known.expected("position_m", [5.0, 10.0, 240.0]) == pytest.approx([1.0, 2.0, 36.0])


def test_windows_of_one_voyage_that_are_alike_count_for_fewer(known):
    assert known.effective(10.0, 120.0) == pytest.approx(10.0 / 3.7) and known.effective(1.0, 120.0) == 1.0


def test_voyages_that_differ_more_make_longer_tails():
    assert tail([1.0, 1.0, 1.0, 1.0]) > tail([]) > tail([0.3, 3.0, 0.4, 2.5])


def test_a_ship_file_keeps_it_and_compare_expects_what_it_says(known, kvlcc2, tmp_path):
    save(noted(kvlcc2, "structural", {"path_error": known.entry()}), tmp_path / "s.toml")
    again = of_ship(load(tmp_path / "s.toml"))
    assert (
        np.allclose(again.covariance, known.covariance, rtol=1e-4, equal_nan=True)
        and again.sailed == known.sailed
    )
    assert once_off(load(tmp_path / "s.toml"), "heading_deg", np.array([60.0])) == pytest.approx(
        [np.degrees(0.08)]
    )
    assert of_ship(kvlcc2) is None


def test_a_damaged_record_is_one_clear_line(known, kvlcc2):
    broken = known.entry() | {"alike": [0.1]}
    with pytest.raises(SettingsError, match=r"path_error in the ship file is damaged.*Calibrate"):
        of_ship(noted(kvlcc2, "structural", {"path_error": broken}))


def test_instruments_that_the_references_lacked_are_taken_from_the_voyages_own_noise(known, kvlcc2, make):
    t = track(make(), kvlcc2)
    ship = noted(kvlcc2, "structural", {"path_error": known.entry()})
    both = errors_of(ship, [t], AHEAD)
    assert np.isfinite(both.covariance).all() and both.covariance[1, 0, 0] == pytest.approx(
        known.covariance[1, 0, 0], rel=1e-4
    )
    assert errors_of(kvlcc2, [t], AHEAD).voyages == 0


def test_beyond_what_was_sailed_errors_may_be_wider(kvlcc2, make):
    windows = predict(track(make(), kvlcc2), Model.of(kvlcc2), AHEAD)
    ranges = sailed([windows], 60.0)
    inside, beyond = (
        widening(windows, 60.0, ranges),
        widening(windows, 60.0, ranges | {"rudder_size": (0.0, 5.0)}),
    )
    assert np.median(inside) == 1.0 and beyond.max() > 2.0 and beyond.max() <= WIDEST


def test_a_stream_is_known_from_the_past_alone(kvlcc2, make):
    """Test: a stream of 0.3 m/s, and the same voyage with its last third elsewhere. Expected: late windows
    are mended by what came before, and no earlier one changes."""
    t, model = track(make(find("Current").absent(kvlcc2).but(east=0.3)), kvlcc2), Model.of(kvlcc2)
    S = prior(model, [t], AHEAD).at(120.0)
    windows = predict(t, model, AHEAD)
    mended = settled(windows, model, S, 120.0).windows
    k, late = windows.at(120.0), t.t[windows.start] > 600.0
    assert np.nanmean(mended.errors()["position"][k, late]) < 0.5 * np.nanmean(
        windows.errors()["position"][k, late]
    )
    moved = replace(windows, seen=np.where(t.t[:, None] > 1000.0, windows.seen + 50.0, windows.seen))
    early = t.t[windows.start] < 1000.0
    assert np.array_equal(
        settled(moved, model, S, 120.0).windows.promised[MODEL][:, early], mended.promised[MODEL][:, early]
    )


def test_the_record_is_of_voyages_that_a_model_was_not_fitted_to(kvlcc2, make):
    """Test: three voyages, each predicted by a model of its own, of which the last errs. Expected: its error
    is in the record."""
    tracks, model = [track(make(seed=k, name=str(k)), kvlcc2) for k in range(3)], Model.of(kvlcc2)
    wrong = model.but(find("HullFouling").absent(kvlcc2).but(extra=0.4))
    right, other = (path_error(model, tracks, (model, model, last)) for last in (model, wrong))
    assert list(right.horizons_s) == horizons(model, tracks) and right.voyages == 3
    assert other.expected("position_m", [120.0])[0] > 1.5 * right.expected("position_m", [120.0])[0]
    assert other.tail <= right.tail and (np.linalg.eigvalsh(other.at(120.0)) > 0.0).all()


def test_what_one_voyage_says_is_taken_back_when_it_is_left_out():
    from twin.study.reference.between import ship_of

    told = [BetweenVoyages(np.array([[4.0]]), np.array([4.0 * z]), 0.0) for z in (1.0, 1.0, -3.0)]
    whole = ship_of(told, np.zeros(1), np.zeros(1))[0]
    without = ship_of(told[:2], np.zeros(1), np.zeros(1))[0]
    assert whole == pytest.approx([-4.0 / 13.0]) and without == pytest.approx([8.0 / 9.0])


def test_errors_of_a_model_that_ran_away_still_have_a_density(known):
    """Test: two channels that err as one by 200 km, kept with the digits of a ship file, which leave the matrix
    no covariance. Expected: a finite density, and no other for the usual errors."""
    sd = np.array([1.7e5, 2.4e5, 0.5, 2.1e5, 2.1e5, 1e-4])
    R = np.eye(6)
    R[3, 4] = R[4, 3] = R[0, 3] = R[3, 0] = R[0, 4] = R[4, 0] = 1.0
    S = np.full((3, 8, 8), np.nan)
    S[:, :6, :6] = R * np.outer(sd, sd)
    S[:, 3, 4] *= 1.0 + 1e-6
    S[:, 4, 3] = S[:, 3, 4]
    error = np.full((1, 8), np.nan)
    error[0, :6] = sd
    assert np.isfinite(replace(known, covariance=S).log_density(error, 60.0)).all()

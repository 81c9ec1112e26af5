"""The plain least-squares fit that the twin is measured against has no handicap of the measurement's making."""

from dataclasses import replace

import numpy as np
import pytest

from bench.real.fossen_fit import (
    KNOWN,
    STEP_S,
    begins,
    columns,
    errors,
    fitted,
    in_whole_windows,
    of_twin,
    regressors,
)
from bench.small_boats import sailed as small_boat
from bench.small_boats import ship_of

TRUE = [
    np.array([0.9, -0.12, -0.05, 0.02, 0.004]),
    np.array([-0.4, -0.25, -0.3, 0.1, 0.002, 0.01]),
    np.array([0.2, -0.6, -0.4, 0.05, 0.03, -0.003]),
]


def sailed(seconds, phase):
    """A boat that obeys these equations, recorded without noise; it is under way when its run begins and ends."""
    t = np.arange(0.0, seconds, STEP_S)
    c = {n: np.zeros_like(t) for n in ("x", "y", "psi", "u", "v", "r")} | {"t": t}
    c["X"] = 20.0 + 8.0 * np.sin(0.31 * t + phase)
    c["Y"] = 6.0 * np.sin(0.23 * t + 2.0 * phase)
    c["N"] = 5.0 * np.sin(0.17 * t + 3.0 * phase)
    now = np.array([0.0, 0.0, 0.4, 1.6, 0.1, 0.1])
    for k in range(t.size):
        for name, value in zip(("x", "y", "psi", "u", "v", "r"), now, strict=True):
            c[name][k] = value
        _, _, psi, u, v, r = now
        forces = regressors(*(np.float64(q) for q in (u, v, r, c["X"][k], c["Y"][k], c["N"][k])))
        over_ground = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi), r
        now = now + STEP_S * np.array(
            [*over_ground, *(np.dot(a, b) for a, b in zip(TRUE, forces, strict=True))]
        )
    return c


@pytest.fixture(scope="module")
def runs():
    return [sailed(40.0, phase) for phase in (0.0, 1.0, 2.0)]


def test_short_runs_under_way_give_the_numbers_that_they_were_sailed_with(runs):
    """Expected: the mean over a second falls to nothing nowhere, at the ends of a run neither."""
    for found, true in zip(fitted(runs), TRUE, strict=True):
        assert found == pytest.approx(true, rel=0.05, abs=0.03)


def test_a_run_shorter_than_the_mean_says_nothing(runs):
    short = {n: q[:6] for n, q in runs[0].items()}
    for with_it, without in zip(fitted([*runs, short]), fitted(runs), strict=True):
        assert with_it == pytest.approx(without)


def test_the_model_that_was_sailed_is_right_in_every_window(runs):
    place, turn = errors(runs[0], TRUE, 10.0, begins(runs[0], 10.0))
    assert place.size == 3 and place == pytest.approx(0.0, abs=1e-9) and turn == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", ["x", "psi", "u", *KNOWN[3:]])
def test_a_window_with_a_hole_is_left_out_and_not_counted_as_far_off(runs, name):
    """Test: a hole at the start of the second window and within its inputs. Expected: NaN, no distance; the
    first window ends there and has one, too, where its end must be known."""
    c = {n: q.copy() for n, q in runs[0].items()}
    c[name][98:105] = np.nan
    place, _ = errors(c, TRUE, 10.0, begins(c, 10.0))
    ends_in_it = name in ("x", "psi", *KNOWN[3:])
    assert np.isnan(place).tolist() == [ends_in_it, True, False]
    left = in_whole_windows({"least squares": np.array([place, place]), "twin": np.ones((2, 3))})
    assert {n: off.shape[1] for n, off in left.items()} == dict.fromkeys(left, 1 if ends_in_it else 2)


def test_a_fit_that_runs_away_is_far_off_and_no_hole(runs):
    wild = [10.0 * np.abs(t) for t in TRUE]
    place, turn = errors(runs[0], wild, 30.0, begins(runs[0], 30.0))
    assert place == pytest.approx(1e9) and turn == pytest.approx(180.0)


def test_the_twin_and_the_fit_are_compared_in_the_same_windows():
    """Test: a thruster of a small catamaran was not recorded for six seconds. Expected: the windows over it count
    for neither."""
    voyage, ship = small_boat("thrusters", 3, 60.0), ship_of("thrusters")
    pulse = voyage["port.pwm_us"].copy()
    pulse[(voyage.time_s > 22.0) & (voyage.time_s < 28.0)] = np.nan
    begun = []
    for v in (voyage, replace(voyage, columns=dict(voyage.columns) | {"port.pwm_us": pulse})):
        c, (begin, twin) = columns(v, ship), of_twin(v, ship, 10.0)
        off = in_whole_windows({"least squares": errors(c, TRUE, 10.0, begin)} | twin)
        assert off["least squares"].shape == off["twin"].shape == off["noise"].shape
        begun.append((begins(c, 10.0).size, begin.size, off["twin"].shape[1]))
    assert begun == [(5, 5, 5), (5, 4, 4)]

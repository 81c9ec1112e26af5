"""The filter's covariance, of a ship that runs away by itself."""

import numpy as np
import pytest

from twin.study.estimation.filters import STATES, Filters, NoiseVariances, RunsAway, Stretches

STEPS, SEED = 400, 5


def unstable(growth: float, read_every: int, steps: int = STEPS) -> Filters:
    """One segment of a ship whose yaw rate grows `growth` times in a step, its six states read now and then."""
    draw = np.random.default_rng(SEED)
    F = np.eye(STATES) * 0.97 + 0.02 * draw.standard_normal((STATES, STATES))
    F[5, 5] = growth
    H = np.zeros((steps, 1, 8, STATES))
    here = np.zeros((steps, 1, 8), bool)
    H[::read_every, :, :6, :6], here[::read_every, :, :6] = np.eye(6), True
    told = Stretches(
        F=np.broadcast_to(F, (steps, 1, STATES, STATES)).copy(), H=H, here=here,
        shown=np.zeros((steps, 1, 8, 1)), pushed=np.zeros((steps, 1, 6, 1), np.float32),
        spread=np.zeros((steps, 1, 6, 3), np.float32), turns={},
    )  # fmt: skip
    noise = NoiseVariances(np.full((steps, 1, 1, 8), 1e-5), np.full((steps, 1, 1, STATES), 1e-6))
    return Filters(told, noise, np.eye(STATES)[None, None] * 0.1)


def by_joseph(filters: Filters) -> np.ndarray:
    """The last covariance by the textbook's recursion, which keeps a covariance one however it is rounded."""
    told, C = filters.told, filters.C[0, 0].copy()
    for k in range(STEPS):
        H, R = told.H[k, 0], np.diag(filters.unread[k, 0, 0])
        K = np.linalg.solve(H @ C @ H.T + R, H @ C).T
        I_KH = np.eye(STATES) - K @ H
        C = I_KH @ C @ I_KH.T + K @ R @ K.T
        C = told.F[k, 0] @ C @ told.F[k, 0].T + np.diag(filters.noise.new[k, 0, 0])
        C = 0.5 * (C + C.T)
    return C


@pytest.mark.parametrize("read_every", [1, 2])
def test_the_covariance_of_an_unstable_ship_stays_one_over_a_long_segment(read_every):
    filters = unstable(1.64, read_every)
    expected = by_joseph(filters)
    for k in range(STEPS):
        filters.correct(k)
        filters.advance(k)
    assert np.linalg.eigvalsh(filters.C[0, 0]).min() > 0.0
    assert filters.C[0, 0] == pytest.approx(expected, rel=1e-6, abs=1e-12)


def test_a_model_that_runs_away_between_two_readings_is_refused_in_one_line():
    filters = unstable(30.0, 40)
    with pytest.raises(RunsAway, match=r"runs away.*Check mass") as error:
        for k in range(STEPS):
            filters.correct(k)
            filters.advance(k)
    assert "\n" not in str(error.value)

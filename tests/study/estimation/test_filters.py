"""The filter's covariance, of a ship that runs away by itself."""

import numpy as np
import pytest

from twin.study.estimation.filters import (
    STATES,
    Filters,
    NoiseVariances,
    RunsAway,
    Stretches,
    lower_inverse,
)

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
        spread=np.zeros((steps, 1, 6, 3), np.float32),
        turned=np.zeros(0, int), turns=np.zeros((steps, 1, 0, 8), np.float32),
    )  # fmt: skip
    noise = NoiseVariances(np.full((steps, 1, 1, 8), 1e-5), np.full((steps, 1, 1, STATES), 1e-6))
    return Filters(told, noise, np.eye(STATES)[None, None] * 0.1)


def by_joseph(filters: Filters) -> np.ndarray:
    """The last covariance by the textbook's recursion, which keeps a covariance one however it is rounded."""
    told, C = filters.stretches, filters.C[0, 0].copy()
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


def test_of_faults_of_several_instruments_each_column_is_as_if_it_were_alone():
    draw, P = np.random.default_rng(SEED), 4
    turns = {j: draw.standard_normal((1, 2, 8, 8)).astype(np.float32) for j in (0, 3, 2)}
    shown, one = draw.standard_normal((1, 2, 8, 1 + P)).astype(np.float32), unstable(1.0, 1, 1).stretches

    def white(some):
        two = {
            name: np.repeat(getattr(one, name), 2, axis=1) for name in ("F", "H", "here", "pushed", "spread")
        }
        noise = NoiseVariances(np.full((1, 1, 2, 8), 1e-2), np.zeros((1, 1, 2, STATES)))
        turns = np.concatenate([np.zeros((1, 2, 0, 8), np.float32), *some.values()], axis=2)
        told = Stretches(shown=shown, turned=np.array(list(some), int), turns=turns, **two)
        filters = Filters(told, noise, np.tile(np.eye(STATES), (1, 2, 1, 1)))
        filters.X[...] = 0.1
        return filters.correct(0)[0]

    none, every = white({}), white(turns)
    for j, turn in turns.items():
        assert every[..., 1 + j] == pytest.approx(white({j: turn})[..., 1 + j], rel=1e-5)
        assert np.abs(every[..., 1 + j] - none[..., 1 + j]).max() > 0.1
    assert np.array_equal(every[..., [0, 2]], none[..., [0, 2]])


@pytest.mark.parametrize("n", [1, 2, 3, 5, 8, 11])
def test_a_lower_triangle_is_inverted_as_by_a_general_inverse(n: int) -> None:
    draw = np.random.default_rng(SEED).standard_normal((3, 4, n, n))
    L = np.linalg.cholesky(draw @ draw.swapaxes(-1, -2) + np.eye(n))
    np.testing.assert_allclose(lower_inverse(L), np.linalg.inv(L), rtol=1e-10, atol=1e-12)

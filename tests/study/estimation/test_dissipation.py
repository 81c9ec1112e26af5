"""A fitted hull takes energy out of every motion, whatever short voyages seem to tell."""

import numpy as np
import pytest
from scipy.optimize import minimize

from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.estimation.box import within
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.dissipation import KEPT, half_spaces, power

SHIPS = ("kvlcc2", "container", "usv")


def unknowns_of(ship):
    return core_unknowns(Model.of(ship))


def with_z(ship, unknowns, z):
    return ship.with_derivatives(**{u.name: u.centre + u.sd * x for u, x in zip(unknowns, z, strict=True)})


@pytest.mark.parametrize("name", SHIPS)
def test_every_bundled_ship_takes_energy_out_of_every_motion(name):
    ship = load(name)
    spaces = half_spaces(ship, unknowns_of(ship))
    assert len(spaces.rows) > 100
    assert (spaces.least < 0.0).all()  # its own numbers stand at zero, inside all of them


def test_what_is_held_is_the_power_of_the_damping_itself():
    """Test: derivatives drawn about the bundled ship's, power at random motions without the linear terms.
    Expected: where every half-space is kept, next to nothing feeds the motion (between two directions a
        hundredth); without them much does."""
    ship = load("usv")
    unknowns = unknowns_of(ship)
    spaces = half_spaces(ship, unknowns)
    rng = np.random.default_rng(3)
    motion = rng.uniform(-1.0, 1.0, (3, 400)) * np.array(
        [[1.5 * ship.U_0], [ship.U_0], [ship.U_0 / ship.L_pp]]
    )
    drawn = 3.0 * rng.standard_normal((60, len(unknowns)))
    kept = [within(z, np.eye(len(unknowns)), np.array([-9.0 + 0 * z, 9.0 + 0 * z]), spaces) for z in drawn]
    fed = [power(with_z(ship, unknowns, z), *motion).min() for z in drawn]
    assert np.mean([x < 0.0 for x in fed]) > 0.8
    linear = {"X_u": 0.0, "Y_v": 0.0, "N_r": 0.0}
    left = [power(with_z(ship, unknowns, z).with_derivatives(**linear), *motion) for z in kept]
    assert all(p.min() > -0.01 * p.max() for p in left)
    assert np.mean([(p < 0.0).mean() for p in left]) < 0.002


def test_a_tenth_of_the_first_models_damping_is_kept_in_the_direction_that_data_would_turn_round():
    ship = load("usv")
    unknowns = unknowns_of(ship)
    names = [u.name for u in unknowns]
    wrong = np.zeros(len(unknowns))
    j = names.index("Y_vv")
    wrong[j] = (0.5 - unknowns[j].centre) / unknowns[j].sd  # sway that its own damping would feed
    far = 99.0 + 0 * wrong
    z = within(wrong, np.eye(wrong.size), np.array([-far, far]), half_spaces(ship, unknowns))
    found = unknowns[j].centre + unknowns[j].sd * z[j]
    assert KEPT * unknowns[j].centre >= found - 1e-9 and found < 0.0


def test_the_nearest_place_inside_box_and_half_spaces_is_the_one_another_solver_finds():
    rng = np.random.default_rng(0)
    for _ in range(4):
        B = rng.standard_normal((5, 5))
        C, mean = B @ B.T + 0.1 * np.eye(5), 2.0 * rng.standard_normal(5)
        rows = rng.standard_normal((7, 5))
        least = -0.5 * np.abs(rng.standard_normal(7))
        z = within(mean, C, np.array([np.full(5, -1.5), np.full(5, 1.5)]), (rows, least))
        P = np.linalg.inv(C)
        other = minimize(
            lambda x, P=P, m=mean: 0.5 * (x - m) @ P @ (x - m),
            np.zeros(5),
            bounds=[(-1.5, 1.5)] * 5,
            constraints={"type": "ineq", "fun": lambda x, R=rows, b=least: R @ x - b},
            method="SLSQP",
            options={"ftol": 1e-12, "maxiter": 500},
        )
        assert z == pytest.approx(other.x, abs=1e-4)

"""The core against oracles that were derived another way."""

from math import cos, radians, sin

import numpy as np
import pytest
import sympy

from twin.physics import core
from twin.physics.model import Model
from twin.physics.ship import bundled, load
from twin.physics.state import Situation

ships = pytest.mark.parametrize("name", bundled())


def matrices(ship):
    """M of Fossen (2021) ch. 3 and 6, rigid body and added mass."""
    d, mass = ship.derivatives, 0.5 * ship.rho * ship.L_pp**2 * ship.T
    rigid = np.array([[ship.m, 0, 0], [0, ship.m, ship.m * ship.x_G], [0, ship.m * ship.x_G, ship.I_z]])
    L = ship.L_pp
    added = -mass * np.array(
        [[d.X_udot, 0, 0], [0, d.Y_vdot, d.Y_rdot * L], [0, d.N_vdot * L, d.N_rdot * L**2]]
    )
    return rigid, added


def coriolis_matrix(M, nu):
    """C(nu) from M, Fossen (2021) ch. 3, for a surface ship: skew-symmetric."""
    a1 = M[0, 0] * nu[0]
    a2 = M[1, 1] * nu[1] + M[1, 2] * nu[2]
    return np.array([[0, 0, -a2], [0, 0, a1], [a2, -a1, 0]])


@ships
def test_inertia_is_symmetric_and_positive_definite(name):
    rigid, added = matrices(load(name))
    for M in (rigid, rigid + added):
        assert np.allclose(M, M.T, rtol=1e-12) and np.all(np.linalg.eigvalsh(M) > 0.0)


@ships
def test_components_agree_with_fossens_matrices(name):
    ship = load(name)
    rigid, added = matrices(ship)
    nu = np.array([0.8 * ship.U_0, -0.15 * ship.U_0, 0.4 * ship.U_0 / ship.L_pp])
    want = -coriolis_matrix(rigid, nu) @ nu - coriolis_matrix(added, nu) @ nu
    np.testing.assert_allclose(core.coriolis(*nu, ship.c), want, rtol=1e-9)
    tau = np.array([0.01, 0.02, 0.005 * ship.L_pp]) * ship.m
    np.testing.assert_allclose(
        core.accelerations(*tau, ship.c), np.linalg.solve(rigid + added, tau), rtol=1e-9
    )


@ships
def test_coriolis_forces_do_no_work(name):
    ship = load(name)
    nu = (0.7 * ship.U_0, 0.2 * ship.U_0, -0.5 * ship.U_0 / ship.L_pp)
    forces = core.coriolis(*nu, ship.c)
    power = sum(f * v for f, v in zip(forces, nu, strict=True))
    assert abs(power) < 1e-9 * sum(abs(f * v) for f, v in zip(forces, nu, strict=True))


def test_the_equations_follow_from_lagrange(ship):
    """Kirchhoff's equations from the kinetic energy T = 1/2 nu' M nu: d/dt T_v + w x T_v = 0, d/dt T_w + w x
    T_w + v x T_v = 0."""
    u, v, r = sympy.symbols("u v r", real=True)
    rates = sympy.symbols("du dv dr", real=True)
    rigid, added = matrices(ship)
    nu = sympy.Matrix([u, v, r])
    T = (nu.T * sympy.Matrix(rigid + added) * nu)[0] / 2
    momentum = [sympy.diff(T, q) for q in (u, v, r)]
    ddt = [sum(sympy.diff(p, q) * dq for q, dq in zip((u, v, r), rates, strict=True)) for p in momentum]
    p_u, p_v, _ = momentum
    equations = [ddt[0] - r * p_v, ddt[1] + r * p_u, ddt[2] + u * p_v - v * p_u]
    numbers = {u: 4.0, v: -0.5, r: 0.012}
    solved = sympy.solve([e.subs(numbers) for e in equations], rates)
    mine = core.accelerations(*core.coriolis(4.0, -0.5, 0.012, ship.c), ship.c)
    np.testing.assert_allclose(mine, [float(solved[q]) for q in rates], rtol=1e-9)


@ships
def test_the_hull_brakes_in_every_direction_a_ship_goes(name):
    ship = load(name)
    U, R = ship.U_0, ship.U_0 / ship.L_pp
    for u, v, r in (
        (1, 0, 0),
        (-1, 0, 0),
        (0, 0.5, 0),
        (0, -0.5, 0),
        (0, 0, 0.8),
        (0, 0, -0.8),
        (1, -0.15, 0.4),
        (1, 0.15, -0.4),
    ):
        force = core.damping(u * U, v * U, r * R, ship.c)
        assert force[0] * u * U + force[1] * v * U + force[2] * r * R < 0.0, (u, v, r)


@ships
def test_a_starboard_rudder_turns_to_starboard_and_a_drifting_hull_turns_broadside(name):
    ship = load(name)
    thrust = core.thrust(ship.U_0, 1.2 * ship.U_0 / ship.D_P, ship.c)
    X, Y, N = core.rudder(ship.U_0, 0.0, 0.0, radians(10), thrust, ship.c)
    assert X < 0.0 and Y < 0.0 and N > 0.0  # brakes, pushes the stern to port, turns to starboard
    munk = core.coriolis(ship.U_0, 0.1 * ship.U_0, 0.0, ship.c)
    assert munk[2] < 0.0  # drifting to starboard turns the bow to port


def test_the_thrust_by_hand(ship):
    # K_T = 0.4 - 0.4 J with J = 0.75 x 4/(2 x 4) = 0.375: K_T = 0.25, T = 1000 x 4 x 256 x 0.25
    assert core.thrust(4.0, 2.0, ship.c) == pytest.approx(256000.0)
    assert core.propeller(256000.0, ship.c)[0] == pytest.approx(204800.0)
    assert core.thrust(4.0, -2.0, ship.c) < -256000.0  # backing against the stream loads the blades more


def test_the_damping_by_hand(ship):
    ship = ship.with_derivatives(X_uuu=-0.03)
    f, L, d = 0.5 * 1000 * 100 * 5, 100.0, ship.derivatives
    u, v, r = 4.0, -0.5, 0.012
    slow = (9.80665 * L) ** 0.5
    X = f * (
        (d.X_u * slow + d.X_uu * 4 + d.X_uuu * 16 / slow) * u
        + d.X_vv * 0.25
        + d.X_vr * L * v * r
        + d.X_rr * L**2 * r**2
    )
    Y = f * (d.Y_v * slow * v + d.Y_uv * 4 * v + d.Y_ur * L * 4 * r + d.Y_vv * 0.5 * v + d.Y_vr * L * 0.5 * r)
    Y += f * (d.Y_rv * L * 0.012 * v + d.Y_rr * L**2 * 0.012 * r)
    N = f * L * (d.N_uv * 4 * v + d.N_vv * 0.5 * v + d.N_vr * L * 0.5 * r + d.N_rv * L * 0.012 * v)
    N += f * L**2 * (d.N_r * slow * r + d.N_ur * 4 * r + d.N_rr * L * 0.012 * r)
    assert core.damping(u, v, r, ship.c) == pytest.approx((X, Y, N))


def test_a_uniform_current_carries_everything_along(ship):
    """Galileo: the same voyage seen from the water and from the shore, where the water moves."""
    from twin.physics.effects import find

    north, east, psi = 0.6, -0.4, 0.8
    still, carried = Model(ship), Model(ship, (find("Current")(north=north, east=east),))
    through = (0.0, 0.0, psi, 4.0, -0.3, 0.01)
    u_c, v_c = north * cos(psi) + east * sin(psi), east * cos(psi) - north * sin(psi)
    over = (0.0, 0.0, psi, 4.0 + u_c, -0.3 + v_c, 0.01)
    for _ in range(200):
        through = still.step(through, Situation(delta=0.3, n=2.0), 0.5)
        over = carried.step(over, Situation(delta=0.3, n=2.0), 0.5)
    assert over[2] == pytest.approx(through[2], rel=1e-6) and over[5] == pytest.approx(through[5], rel=1e-6)
    assert over[0] - north * 100.0 == pytest.approx(through[0], abs=1e-3)
    assert over[1] - east * 100.0 == pytest.approx(through[1], abs=1e-3)


def test_the_integrator_is_of_fourth_order(ship):
    def after(h):
        state = (0.0, 0.0, 0.0, 4.0, -0.3, 0.01)
        for _ in range(round(32.0 / h)):
            state = Model(ship).step(state, Situation(delta=0.3, n=2.0), h)
        return np.array(state)

    exact = after(0.125)
    coarse, fine = (np.abs(after(h) - exact).max() for h in (8.0, 4.0))
    assert 10.0 < coarse / fine < 26.0


def test_a_ship_without_thrust_comes_to_rest(ship):
    state = (0.0, 0.0, 0.0, 4.0, -0.3, 0.01)
    for _ in range(4000):
        state = Model(ship).step(state, Situation(delta=0.1, n=0.0), 1.0)
    assert 0.0 < state[3] < 0.2 and abs(state[4]) < 0.05


@pytest.mark.parametrize("grown", [(0.0, 0.0), (0.4, 0.2)])
def test_the_force_for_an_acceleration_gives_that_acceleration(ship, grown):
    tau = (2e5, -7e5, 3e7)
    np.testing.assert_allclose(
        core.force_for(*core.accelerations(*tau, ship.c, grown), ship.c, grown), tau, rtol=1e-12
    )

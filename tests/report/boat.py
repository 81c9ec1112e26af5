"""A small boat's voyage under its own model: straight on with a turn in the middle, a table of measurements."""

from math import degrees, radians

import numpy as np

import twin
from twin.physics.model import Model
from twin.physics.state import Situation

SECONDS, STEP_S = 100.0, 0.1


def straight_with_a_turn(path, seed):
    """Path of the table. `seed`: of its noise; its first heading is half as many radians."""
    ship, rng = twin.Ship.load("usv"), np.random.default_rng(seed)
    model, n = Model.of(ship), 0.9 * ship.U_0 / (0.7 * ship.D_P)
    state, rows = (0.0, 0.0, 0.5 * seed, 0.8 * ship.U_0, 0.0, 0.0), []
    for k in range(round(SECONDS / STEP_S)):
        rudder = 6.0 if 40.0 <= k * STEP_S < 44.0 else 0.0
        x, y, psi, u, v, r = state
        noise = rng.normal(size=6) * (0.05, 0.05, 0.1, 0.01, 0.01, 0.1)
        measured = np.array([x, y, degrees(psi) % 360.0, u, v, degrees(r)]) + noise
        rows.append([k * STEP_S, *measured, rudder, 60.0 * n, 0.01])
        state = model.step(state, Situation(delta=radians(rudder), n=n), STEP_S)
    names = (
        "time_s,north_m,east_m,heading_true_north_deg,surge_velocity_mps,sway_velocity_mps,yaw_rate_degps,"
        "rudder_angle_deg,propeller_rate_rpm,wave_height_significant_m"
    )
    np.savetxt(path, rows, delimiter=",", header=names, comments="", fmt="%.6f")
    return str(path)

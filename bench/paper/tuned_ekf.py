"""The paper's EKF, at its best: filterpy's, on the nominal equations, with slow disturbances, told the
current, tuned on validation runs.

State: x, y, psi, u, v, r and the accelerations that no known force explains. The Jacobian is by differences
    through Model.step.
Tuned: how fast the disturbance may walk (three sizes), and whether the prediction keeps it.
"""

from collections.abc import Sequence

import numpy as np

from bench.paper.lab import LabCourse, grounded, judge
from bench.tick.ekf import ShipFilter
from export.batches import STRIDE
from twin.physics import core
from twin.physics.model import Model
from twin.physics.state import Force, Situation
from twin.study.track.track import READINGS

WALKS = (1e-6, 1e-5, 1e-4)  # of the disturbance, in units of U/T for one grid step
MEASURED_STATES = [READINGS.index(n) for n in ("x", "y", "psi", "u_r", "v_r", "r")]
NUDGE = np.array([0.1, 0.1, 1e-4, 1e-3, 1e-3, 1e-6])


class Careful(ShipFilter):
    """The same filter with an exact Jacobian, and noises in the ship's own sizes."""

    def __init__(self, model: Model, s: Situation, h: float, sd: np.ndarray, walk: float):
        super().__init__(model, s, h)
        U, T = float(model.ship.U_0), float(model.ship.scale("time"))
        a = np.array([U / T, U / T, 1.0 / T**2])
        self.R = np.diag(sd**2)
        self.P = np.diag(np.concatenate([10 * sd**2, (0.05 * a) ** 2]))
        self.Q = np.diag(np.concatenate([[1e-6] * 2, [1e-12], (3e-4 * h * a) ** 2, walk * a**2]))

    def _linearise(self, state: list[float]) -> None:
        columns = np.array(state[:6])[:, None] + np.column_stack([np.diag(NUDGE), -np.diag(NUDGE)])
        out = np.stack([np.broadcast_to(x, 12) for x in self.model.step(tuple(columns), self.s, self.h)])
        self.F[:6, :6] = (out[:, :6] - out[:, 6:]) / (2.0 * NUDGE)


def filtered(c: LabCourse, model: Model, walk: float) -> np.ndarray:
    """(W, 9) the filter's state at the starts of the windows."""
    view, measured = c.water, c.floating.measured[:, MEASURED_STATES]
    inputs = {
        name: x
        for name, x in view.inputs.items()
        if name in ("delta", "n", "wind_speed", "wind_to", "H_s", "T_p", "wave_to")
    }
    kalman = Careful(model, Situation(), view.h, c.floating.sd[MEASURED_STATES], walk)
    kalman.x[:6], kept = view.state[0], {}
    for k in range(int(c.starts[-1]) + 1):
        if k:
            kalman.s = Situation(**{name: float(0.5 * (x[k - 1] + x[k])) for name, x in inputs.items()})
            kalman.predict()
        there = np.isfinite(measured[k])
        kalman.R[np.diag_indices(6)] = np.where(there, c.floating.sd[MEASURED_STATES] ** 2, 1e9)
        kalman.update(
            np.where(there, measured[k], kalman.x[:6]), HJacobian=kalman._jacobian, Hx=kalman._expected
        )
        kept[k] = kalman.x.copy()
    return np.stack([kept[int(k)] for k in c.starts])


def predict(courses: Sequence[LabCourse], model: Model, walk: float, keep: bool) -> list[np.ndarray]:
    """(T, W, 3) for each course from the filter's state, its disturbance kept or dropped."""
    return [_from(c, model, filtered(c, model, walk), keep) for c in courses]


def _from(c: LabCourse, model: Model, state: np.ndarray, keep: bool) -> np.ndarray:
    run = _pushed(c, model, state if keep else np.concatenate([state[:, :6], 0.0 * state[:, 6:]], 1))
    run[..., :2] += state[:, :2] - c.water.state[c.starts, :2]
    return run


def _pushed(c: LabCourse, model: Model, state: np.ndarray) -> np.ndarray:
    """The free run with the filter's accelerations held as forces."""
    view, at = c.water, c.at
    force = Force(*core.force_for(*state[:, 6:].T, model.c))
    pushed = Model(model.ship, model.effects, lambda s: force)
    now, kept = (np.zeros(len(state)), np.zeros(len(state)), *state[:, 2:6].T), []
    for k in range(c.steps):
        s = Situation(**{n: 0.5 * (x[at[k]] + x[at[k + 1]]) for n, x in view.inputs.items()})
        now = pushed.step(now, s, STRIDE * view.h)
        kept.append(np.stack(now[:3], -1))
    return grounded(np.stack(kept), c, view)


def tuned(courses: Sequence[LabCourse], model: Model) -> tuple[float, bool]:
    """The walk and the choice that predict validation voyages best (heading and lateral errors, each over its
    least)."""
    tried = {}
    for walk in WALKS:
        states = [filtered(c, model, walk) for c in courses]
        for keep in (False, True):
            tried[walk, keep] = judge(
                [_from(c, model, x, keep) for c, x in zip(courses, states, strict=True)], courses
            )
    heading = {k: e.heading_deg.mean() for k, e in tried.items()}
    lateral = {k: e.lateral_m.mean() for k, e in tried.items()}
    return min(tried, key=lambda k: heading[k] / min(heading.values()) + lateral[k] / min(lateral.values()))

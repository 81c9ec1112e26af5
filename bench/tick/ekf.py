"""The classical peer: filterpy's extended Kalman filter on the twin's own equations, and a slow disturbance.

State: x, y, psi, u, v, r and the accelerations X/m, Y/m, N/I that no known force explains (random walks). The
state is predicted by the same Model.step as the twin's; the Jacobian is that of the kinematics with the
damping held constant, the cheapest that serves.
"""

from math import cos, sin

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter

from twin.physics.model import Model
from twin.physics.state import Situation


class ShipFilter(ExtendedKalmanFilter):
    """`tick(z)` with z = (x, y, psi, u, v, r) measured: predict, then correct."""

    def __init__(self, model: Model, situation: Situation, step_s: float):
        super().__init__(dim_x=9, dim_z=6)
        self.model, self.s, self.h = model, situation, step_s
        self.x = np.zeros(9)
        self.x[3] = situation.u
        self.P *= 0.1
        self.Q = np.diag([1e-4] * 6 + [1e-6] * 3)
        self.R = np.diag([1.0, 1.0, 1e-4, 1e-2, 1e-2, 1e-6])
        self.H = np.eye(6, 9)
        self.F = np.eye(9)
        self.F[range(3, 6), range(6, 9)] = step_s

    def predict_x(self, u: object = 0) -> None:
        """The model one step on, pushed by the disturbance; and the Jacobian there."""
        state = self.x.tolist()
        ahead = self.model.step(tuple(state[:6]), self.s, self.h)
        push = [self.h * a for a in state[6:]]
        self._linearise(state)
        self.x[:3] = ahead[:3]
        self.x[3:6] = [a + b for a, b in zip(ahead[3:], push, strict=True)]

    def tick(self, measured: np.ndarray) -> None:
        self.predict()
        self.update(measured, HJacobian=self._jacobian, Hx=self._expected)

    def _linearise(self, state: list[float]) -> None:
        _, _, psi, u, v, _, *_ = state
        c, s, h, F = cos(psi), sin(psi), self.h, self.F
        F[0, 2], F[0, 3], F[0, 4] = h * (-u * s - v * c), h * c, -h * s
        F[1, 2], F[1, 3], F[1, 4] = h * (u * c - v * s), h * s, h * c
        F[2, 5] = h

    def _jacobian(self, x: np.ndarray) -> np.ndarray:
        return self.H

    def _expected(self, x: np.ndarray) -> np.ndarray:
        return x[:6]

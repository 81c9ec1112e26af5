"""The helmsman of every ship of a fleet: follows the legs, orders rudder and propeller rate."""

import numpy as np

from bench.reference.mmg import limit
from bench.reference.trial_legs import COURSE, RUDDER, ZIGZAG


def wrap(angle):
    """Angle in radians to [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


class Autopilot:
    """Heading, yaw rate and speed in; rudder order [rad] and propeller rate [1/s] out.

    Course keeping by PD with a slow integral, gains by the ship's time L/U0; not above 25 degrees of rudder.
    """

    def __init__(self, plans, h, n_start, heading):
        count, self.h, self.n_start = max(map(len, plans)), h, n_start
        table = np.full((5, len(plans), count), np.inf)
        for i, plan in enumerate(plans):
            table[:, i, : len(plan)] = np.array(
                [(start, leg.mode, leg.a, leg.b, leg.rate) for leg, start in plan]
            ).T
        self.start, self.mode, self.a, self.b, self.rate = table
        self.a, self.b = np.radians(self.a), np.radians(self.b)
        self.rows, self.index = np.arange(len(plans)), np.full(len(plans), -1)
        self.course, self.base = heading.copy(), heading.copy()
        self.side, self.integral = np.ones(len(plans)), np.zeros(len(plans))
        self.held = np.ones(len(plans), bool)

    def _begin(self, psi, new):
        """Take up the next leg where it is due."""
        i = self.index + new
        mode, a = self.mode[self.rows, i], self.a[self.rows, i]
        self.course = np.where(
            new, np.where(self.held, self.course, psi) + np.where(mode == COURSE, a, 0), self.course
        )
        self.base, self.side = np.where(new, psi, self.base), np.where(new, 1.0, self.side)
        self.base = np.where(new & self.held, self.course - np.where(mode == COURSE, a, 0), self.base)
        self.integral, self.held = np.where(new, 0.0, self.integral), np.where(new, mode == COURSE, self.held)
        self.index = i

    def order(self, t, psi, r, u, dt):
        """Rudder order and propeller rate order at time t."""
        following = np.minimum(self.index + 1, self.start.shape[1] - 1)
        new = (self.start[self.rows, following] <= t + 1e-9) & (following > self.index)
        if new.any():
            self._begin(psi, new)
        mode, a, b = (f[self.rows, self.index] for f in (self.mode, self.a, self.b))
        unit = self.h.unit
        error = wrap(self.course - psi)
        near = np.abs(error) < 0.2
        self.integral = limit(self.integral + np.where(near, error * dt / (20 * unit), 0), -0.1, 0.1)
        pilot = limit(1.2 * error - 1.4 * unit * r + self.integral, -0.436, 0.436)
        swing = wrap(psi - self.base) * np.sign(a) * self.side
        self.side = np.where((mode == ZIGZAG) & (swing >= b), -self.side, self.side)
        rudder = np.where(mode == RUDDER, a, np.where(mode == ZIGZAG, a * self.side, pilot))
        rate = self.rate[self.rows, self.index] * self.n_start
        return rudder, np.where((rate < 0) & (u < 0.02 * self.h.U0), 0.0, rate)

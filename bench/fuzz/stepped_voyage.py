"""A ship that sails by its own equations, step by step of 0.1 s, worked out as far as somebody asks."""

from math import degrees, pi, radians, sin

from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import Situation

STEP_S = 0.1
SIZES = {  # one standard deviation of what an instrument adds
    "north_m": 0.3,
    "east_m": 0.3,
    "heading_true_north_deg": 0.05,
    "surge_velocity_mps": 0.03,
    "sway_velocity_mps": 0.03,
    "yaw_rate_degps": 0.003,
    "rudder_angle_deg": 0.05,
    "propeller_rate_rpm": 0.1,
    "wave_height_significant_m": 0.0,
}
CHANNELS = tuple(SIZES)


class SteppedVoyage:
    """The truth at step k, and what healthy instruments say of it: the same for the same k."""

    def __init__(self, ship: Ship):
        self.model, self.shaft = Model.of(ship), 0.9 * ship.U_0 / (0.7 * ship.D_P)
        self._states = [(0.0, 0.0, radians(40.0), 0.8 * ship.U_0, 0.0, 0.0)]
        self._rudders = [0.0]

    def truth(self, k: int) -> tuple[tuple[float, ...], float]:
        """(north, east, psi, u, v, r) in SI and the rudder in degrees."""
        while len(self._states) <= k:
            order = 15.0 if sin(2.0 * pi * STEP_S * len(self._states) / 160.0) >= 0.0 else -15.0
            rudder = self._rudders[-1] + max(min(order - self._rudders[-1], 0.25), -0.25)
            s = Situation(delta=radians(rudder), n=self.shaft)
            self._states.append(tuple(self.model.step(self._states[-1], s, STEP_S)))
            self._rudders.append(rudder)
        return self._states[k], self._rudders[k]

    def said(self, k: int) -> dict[str, float]:
        """By channel, in border units."""
        (x, y, psi, u, v, r), rudder = self.truth(k)
        values = (x, y, degrees(psi), u, v, degrees(r), rudder, 60.0 * self.shaft, 0.0)
        noisy = {
            name: value + SIZES[name] * _spread(k, i)
            for i, (name, value) in enumerate(zip(CHANNELS, values, strict=True))
        }
        noisy["heading_true_north_deg"] %= 360.0
        return noisy


def _spread(k: int, i: int) -> float:
    """Something like a normal number, of k and i alone."""
    n = (k * 9 + i + 1) * 2654435761
    return 1.2 * sum(((n >> shift) % 1009) / 504.0 - 1.0 for shift in (3, 11, 19))

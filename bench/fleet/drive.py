"""What drives and steers a ship: propeller, engine, rudder, each in one of a few forms that are drawn."""

from dataclasses import dataclass
from math import atan2, cos, exp, pi, sin, tanh

import numpy as np

from bench.fleet.random_particulars import RHO, Particulars


@dataclass
class Propulsion:
    """Numbers of propeller, engine and rudder of one ship (all random), and the forms that were drawn."""

    p: Particulars
    thrust_form: str  # linear, quadratic, quadrants
    k: tuple[float, float, float]  # of the thrust coefficient over the advance
    t: float  # thrust deduction
    w: float  # wake
    w_drift: float  # by which share of it drift takes away
    droop: float  # share of shaft speed lost where the load is heavier
    engine_s: float
    apart: float  # of two propellers [m]
    lift: float  # slope of the rudder's lift
    stall: float  # angle of stall [rad]
    straighten: float  # flow straightening
    a_H: float  # the hull's share of the rudder's force
    x_R: float  # of the rudder over L
    slip: float  # share of the propeller's race that meets the rudder
    rate: float  # of the gear [rad/s]
    gear_s: float
    dead: float  # band [rad]
    ordered: bool  # is the order recorded, or the feedback?
    n0: float = 1.0  # service shaft speed [1/s]

    @staticmethod
    def draw(p: Particulars, rng: np.random.Generator) -> "Propulsion":
        k0 = 0.30 * (p.pitch / 0.8) * rng.uniform(0.9, 1.1)
        boat = p.L < 30
        d = Propulsion(
            p,
            str(rng.choice(["linear", "quadratic", "quadrants"])),
            (
                k0,
                -k0 / (1.1 * p.pitch) * rng.uniform(0.75, 0.95),
                -k0 / (1.1 * p.pitch) ** 2 * rng.uniform(0.1, 0.25),
            ),
            rng.uniform(0.1, 0.22),
            (0.5 * p.C_b - 0.02) * rng.uniform(0.7, 1.1),
            rng.uniform(0.0, 1.0),
            rng.choice([0.0, 0.0, 0.02, 0.05]) * 1.0,
            rng.uniform(0.5, 2.0) if boat else rng.uniform(5.0, 20.0),
            0.45 * p.B if p.propellers == 2 else 0.0,
            rng.uniform(2.2, 3.0),
            np.radians(rng.uniform(28, 42)),
            rng.uniform(0.4, 0.75),
            rng.uniform(0.1, 0.4),
            rng.uniform(-0.51, -0.46),
            rng.uniform(0.5, 1.0),
            np.radians(rng.uniform(12, 30) if boat else rng.uniform(2.3, 4.5)),
            rng.uniform(0.1, 0.3) if boat else rng.uniform(0.3, 1.5),
            np.radians(rng.choice([0.0, 0.0, 0.3])),
            bool(rng.random() < 0.3),
        )
        return d

    def coefficient(self, J: float) -> float:
        """Thrust coefficient over n^2 D^4 at an advance J > 0 of a propeller that turns ahead."""
        k0, k1, k2 = self.k
        if self.thrust_form == "linear":
            return k0 + (k1 + 0.6 * k2) * J
        if self.thrust_form == "quadratic":
            return k0 + k1 * J + k2 * J * J
        beta = atan2(J, 0.7 * pi)  # of the blade at 0.7 of its radius
        root = (J * J + (0.7 * pi) ** 2) * (pi / 8)
        zero = atan2(1.0 * self.p.pitch * 1.1, 0.7 * pi)
        top = k0 / ((0.7 * pi) ** 2 * pi / 8)
        return root * top * (sin(zero - beta) / sin(zero)) * (1 + 0.25 * sin(beta) * cos(2 * beta))

    def thrust(self, n: float, u: float, drift: float) -> tuple[float, float]:
        """Thrust of all propellers [N] before deduction, and the speed of the water that enters them."""
        D, k = self.p.D_P, self.p.propellers
        u_in = u * (1 - self.w * (1 - self.w_drift * (1 - exp(-4.0 * abs(drift)))))
        J = max(u_in, 0.0) / max(abs(n) * D, 1e-6)
        T = k * RHO * n * n * D**4 * self.coefficient(min(J, 3.0))
        return (T if n >= 0 else -0.65 * T), u_in

    def turned(self, n: float, u: float) -> float:
        """Shaft speed that a drooping engine keeps [1/s]."""
        return n * (1 - self.droop * tanh(2 * (1 - u / self.p.U0 * self.n0 / max(n, 0.1 * self.n0))))

    def rudder(self, delta: float, u_in: float, v: float, r: float, T: float, u: float) -> float:
        """Normal force of the rudder [N]."""
        A = pi / 4 * self.p.D_P**2 * self.p.propellers
        race = (max(u_in * u_in + 2 * max(T, 0.0) / (RHO * A), 0.0)) ** 0.5
        u_R = (1 - self.slip) * abs(u_in) + self.slip * (abs(u_in) + 0.6 * (race - abs(u_in)))
        v_R = self.straighten * (v + 1.5 * self.x_R * self.p.L * r)
        alpha = delta - atan2(-v_R, max(u_R, 1e-3)) if u_R > 0 else delta
        eff = (
            alpha
            if abs(alpha) < self.stall
            else (1 if alpha > 0 else -1) * self.stall * exp(-1.5 * (abs(alpha) - self.stall))
        )
        return 0.5 * RHO * self.p.A_R * self.lift * (u_R * u_R + v_R * v_R) * sin(eff)

    def balance(self, resistance: float) -> "Propulsion":
        """The shaft speed that drives the ship at service speed."""
        lo, hi = 0.01, 200.0
        for _ in range(60):
            mid = (lo * hi) ** 0.5
            T, _ = self.thrust(mid, self.p.U0, 0.0)
            lo, hi = (mid, hi) if (1 - self.t) * T < resistance else (lo, mid)
        self.n0 = (lo * hi) ** 0.5
        return self

"""The families of hulls: each answers what water does to a hull that moves with (u, v, r) through it [N, N,
N m]. Of these the twin's core can be `modulus` and, with its cross-flow drag, `strip`.

  mmg       polynomials of v' and r' of third and fourth order (Yasukawa & Yoshimura 2015)
  abkowitz  Taylor series about straight sailing, in dimensional speed (Abkowitz 1964)
  modulus   second-order modulus, |v| v, |v| r, |r| r (Norrbin 1971)
  strip     slender-body lift, and cross-flow drag integrated along a hull whose drag varies (Faltinsen 1990)
  surface   a random smooth surface over drift and turn, port and starboard alike: no formula at all
  memory    lift that follows the flow late, as a vortex sheet does (Wagner's function, two lags)
  planing   small craft: a hump of resistance, sternward lift, trim that moves the centre of effort
  heeling   a polynomial that changes as the ship heels
"""

from collections.abc import Callable
from math import atan2, exp, hypot, sin

import numpy as np

from bench.fleet.random_particulars import RHO, LinearHull, Particulars
from bench.fleet.resistance import hump, power_law, waving

Force = tuple[float, float, float]
Draw = np.random.Generator


class FleetHull:
    """A hull of one family. `heel` [rad] is the ship's, where the family asks for it."""

    def __init__(self, p: Particulars, a: LinearHull, resistance: Callable[[float], float]) -> None:
        self.p, self.a, self.resistance = p, a, resistance
        self.area = 0.5 * RHO * p.L * p.T

    def start(self) -> None:
        """Forget what went before (a new voyage)."""

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        raise NotImplementedError

    def inertia(self) -> Force:
        """Added masses and inertia [kg, kg, kg m2]."""
        scale = self.area * self.p.L
        return self.a.m_x * scale, self.a.m_y * scale, self.a.J_z * scale * self.p.L**2


class Mmg(FleetHull):
    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance)
        b = 2 * p.C_b * p.B / p.L
        self.x = (
            -rng.uniform(0.02, 0.07),
            b * rng.uniform(-0.1, 0.1),
            rng.uniform(0.0, 0.02),
            rng.uniform(0.2, 0.8),
        )
        self.y = (
            -rng.uniform(0.9, 1.9),
            rng.uniform(0.0, 0.5),
            -rng.uniform(0.2, 0.5),
            rng.uniform(-0.02, 0.02),
        )
        self.n = (
            -rng.uniform(0.0, 0.1),
            -rng.uniform(0.15, 0.35),
            rng.uniform(-0.02, 0.06),
            -rng.uniform(0.005, 0.03),
        )

    def poly(self, u: float, v: float, r: float) -> tuple[float, Force]:
        U = max(hypot(u, v), 0.05 * self.p.U0)
        v, r = v / U, r * self.p.L / U
        a, (xvv, xvr, xrr, x4), y, n = self.a, self.x, self.y, self.n
        X = xvv * v * v + xvr * v * r + xrr * r * r + x4 * v**4
        Y = a.Y_v * v + a.Y_r * r + y[0] * v**3 + y[1] * v * v * r + y[2] * v * r * r + y[3] * r**3
        N = a.N_v * v + a.N_r * r + n[0] * v**3 + n[1] * v * v * r + n[2] * v * r * r + n[3] * r**3
        return self.area * U * U, (X, Y, N)

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        q, (X, Y, N) = self.poly(u, v, r)
        return q * X - self.resistance(u), q * Y, q * self.p.L * N


class Heeling(Mmg):
    """The same, and heel gives a side force and a moment, and more of both with drift and turn."""

    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance, rng)
        self.h = (
            rng.uniform(-0.02, 0.05),
            -rng.uniform(0.0, 0.04),
            rng.uniform(-0.6, 0.6),
            rng.uniform(-0.3, 0.3),
            -rng.uniform(0, 0.2),
        )

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        q, (X, Y, N) = self.poly(u, v, r)
        U = max(hypot(u, v), 0.05 * self.p.U0)
        b, t = v / U, r * self.p.L / U
        Y += self.h[0] * heel + self.h[2] * b * b * heel
        N += self.h[1] * heel + self.h[3] * t * t * heel + self.h[4] * heel * b * t
        return q * X - self.resistance(u), q * Y, q * self.p.L * N


class Abkowitz(FleetHull):
    """Derivatives at service speed, multiplied by products of (u - U0), v, r alone."""

    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance)
        self.y = (-rng.uniform(1.0, 2.5), -rng.uniform(0.2, 0.6), rng.uniform(-0.1, 0.3))
        self.n = (
            rng.uniform(0.0, 0.15),
            -rng.uniform(0.2, 0.45),
            -rng.uniform(0.01, 0.04),
            rng.uniform(-0.03, 0.05),
        )
        self.x = (-rng.uniform(0.02, 0.09), rng.uniform(0.0, 0.02), rng.uniform(-0.03, 0.06))
        self.u = rng.uniform(0.8, 1.15)

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        p, a, y, n = self.p, self.a, self.y, self.n
        s = max(u, 0.0) / p.U0
        v, r = v / p.U0, r * p.L / p.U0
        # linear terms by the first order of the speed's change, and a little beside it; the others as they
        # are
        k = 1.0 + self.u * (s - 1.0) + 0.1 * (s - 1.0) ** 2
        Y = k * (a.Y_v * v + a.Y_r * r) + y[0] * v**3 + y[1] * v * r * r + y[2] * v * v * r
        N = k * (a.N_v * v + a.N_r * r) + n[0] * v**3 + n[1] * v * v * r + n[2] * r**3 + n[3] * v * r * r
        X = self.x[0] * v * v + self.x[1] * r * r + self.x[2] * v * r
        q = self.area * p.U0**2
        return q * X - self.resistance(u), q * Y, q * p.L * N


class Modulus(FleetHull):
    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance)
        self.y = (-rng.uniform(0.4, 1.0), -rng.uniform(0.0, 0.3), -rng.uniform(0.0, 0.06))
        self.n = (-rng.uniform(0.0, 0.06), -rng.uniform(0.1, 0.3), -rng.uniform(0.01, 0.04))
        self.x = (-rng.uniform(0.0, 0.06), rng.uniform(0.0, 0.02), rng.uniform(-0.04, 0.04))

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        p, a, w = self.p, self.a, r * self.p.L
        s = abs(u)
        Y = (
            s * (a.Y_v * v + a.Y_r * w)
            + self.y[0] * abs(v) * v
            + self.y[1] * abs(v) * w
            + self.y[2] * abs(w) * w
        )
        N = (
            s * (a.N_v * v + a.N_r * w)
            + self.n[0] * abs(v) * v
            + self.n[1] * abs(v) * w
            + self.n[2] * abs(w) * w
        )
        X = self.x[0] * v * v + self.x[1] * w * w + self.x[2] * v * w
        return self.area * X - self.resistance(u), self.area * Y, self.area * p.L * N


class Strip(FleetHull):
    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance)
        x = np.linspace(-0.45, 0.45, 10)
        drag = rng.uniform(0.5, 1.0) * (
            1 + rng.uniform(0, 0.8) * (2 * x) ** 2 + rng.uniform(-0.4, 0.4) * 2 * x
        )
        self.strips = [(float(k) * p.L, float(c) * 0.1) for k, c in zip(x, drag, strict=True)]
        self.suck = rng.uniform(0.0, 0.05)

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        p, a, w = self.p, self.a, r * self.p.L
        Y = abs(u) * (a.Y_v * v + a.Y_r * w)
        N = abs(u) * (a.N_v * v + a.N_r * w) * p.L
        for x, c in self.strips:
            f = c * abs(v + x * r) * (v + x * r)
            Y -= f
            N -= x * f
        drift = atan2(v, max(u, 0.1 * p.U0))
        return (
            self.area * (abs(Y) * self.suck * sin(abs(drift)))
            - self.resistance(u)
            - 0.04 * self.area * v * v,
            self.area * Y,
            self.area * N,
        )


class Surface(FleetHull):
    """Linear near straight sailing; beyond it bumps of random place, width and height, mirrored."""

    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance)
        count = 6
        self.bumps = [
            (
                rng.uniform(-0.5, 0.5),
                rng.uniform(-0.9, 0.9),
                rng.uniform(0.15, 0.5),
                rng.uniform(0.3, 0.9),
                rng.uniform(-0.012, 0.012),
                rng.uniform(-0.06, 0.06),
                rng.uniform(-0.02, 0.02),
            )
            for _ in range(count)
        ]
        self.cube = (
            -rng.uniform(0.5, 1.3),
            -rng.uniform(0.1, 0.4),
            -rng.uniform(0.05, 0.25),
            -rng.uniform(0.005, 0.03),
        )

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        p, a = self.p, self.a
        U2 = u * u + v * v + (0.4 * r * p.L) ** 2 + (0.03 * p.U0) ** 2
        b, t = v / U2**0.5, r * p.L / U2**0.5
        X, Y, N = -0.04 * b * b, a.Y_v * b + a.Y_r * t, a.N_v * b + a.N_r * t
        Y += self.cube[0] * b * abs(b) ** 1.6 + self.cube[1] * b * abs(t) ** 1.4
        N += self.cube[2] * t * abs(b) ** 1.5 + self.cube[3] * t * abs(t) ** 1.7
        for b0, t0, wb, wt, x, y, n in self.bumps:
            one = exp(-(((b - b0) / wb) ** 2) - ((t - t0) / wt) ** 2)
            two = exp(-(((b + b0) / wb) ** 2) - ((t + t0) / wt) ** 2)
            X, Y, N = X + x * (one + two), Y + y * (one - two), N + n * (one - two)
        q = self.area * U2
        return q * X - self.resistance(u), q * Y, q * p.L * N


class MemoryHull(Modulus):
    """A share of the lift comes late by two lags."""

    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance, rng)
        self.lags = [
            (rng.uniform(0.10, 0.2), rng.uniform(0.15, 0.4)),
            (rng.uniform(0.2, 0.4), rng.uniform(0.8, 2.0)),
        ]
        self.start()

    def start(self) -> None:
        self.late = [[0.0, 0.0], [0.0, 0.0]]

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        X, Y, N = super().force(u, v, r, heel, dt)
        lift = self.area * abs(u) * self.a.Y_v * v
        turn = self.area * abs(u) * self.p.L * (self.a.N_v * v + 0.5 * self.a.N_r * r * self.p.L)
        for (share, lengths), s in zip(self.lags, self.late, strict=True):
            k = min(1.0, dt * max(abs(u), 0.1 * self.p.U0) / (lengths * self.p.L))
            s[0] += k * (lift - s[0])
            s[1] += k * (turn - s[1])
            Y += share * (s[0] - lift)
            N += share * (s[1] - turn)
        return X, Y, N


class Planing(FleetHull):
    """Trim by speed moves the centre of effort aft and lifts the keel."""

    def __init__(
        self, p: Particulars, a: LinearHull, resistance: Callable[[float], float], rng: Draw
    ) -> None:
        super().__init__(p, a, resistance)
        self.lifts, self.aft = rng.uniform(0.1, 0.35), rng.uniform(0.0, 0.05)
        self.y, self.n = (
            (-rng.uniform(0.5, 1.2), -rng.uniform(0, 0.1)),
            (-rng.uniform(0.05, 0.2), -rng.uniform(0.02, 0.06)),
        )

    def force(self, u: float, v: float, r: float, heel: float, dt: float) -> Force:
        p, a, w = self.p, self.a, r * self.p.L
        f = 1 - self.lifts * (u / p.U0) ** 2 / (1 + (u / p.U0) ** 2)
        s = (u * u + v * v) ** 0.5
        Y = s * f * (a.Y_v * v + a.Y_r * w) + self.y[0] * abs(v) * v + self.y[1] * abs(w) * w
        N = s * f * (a.N_v * v + a.N_r * w) + self.n[0] * abs(v) * w + self.n[1] * abs(w) * w
        N -= self.aft * (u / p.U0) ** 2 * Y
        return -self.resistance(u) - 0.05 * self.area * v * v, self.area * Y, self.area * p.L * N


FAMILIES = {  # what hulls, of what kinds of ship, with what resistance
    "mmg": (Mmg, ("tanker", "cargo", "container"), (power_law, waving)),
    "abkowitz": (Abkowitz, ("tanker", "cargo", "container"), (power_law, waving)),
    "modulus": (Modulus, ("tanker", "cargo", "ferry"), (power_law, waving)),
    "strip": (Strip, ("tanker", "cargo", "ferry"), (power_law, waving)),
    "surface": (Surface, ("tanker", "cargo", "container", "ferry"), (power_law, waving)),
    "memory": (MemoryHull, ("cargo", "container", "ferry"), (power_law, waving)),
    "planing": (Planing, ("boat",), (hump,)),
    "heeling": (Heeling, ("container", "ferry"), (power_law, waving)),
}

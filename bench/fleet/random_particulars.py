"""What a random ship is: its size, and the linear derivatives that a published regression gives such a ship.

Normalised by 1/2 rho L T U^2 (forces), 1/2 rho L^2 T U^2 (moments), v' = v/U, r' = r L/U. Regression:
Kijima et
al. (1990), deep water, even keel; its published scatter is about 15 %, which is drawn anew for each ship."""

from dataclasses import dataclass
from math import pi

import numpy as np

RHO = 1025.0
G = 9.81


@dataclass(frozen=True)
class Particulars:
    """A ship afloat; SI units."""

    L: float
    B: float
    T: float
    C_b: float
    U0: float  # service speed
    x_G: float  # ahead of midship
    k_zz: float  # radius of gyration over L
    D_P: float
    pitch: float  # over diameter
    A_R: float  # all rudders together
    A_F: float  # frontal and lateral areas above the water
    A_L: float
    propellers: int = 1

    @property
    def mass(self) -> float:
        return RHO * self.C_b * self.L * self.B * self.T

    @property
    def unit_s(self) -> float:
        """L/U0 [s]."""
        return self.L / self.U0


@dataclass(frozen=True)
class LinearHull:
    """Linear derivatives and added masses, without dimension."""

    Y_v: float
    Y_r: float
    N_v: float
    N_r: float
    m_x: float
    m_y: float
    J_z: float
    R_0: float  # calm resistance at service speed


KINDS = {  # length [m], L/B, B/T, block coefficient, Froude number
    "tanker": ((120.0, 330.0), (5.2, 6.3), (2.5, 3.2), (0.76, 0.85), (0.13, 0.17)),
    "cargo": ((80.0, 200.0), (5.8, 7.0), (2.3, 3.0), (0.62, 0.76), (0.17, 0.23)),
    "container": ((130.0, 350.0), (6.4, 8.0), (2.6, 3.6), (0.55, 0.66), (0.20, 0.26)),
    "ferry": ((60.0, 180.0), (5.5, 7.0), (3.2, 4.5), (0.52, 0.64), (0.22, 0.30)),
    "boat": ((6.0, 24.0), (3.0, 4.2), (3.5, 5.5), (0.38, 0.52), (0.25, 0.42)),
}


def draw(rng: np.random.Generator, kind: str) -> Particulars:
    """Random particulars inside the ranges of a kind."""
    length, l_b, b_t, block, froude = KINDS[kind]
    L = float(np.exp(rng.uniform(*np.log(length))))
    B = L / rng.uniform(*l_b)
    T = B / rng.uniform(*b_t)
    twin = int(kind in ("ferry", "boat") and rng.random() < 0.6)
    D = T * rng.uniform(0.55, 0.75) * (0.75 if twin else 1.0)
    area = L * T * rng.uniform(0.017, 0.026) * (1.4 if kind in ("ferry", "boat") else 1.0)
    tall = {"tanker": 0.045, "cargo": 0.06, "container": 0.09, "ferry": 0.11, "boat": 0.10}[kind]
    return Particulars(
        L,
        B,
        T,
        rng.uniform(*block),
        rng.uniform(*froude) * (G * L) ** 0.5,
        rng.uniform(-0.03, 0.03) * L,
        rng.uniform(0.23, 0.27),
        D,
        rng.uniform(0.65, 1.0),
        area,
        B * B * rng.uniform(0.45, 0.9),
        L * L * tall * rng.uniform(0.8, 1.2),
        1 + twin,
    )


def linear(p: Particulars, rng: np.random.Generator) -> LinearHull:
    """Derivatives by regression, each with its published scatter."""
    k, m, block = 2 * p.T / p.L, 2 * p.C_b * p.B / p.L, p.C_b * p.B / p.L

    def near() -> float:
        return float(np.exp(0.12 * rng.standard_normal()))

    m_x = m * rng.uniform(0.04, 0.09)
    m_y = m * rng.uniform(0.65, 0.95)
    return LinearHull(
        Y_v=-(0.5 * pi * k + 1.4 * block) * near(),
        Y_r=(m_x + 0.25 * m) * near(),
        N_v=-k * near(),
        N_r=-(0.54 * k - k * k) * near(),
        m_x=m_x,
        m_y=m_y,
        J_z=m * rng.uniform(0.035, 0.055),
        R_0=rng.uniform(0.016, 0.026) * (1.6 if p.L < 30 else 1.0),
    )

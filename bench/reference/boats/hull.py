"""What the water does to a hull, section by section: cross flow at each, slender-body lift that is shed where
the hull ends, friction by ITTC 1957."""

import math
from itertools import pairwise

from bench.reference.boats.craft import Craft

SECTIONS = 9
MUNK = 0.35  # of a slender body's moment that friction leaves (Hoerner 1965)
NU = 1.19e-6  # of sea water [m2/s]


class BoatHull:
    """One craft's hull or hulls; forces and inertias about midship."""

    def __init__(self, craft: Craft):
        self.c = craft
        self.sides = (-0.5 * craft.apart, 0.5 * craft.apart) if craft.apart else (0.0,)
        self.dx = craft.L / SECTIONS
        self.at = [(i + 0.5) * self.dx - 0.5 * craft.L for i in range(SECTIONS)]
        self.depth = [craft.T * self._fullness(x) for x in self.at]
        shape = 0.5 * math.pi * craft.rho * (0.7 if craft.apart else 0.9)
        self.added = [shape * d * d for d in self.depth]  # sway added mass of one hull a metre [kg/m]
        n = len(self.sides)
        self.m_y = n * sum(self.added) * self.dx
        self.m_x = 0.05 * craft.m
        self.a_y = n * sum(a * x for a, x in zip(self.added, self.at, strict=True)) * self.dx
        self.J_z = n * sum(a * x * x for a, x in zip(self.added, self.at, strict=True)) * self.dx
        self.J_z += self.m_x * (0.5 * craft.apart) ** 2
        self.I_z = craft.m * ((craft.k_zz * craft.L) ** 2 + craft.x_G**2 + (0.5 * craft.apart) ** 2)
        self.tail = -0.47 * craft.L
        self.shed = shape * (craft.T * craft.skeg) ** 2

    def _fullness(self, x: float) -> float:
        """Depth of a section as a share of the draught: a raked bow, a transom."""
        s = 2.0 * x / self.c.L
        return math.sqrt(max(1.0 - s**6, 0.05)) if s > 0 else 1.0 - (1.0 - self.c.transom) * s**4

    def resistance(self, u: float) -> float:
        """[N] against the motion ahead."""
        c = self.c
        speed = abs(u) + 1e-3
        friction = 0.075 / (math.log10(max(speed * c.L / NU, 1e4)) - 2.0) ** 2
        froude = speed / math.sqrt(9.81 * c.L)
        rest = _between(c.residuary, froude)
        return 0.5 * c.rho * c.wetted * u * speed * ((1.0 + c.form) * friction + rest)

    def force(self, u: float, v: float, r: float) -> tuple[float, float, float]:
        """(X, Y, N) at this motion through the water."""
        c, X, Y, N = self.c, 0.0, 0.0, 0.0
        for y in self.sides:
            drag = self.resistance(u - y * r) / len(self.sides)
            X, N = X - drag, N + y * drag
        cross = turn = munk = 0.0
        for x, d, a in zip(self.at, self.depth, self.added, strict=True):
            w = v + x * r
            f = 0.5 * c.rho * c.section_drag * d * w * abs(w) * self.dx
            cross, turn, munk = cross + f, turn + x * f, munk + a * w * self.dx
        n = len(self.sides)
        w = v + self.tail * r
        grip = u * u / (u * u + 4.0 * w * w + 1e-9)  # a hull that slides sideways stalls
        lift = -u * self.shed * w * grip
        Y = n * (lift - cross)
        N += n * (self.tail * lift - turn - MUNK * u * munk * grip)
        return X - 0.3 * n * abs(w) * self.shed * abs(r * w), Y, N


def _between(table: tuple[tuple[float, float], ...], at: float) -> float:
    for (x0, y0), (x1, y1) in pairwise(table):
        if at <= x1:
            return y0 + (y1 - y0) * (at - x0) / (x1 - x0)
    return table[-1][1]

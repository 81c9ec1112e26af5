"""Calm resistance over speed, in one of three forms; each is what the ship was drawn to have at service
speed."""

from collections.abc import Callable
from math import exp

import numpy as np

from bench.fleet.random_particulars import RHO, G, LinearHull, Particulars

Draw = np.random.Generator


def power_law(p: Particulars, a: LinearHull, rng: Draw) -> Callable[[float], float]:
    """Resistance by a power of speed near two."""
    k, q = rng.uniform(1.75, 2.35), 0.5 * RHO * p.L * p.T * p.U0**2 * a.R_0
    return lambda u: q * (abs(u) / p.U0) ** k * (1.0 if u > 0 else -1.3)


def waving(p: Particulars, a: LinearHull, rng: Draw) -> Callable[[float], float]:
    """Friction and waves that grow steeply."""
    share, m = rng.uniform(0.1, 0.35), rng.uniform(4.0, 5.5)
    q = 0.5 * RHO * p.L * p.T * p.U0**2 * a.R_0
    return lambda u: (
        q * ((1 - share) * (abs(u) / p.U0) ** 1.85 + share * (abs(u) / p.U0) ** m) * (1.0 if u > 0 else -1.2)
    )


def hump(p: Particulars, a: LinearHull, rng: Draw) -> Callable[[float], float]:
    """A hump at a Froude number near 0.45 over the friction."""
    high, at, wide = rng.uniform(0.2, 0.7), rng.uniform(0.36, 0.5), rng.uniform(0.08, 0.14)

    def raw(u: float) -> float:
        return u * u * (1 + high * exp(-(((u / (G * p.L) ** 0.5 - at) / wide) ** 2)))

    q = 0.5 * RHO * p.L * p.T * p.U0**2 * a.R_0 / raw(p.U0)
    return lambda u: q * raw(abs(u)) * (1.0 if u > 0 else -1.2)

"""How rare several numbers are together, told as one number's distance from none."""

import numpy as np
from scipy.special import chdtrc, ndtri

P95 = 1.96  # standard deviations of a normal distribution to either side that hold 95 % of it
TAIL_PROBABILITY = (
    1e-300  # probability below which the tail of a normal distribution is taken for its exponent alone
)


def deviations(z: np.ndarray, covariance: np.ndarray) -> float:
    """How many standard deviations one number would have to be from none to be as rare by chance as all these
    (k,) are together, with their covariance (k, k) in the same units.

        q = z' C^-1 z ~ chi squared of k numbers,   2 Phi(-deviations) = P(chi squared_k > q)

    Two numbers that are known by their difference alone are each uncertain, and together clear. Of one number
    it is |z| over its standard deviation.
    """
    q = float(z @ np.linalg.solve(covariance, z))
    tail = float(chdtrc(z.size, q))
    return float(-ndtri(0.5 * tail)) if tail > TAIL_PROBABILITY else float(np.sqrt(q))

"""How clear the numbers of an effect are, and how far from what the ship's file has."""

import numpy as np
from scipy.stats import chi2, norm

from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found

LEAST = 1e-300  # probability below which the tail of a normal distribution is taken for its exponent alone


def significance(case: Case, found: Found, name: str) -> float:
    """How many standard deviations one number would have to be from none to be as rare by chance as all
    numbers of this effect together are.

        q = z' C^-1 z ~ chi squared of k numbers,   2 Phi(-significance) = P(chi squared_k > q)

    Two numbers that are known by their difference alone (a compass bias, and what of it turned the velocity)
    are each uncertain, and together clear. Of one number it is |z| over its standard deviation.
    """
    own = np.array([i for i, u in enumerate(case.effects) if u.owner == name])
    z, C = found.posterior.z[own], found.posterior.covariance[np.ix_(own, own)]
    q = float(z @ np.linalg.solve(C, z))
    tail = float(chi2.sf(q, own.size))
    return float(norm.isf(0.5 * tail)) if tail > LEAST else float(np.sqrt(q))


def change(case: Case, found: Found, name: str) -> float:
    """How far the clearest number of an effect is from what the ship's file has, over what its form may be
    off in another manoeuvre (a gear that was found as a dead time and half a second of easing is the same
    gear with less of the one and more of the other); 0 where the file has none."""
    if name not in case.present:
        return 0.0
    form = {p.name: p.form for p in case.catalogue[name].params()}
    moved = ((u, u.sd * z) for u, z in zip(case.effects, found.posterior.z, strict=True) if u.owner == name)
    return max(abs(by) / max(form[u.name] * abs(u.centre), 1e-9 * u.sd) for u, by in moved)

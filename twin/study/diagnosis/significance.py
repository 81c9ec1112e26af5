"""How clear the numbers of an effect are, and how far from what the ship's file has."""

import numpy as np

from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found
from twin.study.estimation.rarity import deviations


def significance(case: Case, found: Found, name: str) -> float:
    """How far all numbers of this effect together are from none, as standard deviations of one (a compass
    bias, and what of it turned the velocity, are each uncertain, and their difference clear)."""
    own = np.array([i for i, u in enumerate(case.effects) if u.owner == name])
    return deviations(found.posterior.z[own], found.posterior.covariance[np.ix_(own, own)])


def change(case: Case, found: Found, name: str) -> float:
    """How far the clearest number of an effect is from what the ship's file has, over what its form may be
    off in another manoeuvre (a gear that was found as a dead time and half a second of easing is the same
    gear with less of the one and more of the other); 0 where the file has none."""
    if name not in case.present:
        return 0.0
    form = {p.name: p.form for p in case.catalogue[name].params()}
    moved = ((u, u.sd * z) for u, z in zip(case.effects, found.posterior.z, strict=True) if u.owner == name)
    return max(abs(by) / max(form[u.name] * abs(u.centre), 1e-9 * u.sd) for u, by in moved)

"""Whether what alters the ship can be a load.

A ship that is loaded otherwise has other derivatives, too, and those are numbers of the load (loading.py). It
is a load only if mass, draught and trim show beside them, and if it floats with it: what is heavier lies
deeper, by the area of its waterplane."""

import numpy as np

from twin.physics.effect import Effect, Force
from twin.physics.effects.loading import waterplane
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found
from twin.study.estimation.columns import with_values

HULL = ("X_", "Y_", "N_")  # how the names of derivatives begin
# chi squared of a load's numbers from which they are more than derivatives that differ (95 % of three)
SHOWS = 8.0
# share of its draught by which mass and draught may disagree: other water, a waterplane that is not as usual
AFLOAT = 0.02
DIFFERENCE_SD = 2.5  # standard deviations beyond which they do


def floats(case: Case, found: Found) -> bool:
    """Whether what alters the ship under a hypothesis can be a load; what does not alter it can be what it
    says."""
    own = [
        u
        for u in case.effects
        if u.owner in found.hypothesis.effects
        and u.owner not in case.unnamed
        and _alters(case.catalogue[u.owner])
        and u.name[:2] not in HULL
    ]
    if not own:
        return True
    known, mine = found.posterior, [case.effects.index(u) for u in own]
    z, C = known.z[mine], known.covariance[np.ix_(mine, mine)]
    if z @ np.linalg.solve(C, z) < SHOWS:
        return False
    before = case.model.loaded

    def deeper(z: np.ndarray) -> float:
        """Than its mass would have it, as a share of its draught."""
        after = with_values(
            case.model, own, [u.centre + u.sd * x for u, x in zip(own, z, strict=True)], case.catalogue
        ).loaded
        return float(after.T / before.T - 1.0 - (after.m / before.m - 1.0) * before.C_b / waterplane(before))

    slope = np.array([deeper(z + step) - deeper(z - step) for step in 0.01 * np.eye(z.size)]) / 0.02
    return abs(deeper(z)) < DIFFERENCE_SD * float(np.hypot(np.sqrt(slope @ C @ slope), AFLOAT))


def _alters(kind: type[Effect]) -> bool:
    return issubclass(kind, Force) and kind.alter is not Force.alter

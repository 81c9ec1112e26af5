"""Whether a hypothesis holds an effect that is none: it would help only with sizes that cannot be."""

import numpy as np

from twin.study.diagnosis.afloat import floats
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found
from twin.study.estimation.columns import Unknown


def hollow(case: Case, found: Found) -> bool:
    """Whether an effect of this set ended at nothing, or is a load that cannot be: the set says no more than
    the rest."""
    return any(nothing(case, found, name) for name in found.hypothesis.effects) or not floats(case, found)


def nothing(case: Case, found: Found, name: str) -> bool:
    """Whether an effect of this set ended at nothing (or its size did)."""
    own = [i for i, u in enumerate(case.effects) if u.owner == name and _sizes(case, u)]
    return not np.any(found.posterior.z[own])


def _sizes(case: Case, u: Unknown) -> bool:
    """Whether this number alone may be what its effect is."""
    return case.catalogue[u.owner].size in ("", u.name)

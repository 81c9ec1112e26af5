"""By how much the numbers of a healthy ship differ from one voyage to the next, before her own reference voyages
have shown it.

A form that is only roughly right is another one in each manoeuvre and at each speed, and instruments are set
anew: two or three reference voyages that agree by chance do not show it. The standard deviations (in widths
of each number's prior) are those under which healthy voyages of random ships are most probable given their
ships' references (`python -m bench.fleet variation FOLDER`, docs/results/variation.md). A ship's own references
may ask for more (between.py)."""

from collections.abc import Sequence

import numpy as np

from twin.study.estimation.columns import FORM, LATE, SEA, Unknown

# the yaw moment of a hull that turns
TURNING = ("N_vv", "N_vr", "N_rv", "N_rr")
OF_TURNING, OF_SWAY_AND_YAW, OF_CORE, OF_EFFECT = 0.3, 0.07, 0.03, 0.05
OF_EFFECTS = {"PropellerWalk": 0.2, "HeadingBias": 0.12, "SpeedLogMisalignment": 0.12}
OF_THE_VOYAGE = (LATE, SEA)  # allowed for by widths of their own


def usual_scatter(unknowns: Sequence[Unknown]) -> np.ndarray:
    """(P,) variance of each number between healthy voyages of one ship, in prior widths squared."""
    return np.array([_share(u) ** 2 for u in unknowns])


def _share(u: Unknown) -> float:
    if u.every_day or u.owner in OF_THE_VOYAGE:
        return 0.0
    if u.owner == "core":
        return OF_TURNING if u.name in TURNING else OF_SWAY_AND_YAW if u.name[0] in "YN" else OF_CORE
    return OF_CORE if u.owner == FORM else OF_EFFECTS.get(u.owner, OF_EFFECT)

"""By how much the instruments of a healthy ship differ between voyages, before its references have shown it.

A compass settles anew, and so does the flow past a log: that two or three reference voyages agree on these
shows little. The standard deviations are those under which healthy voyages of random ships are most likely,
given each ship's references (`python -m bench.fleet variation FOLDER`, docs/results/variation.md). A ship's
own references may ask for more, of these numbers and of all others (between.py)."""

from collections.abc import Sequence

import numpy as np

from twin.study.estimation.columns import Unknown

USUAL_SHARES = {  # effect: standard deviation of its numbers between voyages, in prior widths
    "HeadingBias": 0.15,
    "SpeedLogMisalignment": 0.15,
}


def usual_scatter(unknowns: Sequence[Unknown]) -> np.ndarray:
    """(P,) variance of each number between healthy voyages of one ship, in prior widths squared."""
    return np.array([USUAL_SHARES.get(u.owner, 0.0) ** 2 for u in unknowns])

"""Quantiles whose unit is the voyage: samples of one voyage are no independent witnesses.

    q = Quantile_level( sum_v 1/(V+1) sum_i 1/n_v delta(s_vi) + 1/(V+1) delta(inf) )

holds for a random moment of a new exchangeable voyage with that probability at least, whatever the
correlation within voyages (Lee, Barber & Willett 2023, arXiv:2306.06342). Finite from V >= level/(1 - level).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike


def hierarchical_quantile(voyages: Sequence[ArrayLike], level: float) -> float:
    """The score that a new voyage keeps with this probability; infinite where the voyages are too few.

    voyages: scores (N,) of each, any number of them (a voyage without a score is left out)."""
    groups = [s for v in voyages if (s := np.sort(np.asarray(v, float))).size]
    if not groups:
        return float("inf")
    scores = np.concatenate(groups)
    weights = np.concatenate([np.full(s.size, 1.0 / s.size / (len(groups) + 1)) for s in groups])
    order = np.argsort(scores, kind="stable")
    below = np.cumsum(weights[order])
    k = int(np.searchsorted(below, level * (1.0 - 1e-12)))
    return float(scores[order][k]) if k < scores.size else float("inf")

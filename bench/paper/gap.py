"""Are runs that told the training when to stop predicted better than runs that had no say? And how much of
that is the voyages'?

The same two parts are judged with a model that nothing was chosen for (the nominal ship, told the current):
what differs there differs by the voyages alone. Intervals by voyage: fifteen voyages cannot tell a twentieth.
`among_like_95` draws voyages among those of the same manoeuvre and sea: both parts hold the same by plan, so
that what these differ by is no chance of the gap."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from bench.paper.lab import HORIZON_S, Errors, LabCourse, judge

EVERY_S = 60.0  # windows in the whole of every run, not only those of the tables
Predict = Callable[[Sequence[LabCourse]], list[np.ndarray]]


def gap(
    models: dict[str, Predict],
    validation: Sequence[LabCourse],
    test: Sequence[LabCourse],
    resamples: int = 10_000,
) -> dict[str, Any]:
    """For every model the errors in both parts and the change in %, with its 95 % interval by voyage."""
    parts = {"validation": _everywhere(validation), "test": _everywhere(test)}
    out: dict[str, Any] = {"runs": {name: len(some) for name, some in parts.items()}}
    for name, predict in models.items():
        errors = {part: judge(predict(some), some) for part, some in parts.items()}
        kinds = {part: [c.name.rsplit(" ", 1)[0] for c in some] for part, some in parts.items()}
        out[name] = {
            short: change_of(errors, of, resamples) | among_like(errors, kinds, of, resamples)
            for short, of in (("heading", "heading_deg"), ("lateral", "lateral_m"))
        }
    return out


def _everywhere(courses: Sequence[LabCourse]) -> list[LabCourse]:
    return [
        replace(c, starts_s=tuple(np.arange(c.starts_s[0], c.water.t[-1] - HORIZON_S - 5.0, EVERY_S)))
        for c in courses
    ]


def change_of(errors: dict[str, Errors], of: str, resamples: int, seed: int = 1) -> dict[str, Any]:
    rng = np.random.default_rng(seed)
    means, drawn = {}, {}
    for part, e in errors.items():
        x, index = getattr(e, of), np.unique(e.voyage, return_inverse=True)[1]
        total, count = np.bincount(index, x), np.bincount(index)
        k = rng.integers(count.size, size=(resamples, count.size))
        means[part], drawn[part] = float(x.mean()), total[k].sum(1) / count[k].sum(1)
    low, high = np.quantile(100.0 * (drawn["test"] / drawn["validation"] - 1.0), (0.025, 0.975))
    return means | {
        "change_percent": 100.0 * (means["test"] / means["validation"] - 1.0),
        "by_voyage_95": [float(low), float(high)],
    }


def among_like(
    errors: dict[str, Errors], kinds: dict[str, list[str]], of: str, resamples: int, seed: int = 1
) -> dict[str, list[float]]:
    """The same interval by voyages drawn among those of their kind (manoeuvre and sea)."""
    rng, drawn = np.random.default_rng(seed), {}
    for part, e in errors.items():
        index = np.unique(e.voyage, return_inverse=True)[1]
        total, count = np.bincount(index, getattr(e, of)), np.bincount(index)
        like = [np.flatnonzero(np.array(kinds[part]) == kind) for kind in sorted(set(kinds[part]))]
        k = np.concatenate([some[rng.integers(some.size, size=(resamples, some.size))] for some in like], 1)
        drawn[part] = total[k].sum(1) / count[k].sum(1)
    low, high = np.quantile(100.0 * (drawn["test"] / drawn["validation"] - 1.0), (0.025, 0.975))
    return {"among_like_95": [float(low), float(high)]}

"""Where a model fails: conditions under which its error is larger than elsewhere, beyond chance, and its
worst windows.

Chance is judged by sliding the errors along each voyage against what went on in it (a circular shift keeps
how both hang together in time) and looking at the most striking of *all* conditions each time, so that noise
yields no regime.

Source: Westfall & Young (1993) Resampling-based multiple testing, ch. 2 (maximum statistic).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from twin.physics.ship import Ship
from twin.study.prediction.regimes import conditions, means
from twin.study.prediction.score import pooled
from twin.study.prediction.windows import MODEL, SENSORS, STRUCTURE, Windows

CHANCE = 0.05
SHIFTS = 400
# errors are judged by their logarithm, that one wild window does not decide; this much is added to each
LOG_OFFSET = 0.05
LEAST_WINDOWS_EACH = 8  # windows inside and outside a condition
RATIO = 1.15  # an error less than this above elsewhere is not worth a sentence
MAX_CONDITIONS = 8


def sizes(windows: Sequence[Windows], horizon_s: float, run: int = MODEL) -> np.ndarray:
    """(W,) one error for each window: position and heading, each over its mean of the model's errors. It
    is dimensionless."""
    errors, model = pooled(windows, horizon_s, run), pooled(windows, horizon_s)
    scaled = [errors[n] / max(float(np.nanmean(model[n])), 1e-12) for n in ("position", "heading")]
    return 0.5 * (scaled[0] + scaled[1])


def regimes(
    windows: Sequence[Windows], horizon_s: float, ship: Ship, structural: bool = False
) -> list[dict[str, Any]]:
    """[{condition, error_ratio, time_share, explains}], what explains most first.

    error_ratio: error inside over error elsewhere; explains: share of all error that stands above the level
        elsewhere.
    """
    error = sizes(windows, horizon_s)
    m = means(windows, horizon_s)
    ok = np.isfinite(error)
    if ok.sum() < 3 * LEAST_WINDOWS_EACH:
        return []
    asked = [(text, mask & ok) for text, mask in conditions(m, ship)]
    asked = [
        (text, mask)
        for text, mask in asked
        if LEAST_WINDOWS_EACH <= mask.sum() <= ok.sum() - LEAST_WINDOWS_EACH
    ]
    if not asked:
        return []
    masks = np.array([mask[ok] for _, mask in asked], dtype=float)
    beyond = _beyond_chance(masks, np.log(error[ok] + LOG_OFFSET), m.voyage[ok])
    floor = sizes(windows, horizon_s, STRUCTURE if structural else SENSORS)[ok]
    found = []
    for (text, mask), inside, stands in zip(asked, masks > 0.5, beyond, strict=True):
        here, there = float(error[ok][inside].mean()), float(error[ok][~inside].mean())
        if stands and here > RATIO * there and here > RATIO * float(np.nanmean(floor[inside])):
            share = float(inside.mean())
            explains = share * (here - there) / float(error[ok].mean())
            found.append(
                {
                    "condition": text,
                    "error_ratio": here / there,
                    "time_share": share,
                    "explains": explains,
                    "mask": mask,
                }
            )
    return _distinct(sorted(found, key=lambda f: -f["explains"]))


def _beyond_chance(masks: np.ndarray, error: np.ndarray, voyage: np.ndarray) -> np.ndarray:
    """(C,) whether a condition strikes more than the most striking one does by chance, each by its own
    measure of chance."""
    seen, chance = _striking(masks, error[None]), _striking(masks, _shifted(error, voyage))
    middle, spread = chance.mean(1, keepdims=True), chance.std(1, keepdims=True)
    moves = spread > 1e-6  # a condition that is a whole voyage cannot be judged by sliding within it
    limit = (
        np.quantile(((chance - middle) / (spread + 1e-12))[moves[:, 0]].max(0), 1.0 - CHANCE)
        if moves.any()
        else np.inf
    )
    return np.where(
        moves, (seen - middle) / (spread + 1e-12) > limit, _whole_voyages(masks, error, voyage)[:, None]
    )[:, 0]


def _whole_voyages(masks: np.ndarray, error: np.ndarray, voyage: np.ndarray) -> np.ndarray:
    """(C,) whether the error inside differs from that outside when only every tenth or so window counts as a
    new one."""
    # windows of a twelfth of a voyage hang together
    runs = max(1, round(error.size / (12.0 * np.unique(voyage).size)))
    return _striking(masks, error[None])[:, 0] / np.sqrt(runs) > 3.0


def _striking(masks: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """(C, S) how far the mean inside each condition lies above the mean elsewhere, in standard deviations of
    white errors."""
    inside = masks.sum(1)[:, None]
    outside = masks.shape[1] - inside
    total = masks @ errors.T
    gap = total / inside - (errors.sum(1) - total) / outside
    return gap / (errors.std(1) * np.sqrt(1.0 / inside + 1.0 / outside) + 1e-12)


def _shifted(error: np.ndarray, voyage: np.ndarray) -> np.ndarray:
    """(S, W) the errors slid along each voyage by a random time, the end joined to the beginning."""
    rng = np.random.default_rng(0)
    out = np.empty((SHIFTS, error.size))
    for i in np.unique(voyage):
        at = np.flatnonzero(voyage == i)
        for k, by in enumerate(rng.integers(0, at.size, SHIFTS)):
            out[k, at] = np.roll(error[at], by)
    return out


def _distinct(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The first of those that speak of nearly the same windows."""
    kept: list[dict[str, Any]] = []
    for f in found:
        if all((f["mask"] & k["mask"]).sum() < 0.6 * (f["mask"] | k["mask"]).sum() for k in kept):
            kept.append(f)
    return kept[:MAX_CONDITIONS]


def worst(windows: Sequence[Windows], horizon_s: float, most: int = 5) -> list[dict[str, Any]]:
    """Windows that do not overlap, the worst first: [{voyage, start_s, end_s, error_ratio, position_m,
    heading_deg}]."""
    error, errors = sizes(windows, horizon_s), pooled(windows, horizon_s)
    owner = np.concatenate([np.full(w.start.size, i) for i, w in enumerate(windows)])
    start = np.concatenate([w.track.t[w.start] for w in windows])
    out: list[dict[str, Any]] = []
    taken: list[int] = []
    for k in np.argsort(-np.nan_to_num(error, nan=-1.0)):
        if len(out) == most or not np.isfinite(error[k]):
            break
        if any(owner[o] == owner[k] and abs(start[o] - start[k]) < horizon_s for o in taken):
            continue
        taken.append(k)
        out.append(
            {
                "start_s": float(start[k]),
                "end_s": float(start[k] + horizon_s),
                "error_ratio": float(error[k] / np.nanmean(error)),
                "voyage": windows[owner[k]].track.name,
                "position_m": float(errors["position"][k]),
                "heading_deg": float(errors["heading"][k]),
            }
        )
    return out

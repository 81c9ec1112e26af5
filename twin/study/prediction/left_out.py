"""The error of a calibrated ship on its reference voyages, each predicted with numbers fitted to the others.

A ship is not calibrated anew for each voyage: the numbers move by what the normal equations say that they owe
to it (one Newton step from the common fit; Pregibon (1981) Logistic regression diagnostics, Ann. Statist. 9,
705-724). A single voyage is left out by halves."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from twin.physics.model import Model
from twin.study.estimation.box import within
from twin.study.estimation.columns import NO_MODEL, Unknown, with_values
from twin.study.estimation.dissipation import half_spaces
from twin.study.estimation.fit import Catalogue
from twin.study.estimation.innovations import Normal
from twin.study.prediction.envelope import sailed
from twin.study.prediction.error_vectors import vectors
from twin.study.prediction.openloop import HORIZONS_S, MODEL, STRUCTURE, Windows, predict
from twin.study.prediction.own_water import settled, shown_best
from twin.study.reference.between import ship_of, voyages
from twin.study.reference.path_error import PRIOR, PathError, level_of, tail
from twin.study.reference.sailed import fed
from twin.study.reference.structure import noise_model_of
from twin.study.track.track import Track

AHEAD_LENGTHS = (1.0, 3.0, 10.0)  # beside HORIZONS_S
LEAST_LOG_RATIO = 0.2  # of the logarithm: two horizons that are nearer are one
LONGEST = 0.25  # of the longest voyage
# correlation of a healthy voyage's windows before any was sailed, and how many pairs that counts for
ALIKE, OF_PRIOR = 0.2, 20.0


def horizons(model: Model, tracks: Sequence[Track], share: float = LONGEST) -> list[float]:
    """The times ahead [s] that are learned: fixed ones and those of so many ship lengths, up to a share of
    the longest voyage."""
    lengths = [k * float(model.ship.scale("time")) for k in AHEAD_LENGTHS]
    most = share * max(float(t.t[-1] - t.t[0]) for t in tracks)
    others = [h for h in lengths if all(abs(np.log(h / fixed)) > LEAST_LOG_RATIO for fixed in HORIZONS_S)]
    return [h for h in sorted({*HORIZONS_S, *others}) if h <= most] or [min(most, *HORIZONS_S)]


def models_without(
    model: Model,
    unknowns: Sequence[Unknown],
    normal: Normal,
    scatter: np.ndarray,
    pull: np.ndarray,
    temper: float,
    known: Catalogue,
) -> list[Model]:
    """The ship as each voyage's others alone would have it: the most probable one whose hull dissipates.
    `normal`: equations of all voyages in these unknowns; `scatter`, `pull` (P,): as between.py takes them.
    They are in prior widths."""
    sd = np.array([u.sd for u in unknowns])
    told = voyages(normal, sd, temper)
    whole = ship_of(told, scatter, pull)[0]
    present = {"core", *(type(e).__name__ for e in model.effects)}
    own = [i for i, u in enumerate(unknowns) if u.owner in present and u.owner not in NO_MODEL]
    mine, centre = [unknowns[i] for i in own], np.array([unknowns[i].centre for i in own])
    held, anywhere = half_spaces(model.ship, mine), np.outer([-np.inf, np.inf], np.ones(len(own)))
    out = []
    for i in range(len(told)):
        there, covariance = ship_of([t for j, t in enumerate(told) if j != i], scatter, pull)
        step = within((there - whole)[own], covariance[np.ix_(own, own)], anywhere, held)
        out.append(with_values(model, mine, (centre + sd[own] * step).tolist(), known))
    return out


def path_error(model: Model, tracks: Sequence[Track], without: Sequence[Model]) -> PathError | None:
    """The density of errors of `tracks`, each predicted by its own of the models `without` it; None where
    nothing can be predicted."""
    ahead = horizons(model, tracks)
    parts = _parts(tracks, without)
    raw = [
        _of_part(
            predict(
                t,
                fed(m, t)[0],
                ahead,
                noise_model=noise_model_of(model.ship),
                seed=i,
                simulated_alone=True,
            ),
            keep,
        )
        for i, (t, m, keep) in enumerate(parts)
    ]
    usable = [h for h in ahead if sum(int(w.valid[w.at(h)].sum()) for w in raw) > 2]
    if not usable:
        return None
    middle = shown_best(usable, model)
    rough = _second_moment(raw, middle, 1.0)
    each = [
        settled(w, fed(m, w.track)[0], rough, middle).windows for w, (_, m, _) in zip(raw, parts, strict=True)
    ]
    learned = [_learned(each, h) for h in usable]
    sizes = np.array([own.size for own in learned])
    means = np.array([_means(raw, h) for h in usable])
    simulated = [_means(raw, h, STRUCTURE)[0] for h in usable]
    return PathError(
        np.array(usable),
        np.array([own.covariance for own in learned]),
        np.array([own.alike for own in learned]),
        tail(np.exp(np.nanmean(np.log(sizes[:, np.isfinite(sizes).any(0)]), axis=0))),
        means,
        len(without),
        sailed(raw, middle),
        np.array(list(map(level_of, means[:, 0], simulated, [own.windows for own in learned]))),
    )


def _parts(tracks: Sequence[Track], without: Sequence[Model]) -> list[tuple[Track, Model, slice | None]]:
    """Every track with the model that was not fitted to it, and which of its windows count."""
    if len(tracks) == 1 and len(without) == 2:
        middle = halved_at(tracks[0])
        return [(tracks[0], without[0], slice(0, middle)), (tracks[0], without[1], slice(middle, None))]
    return [(t, m, None) for t, m in zip(tracks, without, strict=True)]


def halved_at(track: Track) -> int:
    """The step that half of what can be filtered of a track lies before, as its segments are halved: a hole
    counts for nothing."""
    steps = np.flatnonzero(track.whole)
    return int(steps[steps.size // 2])


def _of_part(windows: Windows, keep: slice | None) -> Windows:
    """Only the windows that begin and end in a part of the track."""
    if keep is None:
        return windows
    first, last = keep.start or 0, keep.stop or len(windows.track)
    windows.valid[...] &= (windows.start >= first) & (windows.start + windows.lead[:, None] < last)
    return windows


def _ends(windows: Windows, horizon_s: float, run: int = MODEL) -> np.ndarray:
    """(W', 8) errors of the windows that can be judged so far ahead."""
    k = windows.at(horizon_s)
    return vectors(windows, run)[k][windows.valid[k]]


def _second_moment(windows: Sequence[Windows], horizon_s: float, effective: float) -> np.ndarray:
    """(8, 8) mean of e e' with the simulated noise among it; NaN for what was not read."""
    error, noise = (np.concatenate([_ends(w, horizon_s, r) for w in windows]) for r in (MODEL, STRUCTURE))
    read = np.isfinite(error).any(0)
    own, simulated = map(_mean_square, (error, noise))
    S = (PRIOR * simulated + effective * own) / (PRIOR + effective)
    S[np.diag_indices(8)] += 1e-18
    S[~read], S[:, ~read] = np.nan, np.nan
    return np.asarray(S)


def _mean_square(x: np.ndarray) -> np.ndarray:
    """(8, 8) mean of x x' (W, 8), each variance over the windows in which it was read; an instrument that was
    not read in all goes together with the others by so much less, which keeps it a covariance."""
    own, read = np.nan_to_num(x), np.maximum(np.isfinite(x).sum(0), 1)
    return np.asarray(own.T @ own / np.sqrt(np.outer(read, read)))


class HorizonErrors(NamedTuple):
    """Of one horizon."""

    covariance: np.ndarray  # (8, 8)
    alike: float  # correlation of a voyage's windows
    size: np.ndarray  # (V,) of each voyage's error over the usual one
    windows: float  # that are independent


def _learned(windows: Sequence[Windows], horizon_s: float) -> HorizonErrors:
    ends = [_ends(w, horizon_s) for w in windows]
    count = [_independent(w, horizon_s) for w in windows]
    every = np.concatenate(ends)
    usual = np.sqrt(np.nansum(np.square(every), axis=0) / np.maximum(np.isfinite(every).sum(0), 1))
    scaled = [e / np.maximum(usual, 1e-12) for e in ends]
    rho = _alike(scaled, [max(1, round(len(e) / max(n, 1.0))) for e, n in zip(ends, count, strict=True)])
    effective = sum(n / (1.0 + max(n - 1.0, 0.0) * rho) for n in count)
    size = np.array([np.sqrt(np.nanmean(np.square(z))) if z.size else np.nan for z in scaled])
    return HorizonErrors(_second_moment(windows, horizon_s, effective), rho, size, effective)


def _independent(windows: Windows, horizon_s: float) -> float:
    """How many windows of a voyage do not overlap."""
    k = windows.at(horizon_s)
    begins = windows.track.t[windows.start]
    stride = float(np.median(np.diff(begins))) if begins.size > 1 else horizon_s
    return float(windows.valid[k].sum()) * min(1.0, stride / horizon_s)


def _alike(scaled: Sequence[np.ndarray], apart: Sequence[int]) -> float:
    """Correlation of errors (W, 8) of one voyage that do not overlap (`apart`: windows from one to the next),
    over all channels and voyages; the prior's ALIKE among them."""
    product, square, pairs = 0.0, 0.0, 0.0
    for z, step in zip(scaled, apart, strict=True):
        for phase in range(step):
            each = z[phase::step]
            each = each[:, np.isfinite(each).all(0)]
            if len(each) < 2 or not each.shape[1]:
                continue
            mine = len(each) * (len(each) - 1) / step
            product += (
                mine * float((each.sum(0) ** 2 - (each**2).sum(0)).mean()) / (len(each) * (len(each) - 1))
            )
            square += mine * float((each**2).mean())
            pairs += mine
    own = product / square if square else 0.0
    return float(np.clip((OF_PRIOR * ALIKE + pairs * own) / (OF_PRIOR + pairs), 0.0, 1.0))


def _means(windows: Sequence[Windows], horizon_s: float, run: int = MODEL) -> list[float]:
    """Mean size of place [m], place across [m] and heading [rad], voyages counted alike."""
    out = []
    for name in ("position", "lateral", "heading"):
        each = [w.errors(run)[name][w.at(horizon_s)] for w in windows]
        out.append(float(np.mean([np.nanmean(e) for e in each if np.isfinite(e).any()])))
    return out

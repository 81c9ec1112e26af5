"""Whether an effect was there all the time: how strong each part of the voyages says it is, as a share of
what all say together.

A rope in the propeller, a ballast tank that was filled, a gear that failed under way: the effect is named
rightly, and its size over the whole voyage is an average that it never had. Each part has its own core and
instruments (the reference voyages' knowledge of them), so a part in which the effect does not show says
little and does so with a wide interval.

What belongs to the ship is the same all voyage, between one and the next it may have changed. So a drogue
that was out for a while is no growth on the hull, although that is how much speed it took."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.special import expit

from twin.study.diagnosis.case import ODDS, ODDS_UNNAMED, Case
from twin.study.diagnosis.irregular import SHARES
from twin.study.diagnosis.refine import Found, standing
from twin.study.estimation.innovations import innovate
from twin.study.reference.evidence import reduce

PARTS = 4  # of a voyage, at most; a part holds whole segments of the filter
FORM_DIFFERS = 0.25  # a share that differs by so much is the form of the effect, not its time
DIFFERENT_SD = 4.0  # standard deviations by which two parts must differ


def over_time(
    case: Case, found: Found, names: Sequence[str], most: int = PARTS
) -> dict[str, list[dict[str, Any]]]:
    """For each of these effects of the hypothesis: voyage, start_s, end_s, share and its standard deviation,
    part by part, `most` of each voyage."""
    lines, at = standing(case, found)
    normal = innovate(lines, case.scenarios([found.hypothesis.scenario], found.doubt))[0]
    directions = np.array([np.where([u.owner == name for u in case.effects], at, 0.0) for name in names])
    out: dict[str, list[dict[str, Any]]] = {name: [] for name in names}
    for rows in _parts([track for track, _, _ in normal.where], most):
        keep = np.isin(np.arange(len(normal.where)), rows)
        part = reduce(normal.only(keep), case.nuisance, case.unknowns, case.effects, case.temper, at)
        A = directions @ part.A @ directions.T + 1e-6 * np.eye(len(names))
        share, sd = 1.0 + np.linalg.solve(A, directions @ part.b), np.sqrt(np.diag(np.linalg.inv(A)))
        (i, a, _), (_, _, b) = normal.where[rows[0]], normal.where[rows[-1]]
        track = lines[i].track
        place = {"voyage": track.name, "start_s": float(track.t[a]), "end_s": float(track.t[b - 1])}
        for name, s, e in zip(names, share, sd, strict=True):
            out[name].append(place | {"share": float(s), "sd": float(e)})
    return out


def _parts(voyage: Sequence[int], most: int) -> list[np.ndarray]:
    """Segments in groups that follow each other, of one voyage each."""
    of = np.array(voyage)
    rows = [np.flatnonzero(of == i) for i in dict.fromkeys(voyage)]
    return [part for r in rows for part in np.array_split(r, min(most, r.size))]


def changes(parts: Sequence[dict[str, Any]]) -> bool:
    """Whether the parts clearly disagree about the effect's size."""
    if len(parts) < 2:
        return False
    share, sd = (np.array([p[key] for p in parts]) for key in ("share", "sd"))
    apart = np.abs(share[:, None] - share) - FORM_DIFFERS
    return bool((apart > DIFFERENT_SD * np.hypot(sd[:, None], sd)).any())


def varying(case: Case, found: Found) -> dict[str, float]:
    """How probable it is [1], of each effect of the hypothesis that belongs to the ship, that its size is
    another in each part of a voyage, so that it has no name, rather than one."""
    names = [n for n in found.hypothesis.effects if case.catalogue[n].belongs_to == "ship"]
    if not names:
        return {}
    parts = over_time(case, found, found.hypothesis.effects)
    log_odds = np.log(ODDS_UNNAMED / ODDS)
    return {name: float(expit(log_bayes_factor(parts[name]) + log_odds)) for name in names}


def log_bayes_factor(parts: Sequence[dict[str, Any]]) -> float:
    """How much likelier the sizes of these parts are when they scatter within a voyage, by the likeliest of
    SHARES, than when each voyage has one, which its form tells as far as FORM_DIFFERS [log Bayes factor]."""

    def evidence(scatter: float) -> float:
        out = 0.0
        for voyage in {p["voyage"] for p in parts}:
            share, sd = (np.array([p[k] for p in parts if p["voyage"] == voyage]) for k in ("share", "sd"))
            weight = 1.0 / (sd**2 + FORM_DIFFERS**2 + scatter**2)
            off = share - np.average(share, weights=weight)
            # the voyage's own size integrated out
            out += 0.5 * float(np.log(weight).sum() - np.log(weight.sum()) - (weight * off**2).sum())
        return out

    return max(evidence(share) for share in SHARES) - evidence(0.0)

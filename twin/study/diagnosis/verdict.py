"""From weighed hypotheses to an answer: missing, nothing missing, unknown or undecided, with numbers an
engineer can check."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from twin.physics import core
from twin.physics.model import Model
from twin.study.diagnosis.case import WORLDS, Case
from twin.study.diagnosis.led import LUXURY
from twin.study.diagnosis.own_force import without
from twin.study.estimation.respond import respond
from twin.study.reference.evidence import Hypothesis, Posterior, probabilities
from twin.study.reference.nuisance import SURROUNDINGS

SURE = 0.8  # probability from which an effect is named
# and from which one is named with those that these voyages cannot tell it from: one of them is there
SURE_GROUP = 0.95
LARGEST_GROUP = 4  # effects that may stand for each other and still be an answer
LOST = 0.5  # probability of something unknown from which no name is given
# another beside it when that is nearly certain: of two forms that are only roughly right, one may mend the
# other
SURE_TOO = 0.9
ACQUITTED = 0.8  # probability from which nothing is said to be missing
ALIKE = 3.0  # log odds below which two effects cannot be told apart (20 to 1)


@dataclass(frozen=True)
class Weights:
    """Probability of every answer, and of every effect that would be news."""

    nothing: float
    unknown: float
    effects: dict[str, float]
    best: Hypothesis
    unnamed: Mapping[str, float] = field(default_factory=dict)  # of what is known by its form alone


def weights(case: Case, weighed: Sequence[Hypothesis]) -> Weights:
    p = probabilities(weighed)
    effects, unnamed = (dict.fromkeys(names, 0.0) for names in (case.names(case.candidates), case.unnamed))
    alone = {h.effects[0]: h.log_weight for h in reversed(weighed) if len(h.effects) == 1}
    nothing = unknown = 0.0
    for h, share in zip(weighed, p, strict=True):
        nameless = _nameless(case, h, alone)
        for name in case.news(h.effects):
            (unnamed if name in unnamed else effects)[name] += float(share)
        unknown += float(share) * nameless
        nothing += float(share) * (not case.news(h.effects) and not nameless)
    return Weights(nothing, unknown, effects, weighed[0], unnamed)


def _nameless(case: Case, h: Hypothesis, alone: Mapping[str, float]) -> bool:
    """Whether what is at work under a hypothesis has no name: the world is so restless without a sea that
    pushes her, or what is known by its form alone is there and does not merely mend the form of an effect
    that does clearly more `alone` (log weight of each effect by itself)."""
    known = [alone.get(name, -np.inf) for name in case.names(h.effects)]
    formed = [alone.get(name, -np.inf) for name in h.effects if name in case.unnamed]
    restless = WORLDS[h.world].unknown and not any(of_the_sea(case, name) for name in h.effects)
    return restless or (bool(formed) and max(known, default=-np.inf) <= max(formed) + LUXURY)


def of_the_sea(case: Case, name: str) -> bool:
    """Whether an effect is the sea's own force, of which the model knows nothing."""
    return case.catalogue[name].irregular and name not in case.present


def alike(case: Case, weighed: Sequence[Hypothesis], name: str) -> list[str]:
    """Effects that could stand in for this one: what is said of the voyages would be nearly as likely."""
    best = next(h for h in weighed if name in h.effects)
    rest = set(best.effects) - {name}
    out = []
    for other in case.names(case.candidates):
        if other in best.effects:
            continue
        swapped = next((h for h in weighed if set(h.effects) == rest | {other}), None)
        if swapped is not None and best.log_weight - swapped.log_weight < ALIKE:
            out.append(other)
    return out


def one_of(weighed: Sequence[Hypothesis], names: Sequence[str]) -> float:
    """Probability that at least one of these effects is there."""
    return float(
        sum(p for h, p in zip(weighed, probabilities(weighed), strict=True) if set(names) & set(h.effects))
    )


def group(weighed: Sequence[Hypothesis], w: Weights) -> list[str]:
    """The fewest effects, likeliest first, of which one is surely there though none of them is likely enough
    to be named; none when that takes too many, or when it may be nothing or something unknown."""
    likeliest = sorted(w.effects, key=lambda n: -w.effects[n])
    if w.unknown >= LOST or w.effects[likeliest[0]] >= SURE:
        return []
    groups = (likeliest[:k] for k in range(2, LARGEST_GROUP + 1))
    return next((names for names in groups if one_of(weighed, names) >= SURE_GROUP), [])


def judge(
    weighed: Sequence[Hypothesis],
    w: Weights,
    like: Mapping[str, Sequence[str]],
    leads: Sequence[str],
    *,
    able: bool = True,
    sharp: bool = True,
    explained: bool = True,
    blurred: bool = False,
    pushed: bool = False,
) -> tuple[str, list[str]]:
    """The verdict, and the effects to add, first the one that explains most. One that others could stand in
    for (`like`) is named when one of them is surely there, and only if it leads her better (`leads`). Voyages
    without a manoeuvre decide nothing, nor does a model that is no witness (`able`); those that would not
    have shown most effects, or on which the model alone leads her astray, acquit nobody (`sharp`); what the
    best hypothesis leaves over, or has otherwise than its form, is unknown (`explained`), but decides nothing
    where weather may mislead, or faults that undo each other, or where the model alone leads her as near as
    it ever did (`blurred`). Who was `pushed` for a moment by something that no effect gives is not acquitted
    either: that is unknown."""
    alone = {h.effects: h.log_weight for h in reversed(weighed) if len(h.effects) == 1}
    named = [
        n
        for n in w.best.effects
        if n in w.effects
        and n in leads
        and (w.effects[n] >= SURE or one_of(weighed, [n, *like[n]]) >= SURE_GROUP)
    ]
    named.sort(key=lambda n: -alone.get((n,), -np.inf))
    named = [n for i, n in enumerate(named) if i == 0 or w.effects[n] >= SURE_TOO]
    strange = w.unknown >= LOST or not explained
    if not able or (blurred and strange):
        return "undecided", []
    if strange:
        return "unknown", []
    if pushed and not named:
        return "undecided" if blurred else "unknown", []
    if w.nothing >= ACQUITTED and sharp:
        return "nothing_missing", []
    return ("missing", named) if named else ("undecided", [])


def shows(seen: dict[str, bool]) -> bool:
    """Whether the voyages would have shown three in four of the effects that do not depend on the day's
    weather and water."""
    lasting = [can for name, can in seen.items() if name not in SURROUNDINGS]
    return sum(lasting) >= 0.75 * len(lasting)


def parameters(case: Case, found: Posterior, name: str) -> list[dict[str, object]]:
    """Each parameter of one effect that what was recorded tells of, with its 95 % interval, inside its box;
    that the form is only roughly right is part of it. Of an effect that the ship has already, also what her
    file says."""
    params = {p.name: p for p in case.catalogue[name].params()}
    recorded = {key for track in case.tracks for key in track.weather}
    out = []
    for i, u in enumerate(case.effects):
        if u.owner == name and (params[u.name].input in {None, *recorded}):
            value = u.centre + u.sd * found.z[i]
            sd = u.sd * float(np.hypot(np.sqrt(found.covariance[i, i]), params[u.name].form * found.z[i]))
            low, high = value - 1.96 * sd, value + 1.96 * sd
            out.append(
                {
                    "name": u.name,
                    "value": float(np.clip(value, u.lo, u.hi)),
                    "low95": float(np.clip(low, u.lo, u.hi)),
                    "high95": float(np.clip(high, u.lo, u.hi)),
                    "unit": u.unit,
                }
                | ({"in_ship_file": u.centre} if name in case.present else {})
            )
    return out


def typical_force(case: Case, model: Model, name: str) -> dict[str, float]:
    """Root mean square of the force by which the model changes when this effect is taken out, or put back to
    what it was [N, N, N m]."""
    bare = without(model, case.model, name)
    total, count = np.zeros(3), 0
    for track in case.tracks:
        a, b = (respond(track, m.without_inputs(track.missing())[0])[0] for m in (model, bare))
        u, v, r = (a - b).T
        force = np.column_stack(core.force_for(u, v, r, model.c))
        total, count = total + (force**2).sum(0), count + len(track)
    X, Y, N = np.sqrt(total / max(count, 1))
    return {"X_N": float(X), "Y_N": float(Y), "N_Nm": float(N)}

"""What weighed hypotheses say of each effect: how probable it is, what stands for it as well, its numbers and
force. Nothing is decided here (decision.py)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from twin.physics import core
from twin.physics.model import Model
from twin.study.diagnosis.case import SCENARIOS, Case
from twin.study.diagnosis.criteria import CERTAIN, CLEAR, LOST, SURE
from twin.study.diagnosis.open_loop_check import COMPLEXITY
from twin.study.diagnosis.refine import Found
from twin.study.estimation.box import at_an_end
from twin.study.estimation.rarity import P95
from twin.study.estimation.respond import respond
from twin.study.reference.evidence import Hypothesis, Posterior, probabilities

LARGEST_GROUP = 4  # effects that may stand for each other and still be an answer

MOST_SAID = 0.99  # probability beyond which no posterior is told: no more ships than that were ever asked
RIVALS = 5  # hypotheses that are told beside the likeliest


def capped(probability: float) -> float:
    """A probability as it may be told."""
    return min(max(probability, 1.0 - MOST_SAID), MOST_SAID)


def rivals(weighed: Sequence[Hypothesis], found: Mapping[tuple[str, ...], Found]) -> list[dict[str, Any]]:
    """The likeliest hypotheses, each in its likeliest scenario: how far behind the first, and how far off
    they lead the ship on held-out parts."""
    sets = dict.fromkeys(h.effects for h in weighed)
    first = [next(h for h in weighed if h.effects == s) for s in list(sets)[: RIVALS + 1]]
    return [
        {
            "effects": list(h.effects),
            "scenario": h.scenario,
            "log_bayes_factor": h.log_weight - weighed[0].log_weight,
            "error_m": found[h.effects].open_loop_error_m if h.effects in found else None,
        }
        for h in first
    ]


@dataclass(frozen=True)
class Weights:
    """Probability of every answer: that no cause is missing, that one without a name is, of each cause, and
    of each kind of weather."""

    nothing: float
    unknown: float
    effects: dict[str, float]
    best: Hypothesis
    unnamed: Mapping[str, float] = field(default_factory=dict)  # of what is known by its form alone
    weather: Mapping[str, float] = field(default_factory=dict)

    @property
    def each(self) -> dict[str, float]:
        """Of every cause, with those that are known by their form alone."""
        return {**self.effects, **self.unnamed}


def weights(case: Case, weighed: Sequence[Hypothesis], found: Mapping[tuple[str, ...], Found]) -> Weights:
    """The probabilities of all answers, from those of the hypotheses; a stream that may change and was
    `found` not to counts as the steady one."""
    p, still = probabilities(weighed), [set(s) for s, f in found.items() if f.steady]
    each = dict.fromkeys(case.candidates, 0.0)
    alone: dict[str, float] = {}
    for h in weighed:
        if len(case.causes(h.effects)) == 1:
            alone.setdefault(case.causes(h.effects)[0], h.log_weight)
    nothing = unknown = 0.0
    for h, share in zip(weighed, p, strict=True):
        nameless = _nameless(case, h, alone)
        chosen = with_steady_stream(case, h.effects) if any(s <= set(h.effects) for s in still) else h.effects
        for name in {*chosen, *restless_water(case, h)}:
            each[name] += float(share)
        unknown += float(share) * nameless
        nothing += float(share) * (not case.causes(h.effects) and not nameless)
    of = lambda names: {name: each[name] for name in names}  # noqa: E731
    return Weights(
        nothing, unknown, of(case.names(case.candidates)), weighed[0], of(case.unnamed), of(case.weather)
    )


def with_steady_stream(case: Case, effects: Sequence[str]) -> tuple[str, ...]:
    """A set of effects with the steady stream in the place of one that may change."""
    parts = {n: case.catalogue[n].holds for n in effects if case.catalogue[n].is_weather()}
    kept = (n for n in effects if not parts.get(n))
    return case.ordered([*kept, *(part for held in parts.values() for part in held)])


def restless_water(case: Case, h: Hypothesis) -> list[str]:
    """The effect that water is which moves more than on the reference voyages: a stream that changes, whether
    its course has a name or not."""
    if SCENARIOS[h.scenario].flow <= 1.0 or SCENARIOS[h.scenario].unknown:
        return []
    return [name for name in case.weather if case.catalogue[name].holds]


def _nameless(case: Case, h: Hypothesis, alone: Mapping[str, float]) -> bool:
    """Whether what is at work under a hypothesis has no name: the scenario is so restless without a sea that
    pushes it, or what is known by its form alone is there and does not merely mend the form of an effect
    that does clearly more `alone` (log weight of each effect by itself)."""
    known = [alone.get(name, -np.inf) for name in case.names(h.effects)]
    formed = [alone.get(name, -np.inf) for name in h.effects if name in case.unnamed]
    restless = SCENARIOS[h.scenario].unknown and not any(of_the_sea(case, name) for name in h.effects)
    return restless or (bool(formed) and max(known, default=-np.inf) <= max(formed) + COMPLEXITY)


def of_the_sea(case: Case, name: str) -> bool:
    """Whether an effect is the sea's own force, of which the model knows nothing."""
    return case.catalogue[name].irregular and name not in case.present


def alike(case: Case, weighed: Sequence[Hypothesis], name: str) -> list[str]:
    """Effects that could stand in for this one: what is said of the voyages would be nearly as likely."""
    best = next(h for h in weighed if name in h.effects)
    rest = set(best.effects) - {name}
    out = []
    for other in case.candidates:
        if other in best.effects or other in case.unnamed:
            continue
        swapped = next((h for h in weighed if set(h.effects) == rest | {other}), None)
        if swapped is not None and best.log_weight - swapped.log_weight < CLEAR:
            out.append(other)
    return out


def one_of(weighed: Sequence[Hypothesis], names: Sequence[str]) -> float:
    """Probability that at least one of these effects is there."""
    return float(
        sum(p for h, p in zip(weighed, probabilities(weighed), strict=True) if set(names) & set(h.effects))
    )


def group(weighed: Sequence[Hypothesis], w: Weights) -> list[str]:
    """The fewest effects, likeliest first, of which one is surely there though none of them is likely enough
    to be named, those that are known by their form alone among them; none when that takes too many, or when
    it may be nothing or something unknown."""
    likeliest = sorted(w.each, key=lambda n: -w.each[n])
    if w.unknown >= LOST or w.each[likeliest[0]] >= SURE:
        return []
    groups = (likeliest[:k] for k in range(2, LARGEST_GROUP + 1))
    return next((names for names in groups if one_of(weighed, names) >= CERTAIN), [])


def power(case: Case, seen: Mapping[str, bool]) -> float:
    """Share of the effects of ship and instruments that the voyages would have shown, had they a plausible
    size."""
    lasting = [can for name, can in seen.items() if case.catalogue[name].belongs_to != "voyage"]
    return sum(lasting) / max(len(lasting), 1)


def parameters(case: Case, found: Posterior, name: str) -> list[dict[str, object]]:
    """Each parameter of one effect that what was recorded tells of, with its 95 % interval, inside its box;
    that the form is only roughly right is part of it. Of an effect that the ship has already, also what its
    file says."""
    params = {p.name: p for p in case.catalogue[name].params()}
    recorded = {key for track in case.tracks for key in track.weather}
    out = []
    for i, u in enumerate(case.effects):
        if u.owner == name and (params[u.name].input in {None, *recorded}):
            value = u.centre + u.sd * found.z[i]
            sd = u.sd * float(np.hypot(np.sqrt(found.covariance[i, i]), params[u.name].form * found.z[i]))
            low, high = value - P95 * sd, value + P95 * sd
            out.append(
                {
                    "name": u.full_name,
                    "value": float(np.clip(value, u.lo, u.hi)),
                    "low95": float(np.clip(low, u.lo, u.hi)),
                    "high95": float(np.clip(high, u.lo, u.hi)),
                    "unit": u.unit,
                    "meaning": params[u.name].doc,
                    "at_box_end": at_an_end(value, u.lo, u.hi, u.centre, u.sd),
                }
                | ({"in_ship_file": u.centre} if name in case.present else {})
            )
    return out


def typical_force(case: Case, found: Found, name: str) -> dict[str, float]:
    """Root mean square of the force by which the model changes when this effect is taken out, or put back to
    what it was [N, N, N m]."""
    total, count = np.zeros(3), 0
    for i, track in enumerate(case.tracks):
        model = found.on(i)
        bare = without(model, case.model, name)
        a, b = (respond(track, m.without_inputs(track.missing())[0])[0] for m in (model, bare))
        u, v, r = (a - b).T
        force = np.column_stack(core.force_for(u, v, r, model.c))
        total, count = total + (force**2).sum(0), count + len(track)
    X, Y, N = np.sqrt(total / max(count, 1))
    return {"X_N": float(X), "Y_N": float(Y), "N_Nm": float(N)}


def without(model: Model, before: Model, name: str) -> Model:
    """The model with one effect taken out, or put back to what it was `before`."""
    was = (e for e in before.effects if type(e).__name__ == name)
    return Model(model.ship, (*(e for e in model.effects if type(e).__name__ != name), *was))

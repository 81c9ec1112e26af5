"""Further causes: the voyages are weighed again with what is named in the model, as an owner would do who
adds it and asks once more.

Beside a strong cause the search asks of a second one to explain more than it costs, and the decision asks it
to stand out in the path of all. With the first in the model, the second is a first. What that is worth on
random ships stands in docs/results/judgement.md."""

from collections.abc import Sequence
from dataclasses import replace
from math import inf

from twin.physics.ship import Ship
from twin.recording.progress import Progress, silent
from twin.recording.voyage import Voyage
from twin.study.diagnosis.answer import SearchAnswer, answer
from twin.study.diagnosis.as_filed import model_with
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.consider import Considered
from twin.study.diagnosis.criteria import CLEAR
from twin.study.diagnosis.decision import Decision
from twin.study.diagnosis.open_loop_check import held_out_error
from twin.study.diagnosis.refine import Found, Sets, first_guess, largest, refine
from twin.study.diagnosis.search import EARNED, MAX_CAUSES
from twin.study.reference.evidence import posterior, weigh_with


def with_further(
    first: SearchAnswer,
    voyages: Sequence[Voyage],
    ship: Ship,
    references: Sequence[Voyage] = (),
    progress: Progress = silent,
) -> SearchAnswer:
    """The answer with what is named once its causes are in the model, until nothing more is, or there are
    MAX_CAUSES; the same where it names none, or where no other cause deserves a second look."""
    while 0 < len(first.causes) < MAX_CAUSES and _more_may_be(first):
        progress(f"asking again, with {' and '.join(first.causes)} in the model")
        holding = _holding(first, ship)
        case = assemble(voyages, holding, references, progress)
        again = answer(case, voyages, holding, references, progress)
        new = [n for n in again.causes if n not in first.causes and n in first.case.candidates]
        if not new:
            break
        wider = _joined(first, again, new[: MAX_CAUSES - len(first.causes)])
        if not _stands(first, wider.found[wider.joined], wider.causes):
            break
        first = wider
    return first


def _likeliest(first: SearchAnswer) -> Sets:
    """The likeliest set that was relinearised and holds all causes that are named."""
    causes = set(first.causes)
    likely = (h.effects for h in first.weighed if h.effects in first.found and causes <= set(h.effects))
    return next(likely, first.shown)


def _more_may_be(first: SearchAnswer) -> bool:
    """Whether a cause that is not named stands beside those that are, or would add to their evidence, to
    first order about them, as much as a second look asks for."""
    case, chosen = first.case, _likeliest(first)
    if len(case.names(chosen)) > len(first.causes):
        return True
    found = first.found[chosen]
    if found.reduced is None:
        return True
    others = [n for n in case.names(case.candidates) if n not in chosen]
    base = posterior(found.reduced, chosen).log_evidence
    return any(e - base >= EARNED for _, e in weigh_with(found.reduced, chosen, others))


def _holding(first: SearchAnswer, ship: Ship) -> Ship:
    """The ship with the causes that were named, as they stand in the likeliest set that holds them all."""
    z = first.found[_likeliest(first)].posterior.z
    return replace(ship, effects=model_with(first.case, first.causes, z).effects)


def _joined(first: SearchAnswer, again: SearchAnswer, new: Sequence[str]) -> SearchAnswer:
    """The causes of both, with their numbers from one fit, and the facts of both."""
    case = first.case
    day = case.day(again.considered.facts.explanation)
    chosen = case.ordered((*first.causes, *new, *day))
    left = again.found[again.shown]
    own = replace(_fitted(first, chosen), expected_error_m=left.expected_error_m)
    own = replace(own, open_loop_error_m=held_out_error(case, own))
    path = replace(first.path, found={**first.path.found, chosen: own})
    weighed = path.with_path(own.hypothesis)
    others = [h for h in first.weighed if (h.effects, h.scenario) != (chosen, weighed.scenario)]
    of_new = {n: again.weights.effects[n] for n in new}
    of_day = {n: again.weights.weather[n] for n in again.case.day(again.decision.missing)}
    return replace(
        first,
        weighed=sorted([weighed, *others], key=lambda h: -h.log_weight),
        found={**first.found, chosen: own},
        path=path,
        weights=replace(
            first.weights,
            effects={**first.weights.effects, **of_new},
            best=own.hypothesis,
            weather={**first.weights.weather, **of_day},
        ),
        considered=_considered(first, again, new, chosen),
        decision=_decision(first, again, new),
        further=(*first.further, *new),
        joined=chosen,
    )


def _fitted(first: SearchAnswer, chosen: Sets) -> Found:
    """These effects where the voyages have them, begun where most of them were found to stand, or at the
    first-order guess about the first answer."""
    case, found = first.case, first.found
    parts = [f for s, f in found.items() if set(s) < set(chosen) and f.reduced is not None]
    part = largest(parts)
    start = part or found[first.shown]
    about = start.reduced or case.reduced(case.lines, case.scenarios([start.hypothesis.scenario]))[0]
    z = first_guess(about, chosen)
    return refine(case, chosen, start.hypothesis.scenario, z, (), part=part)[0]


def _stands(first: SearchAnswer, own: Found, names: Sequence[str]) -> bool:
    """Whether the voyages are clearly more probable with all of these, fitted together, than with any part of
    the set that has the causes of the first answer alone, and none ended at nothing beside the others: with a
    cause held as it was found, a second may only be mending its number."""
    case, z, h = first.case, own.posterior.z, own.hypothesis
    parts = (f.hypothesis for s, f in first.found.items() if set(s) < set(h.effects))
    before = (part.log_weight for part in parts if set(case.causes(part.effects)) == set(first.causes))
    own_numbers = ([i for i, u in enumerate(case.effects) if u.owner == name] for name in names)
    return h.log_weight - max(before, default=-inf) >= CLEAR and all(
        z[numbers].any() for numbers in own_numbers
    )


def _decision(first: SearchAnswer, again: SearchAnswer, new: Sequence[str]) -> Decision:
    """What each of the two searches names, the first one first."""
    weather = again.case.day(again.decision.missing)
    named = (*first.causes, *new, *weather)
    others = {**first.decision.not_named, **again.decision.not_named}
    return replace(
        again.decision, missing=named, not_named={n: why for n, why in others.items() if n not in named}
    )


def _considered(first: SearchAnswer, again: SearchAnswer, new: Sequence[str], chosen: Sets) -> Considered:
    """The facts of what is left with all causes in the model, and of each cause where it was named."""
    before, after = first.considered, again.considered
    of_new = tuple(c for c in after.facts.causes if c.effect in new)
    facts = replace(
        after.facts,
        nothing=before.facts.nothing,
        error_nothing=before.facts.error_nothing,
        power=before.facts.power,
        reached=before.facts.reached,
        comes_and_goes=max(before.facts.comes_and_goes, after.facts.comes_and_goes),
        likeliest=chosen,
        explanation=chosen,
        causes=(*(c for c in before.facts.causes if c.effect in first.causes), *of_new),
    )
    like = {**before.like, **{n: after.like[n] for n in new if n in after.like}}
    return replace(before, facts=facts, pushes=after.pushes, like=like)

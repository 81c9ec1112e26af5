"""From what the search found to the facts that decide: each is computed here, once, and nothing is
decided."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from twin.study.diagnosis.by_kinematics import AskedKinematics, reached
from twin.study.diagnosis.case import SCENARIOS, Case
from twin.study.diagnosis.criteria import CLEAR, SURE, USUAL
from twin.study.diagnosis.decision import explained
from twin.study.diagnosis.facts import Cause, Facts, Left
from twin.study.diagnosis.healthy_score import against_healthy
from twin.study.diagnosis.hollow import nothing
from twin.study.diagnosis.irregular import comes_and_goes
from twin.study.diagnosis.moments import Moment, moments
from twin.study.diagnosis.open_loop_check import ANY_DAY, roughly
from twin.study.diagnosis.overtime import varying
from twin.study.diagnosis.refine import Found, Sets
from twin.study.diagnosis.verdict import (
    Weights,
    alike,
    group,
    of_the_sea,
    one_of,
    power,
    with_steady_stream,
)
from twin.study.estimation.rarity import P95, deviations
from twin.study.estimation.start import wave_period_s
from twin.study.reference.evidence import Hypothesis
from twin.study.reference.healthy import Healthy
from twin.study.reference.seaway import at_sea

NO_GAP = 1e3  # log Bayes factor written where there is nothing to compare with


@dataclass(frozen=True)
class Considered:
    """The facts, and what they were found about."""

    facts: Facts
    base: Sets  # the likeliest weather with no cause beside it
    pushes: Sequence[Moment]
    like: Mapping[
        str, Sequence[str]
    ]  # effects that these voyages cannot tell from one of the likeliest hypothesis
    healthy: Healthy | None  # how rare the voyages would be in health; None: the ship file has no scores


def consider(
    case: Case,
    weighed: Sequence[Hypothesis],
    found: Mapping[Sets, Found],
    seen: Mapping[str, bool],
    w: Weights,
    asked: AskedKinematics | None = None,
) -> Considered:
    """The facts of the likeliest hypothesis, of what is without causes, and of every cause that may be
    named. `asked`: what kinematics say of these voyages, where an instrument is suspected."""
    best, base = found[w.best.effects], without_causes(case, weighed, found)
    bare = found[base]
    explanation, left = _explanation(case, weighed, found)
    pushes = moments(case, best)
    named = dict.fromkeys(
        [
            *case.names(explanation),
            *case.names(w.best.effects),
            *(n for n, p in w.effects.items() if p >= SURE),
        ]
    )
    like = {name: alike(case, weighed, name) for name in named}
    varies = varying(case, found[explanation or w.best.effects])
    causes = [
        replace(
            _cause(case, weighed, found, explanation, name, w, like[name], asked),
            varies=varies.get(name, 0.0),
        )
        for name in named
    ]
    causes = without_hollow(case, found, explanation, causes)
    still = stilled(case, found, explanation)
    weather = [_cause(case, weighed, found, still, name, w, ()) for name, p in w.weather.items() if p >= SURE]
    healthy = against_healthy(case)
    strongest = max(pushes, key=lambda m: m.log_evidence, default=None)
    facts = Facts(
        nothing=w.nothing,
        unknown=w.unknown,
        likeliest=w.best.effects,
        explanation=explanation,
        left=left,
        error_nothing=bare.open_loop_error_m / bare.expected_error_m,
        error_best=_ratio(best.open_loop_error_m, best.expected_error_m),
        manoeuvre=case.excited,
        power=power(case, seen),
        structural=case.path.share,
        noise=_by_axis(np.array(case.noise_model.white) / case.white),
        scatter=case.noise_model.sensor / case.scatter,
        sea=any(at_sea(t, case.model) for t in case.tracks),
        rough=roughly(case) / bare.expected_error_m,
        transient=strongest.log_evidence if strongest else 0.0,
        in_waves=any(m.voyage == t.name and wave_period_s(t) > 0.0 for m in pushes for t in case.tracks),
        resembles=tuple(name for name, p in w.unnamed.items() if p >= SURE),
        one_of=tuple(group(weighed, w)),
        causes=tuple(sorted(causes, key=lambda c: -c.probability)),
        weather=tuple(sorted(weather, key=lambda c: -c.probability)),
        as_before=(
            *case.as_before,
            *of_any_day(case, found[still or stilled(case, found, w.best.effects)]),
        ),
        reached=healthy.reached if healthy else None,
        comes_and_goes=comes_and_goes(case, found[explanation or w.best.effects]),
    )
    return Considered(facts, base, pushes, like, healthy)


def without_hollow(
    case: Case, found: Mapping[Sets, Found], explanation: Sets, causes: Sequence[Cause]
) -> list[Cause]:
    """The causes; one that ends at nothing without the instruments that are as they were on the references
    is no part of the explanation: it only made good what those took."""
    as_before = {c.effect for c in causes if (c.reached or 0.0) >= USUAL}
    kept = tuple(name for name in explanation if name not in as_before)
    if kept == explanation or kept not in found:
        return list(causes)
    hollow = {name for name in kept if nothing(case, found[kept], name)}
    return [replace(c, in_explanation=c.in_explanation and c.effect not in hollow) for c in causes]


def stilled(case: Case, found: Mapping[Sets, Found], effects: Sets) -> Sets:
    """The set with the steady stream in the place of one that may change and did not, where that was found
    too: so its water is told, and held against that of the reference voyages."""
    still = with_steady_stream(case, effects)
    return still if still in found and found[effects].steady else effects


def of_any_day(case: Case, found: Found) -> tuple[str, ...]:
    """The weather that a hypothesis has and the reference voyages had as much of: no number of it is more
    than ANY_DAY times what they scatter by."""
    usual, size = case.nuisance.daily, dict[str, float]()
    for u, z in zip(case.effects, found.posterior.z, strict=True):
        if u.every_day and u.owner in case.weather and u.owner in found.hypothesis.effects:
            day = usual.get(u.label, 0.0)
            size[u.owner] = max(size.get(u.owner, 0.0), abs(u.sd * z) / day if day else np.inf)
    return tuple(name for name, times in size.items() if times <= ANY_DAY)


def without_causes(case: Case, weighed: Sequence[Hypothesis], found: Mapping[Sets, Found]) -> Sets:
    """The likeliest weather that was judged, with no cause beside it: what "nothing is missing" stands for
    on these voyages."""
    asked = (
        h.effects
        for h in weighed
        if not case.causes(h.effects)
        and h.effects in found
        and np.isfinite(found[h.effects].open_loop_error_m)
    )
    return next(asked, ())


def _least_error(found: Mapping[Sets, Found], rest: Sets) -> float:
    """The open-loop error that the rest of a set leads to [m]; where nobody asked, the least of its parts
    (one of which is nothing)."""
    if rest in found and np.isfinite(found[rest].open_loop_error_m):
        return found[rest].open_loop_error_m
    return min(
        f.open_loop_error_m
        for s, f in found.items()
        if set(s) <= set(rest) and np.isfinite(f.open_loop_error_m)
    )


def _ratio(error: float, expected: float) -> float | None:
    return float(error / expected) if np.isfinite(error) and np.isfinite(expected) else None


def _by_axis(values: np.ndarray) -> tuple[float, float, float]:
    surge, sway, yaw = (float(v) for v in values)
    return surge, sway, yaw


def _explanation(case: Case, weighed: Sequence[Hypothesis], found: Mapping[Sets, Found]) -> tuple[Sets, Left]:
    """The likeliest hypothesis, or, where this leaves more than a true one would, a part of it that cannot
    be told from it and does not."""
    best = weighed[0]
    close = [
        h.effects
        for h in weighed
        if best.log_weight - h.log_weight < CLEAR
        and set(h.effects) <= set(best.effects)
        and h.effects in found
    ]
    for part in dict.fromkeys(close):
        if part and explained(left := left_over(case, weighed, found, part)):
            return part, left
    return (), left_over(case, weighed, found, best.effects)


def left_over(case: Case, weighed: Sequence[Hypothesis], found: Mapping[Sets, Found], chosen: Sets) -> Left:
    """What a set of effects leaves over."""
    own, nothing = found[chosen], found[without_causes(case, weighed, found)]
    scenarios = [h for h in weighed if h.effects == chosen]
    plain = next((h for h in scenarios if SCENARIOS[h.scenario].plain), None)
    return Left(
        error=_ratio(own.open_loop_error_m, own.expected_error_m),
        share=_ratio(own.open_loop_error_m, nothing.open_loop_error_m),
        restless=scenarios[0].log_weight - plain.log_weight if plain else NO_GAP,
    )


def _cause(
    case: Case,
    weighed: Sequence[Hypothesis],
    found: Mapping[Sets, Found],
    explanation: Sets,
    name: str,
    w: Weights,
    like: Sequence[str],
    asked: AskedKinematics | None = None,
) -> Cause:
    there = [h for h in weighed if name in h.effects]
    chosen = (
        explanation
        if name in explanation
        else next((h.effects for h in there if h.effects in found), (name,))
    )
    best_with = max((h.log_weight for h in there), default=-np.inf)
    best_without = max((h.log_weight for h in weighed if name not in h.effects), default=-np.inf)
    own, least = found.get(chosen), _least_error(found, tuple(n for n in chosen if n != name))
    only = max(
        (f.hypothesis.log_weight for s, f in found.items() if case.causes(s) == (name,)), default=-np.inf
    )
    none = max(f.hypothesis.log_weight for s, f in found.items() if not case.causes(s))
    alone = max(only - none, -NO_GAP)
    gain = 1.0 - own.open_loop_error_m / least if own and np.isfinite(own.open_loop_error_m) else None
    probability = w.effects[name] if name in w.effects else w.weather[name]
    return Cause(
        effect=name,
        belongs_to=case.catalogue[name].belongs_to,
        in_explanation=name in explanation,
        in_ship_file=name in case.present,
        sea_force=of_the_sea(case, name),
        probability=probability,
        with_rivals=one_of(weighed, [name, *like]),
        log_bayes_factor=float(np.clip(best_with - best_without, -NO_GAP, NO_GAP)),
        alone=float(alone),
        error_gain=gain,
        significance=significance(case, own, name) if own else 0.0,
        change=change(case, own, name) if own else 0.0,
        reached=reached(case, own, name, asked) if own and asked else None,
    )


def significance(case: Case, found: Found, name: str) -> float:
    """How far all numbers of this effect together are from none, as standard deviations of one (a compass
    bias, and what of it turned the velocity, are each uncertain, and their difference clear)."""
    own = np.array([i for i, u in enumerate(case.effects) if u.owner == name])
    return deviations(found.posterior.z[own], found.posterior.covariance[np.ix_(own, own)])


def joint_significance(
    case: Case, found: Found, name: str, numbers: Sequence[Mapping[str, Any]]
) -> float | None:
    """How far all numbers of this effect together are from none, or from the ship file's [standard deviations
    of one], where the 95 % interval of each alone holds that; None where one is clear alone, or not even all
    are."""
    none = {u.full_name: u.centre for u in case.effects if u.owner == name}
    alone = any(not p["low95"] <= none[p["name"]] <= p["high95"] for p in numbers)
    together = significance(case, found, name)
    return together if len(numbers) > 1 and not alone and together > P95 else None


def change(case: Case, found: Found, name: str) -> float:
    """How far the clearest number of an effect is from what the ship's file has, over what its form may be
    off in another manoeuvre (a gear that was found as a dead time and half a second of easing is the same
    gear with less of the one and more of the other); 0 where the file has none."""
    if name not in case.present:
        return 0.0
    form = {p.name: p.form for p in case.catalogue[name].params()}
    moved = ((u, u.sd * z) for u, z in zip(case.effects, found.posterior.z, strict=True) if u.owner == name)
    return max(abs(by) / max(form[u.name] * abs(u.centre), 1e-9 * u.sd) for u, by in moved)

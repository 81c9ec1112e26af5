"""`twin diagnose`: which physical effect is missing, in newtons, with its confidence, or an honest answer
that is none."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.physics.effects import of_ship
from twin.physics.ship import Ship
from twin.recording.checks import of_voyages
from twin.recording.inputs import INPUTS
from twin.recording.jsonable import plain
from twin.recording.progress import Progress, silent
from twin.recording.voyage import Voyage
from twin.study.diagnosis.against_healthy import healthy_in_words, rarity
from twin.study.diagnosis.answer import SearchAnswer, answer
from twin.study.diagnosis.assemble import assemble, unjudged_because
from twin.study.diagnosis.beyond_file import beyond_file
from twin.study.diagnosis.calibrated_probability import of_cause, of_nothing, of_unknown
from twin.study.diagnosis.case import SCENARIOS, Case
from twin.study.diagnosis.consider import Considered, joint_significance
from twin.study.diagnosis.further import with_further
from twin.study.diagnosis.horizon import mean_horizon_s
from twin.study.diagnosis.manoeuvres import next_manoeuvre, showing
from twin.study.diagnosis.open_loop_check import held_out_error
from twin.study.diagnosis.overtime import PARTS, over_time
from twin.study.diagnosis.refine import Found, Sets
from twin.study.diagnosis.set_and_rate import set_and_rate
from twin.study.diagnosis.tell_diagnosis import SOME
from twin.study.diagnosis.verdict import (
    alike,
    capped,
    parameters,
    restless_water,
    rivals,
    typical_force,
    with_steady_stream,
)
from twin.study.estimation.start import waves_on
from twin.study.reference.nuisance import learned_since
from twin.study.reference.sailed import own_references
from twin.study.reference.structure import noise_model_of
from twin.study.track.jumps import jumps_on

SCHEMA_VERSION = 1
SHOWN = 8  # candidates in the answer: all that are at least LEAST_PROBABILITY likely, and no more than this
LEAST_PROBABILITY = 0.05


@dataclass(frozen=True)
class Diagnosed:
    """The JSON of docs/json.md, and what a report draws it from."""

    result: dict[str, Any]
    case: Case
    found: Mapping[Sets, Found]


def diagnose(
    voyages: Sequence[Voyage],
    ship: Ship,
    references: Sequence[Voyage] = (),
    progress: Progress = silent,
) -> Diagnosed:
    """Judge all candidates jointly on these voyages. DataError: there is none, one is too short, or given
    twice or as a reference too, or a sign, unit or frame of one is proved wrong; SettingsError: the ship file
    is damaged."""
    checks = of_voyages([*voyages, *references], ship)
    case = assemble(voyages, ship, references, progress)
    told = with_further(
        answer(case, voyages, ship, references, progress), voyages, ship, references, progress
    )
    case, found, considered = told.case, told.found, told.considered
    listed, base = _listed(told, progress), told.found[considered.base]
    result = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        **_decided(told),
        "candidates": listed,
        "rivals": rivals(told.weighed, found),
        "resembles": [c for n in told.resembling if (c := _candidate(told, n, told.weights.unnamed[n]))],
        "answer": {
            "not_named": told.decision.not_named,
            "lasting": [n for n in told.decision.missing if case.catalogue[n].lasts()],
        },
        "moments": [m.as_json(case.model) for m in considered.pushes],
        "path": {
            "horizon_s": mean_horizon_s(case.tracks, case.model),
            "error_without": base.open_loop_error_m,
            "error_floor": base.expected_error_m,
            "weather": list(with_steady_stream(case, considered.base) if base.steady else considered.base),
        },
        "next_manoeuvre": _next(told, listed, progress),
        **_circumstances(told, [c["effect"] for c in listed]),
        "voyages": [v.name for v in voyages],
        "calibrated_on": own_references(ship, voyages),
        "waves": waves_on(case.tracks),
        "jumps": jumps_on(case.tracks),
        "references": [v.name for v in references],
        "calibrated": bool(references) or noise_model_of(ship) is not None,
        "learned_since": [] if references else learned_since(case.model, of_ship(ship)),
        "data_checks": checks,
        "facts": considered.facts.as_json(),
    }
    result["p_value_sentence"] = healthy_in_words(result)
    result["sentence"] = told.decision.sentence(result)
    return Diagnosed(plain(result), case, found)


def _decided(told: SearchAnswer) -> dict[str, Any]:
    """The verdict with its reason, what is named, and how probable the two answers without a name are."""
    decision, facts, healthy = told.decision, told.considered.facts, told.considered.healthy
    nothing = of_nothing(0.0 if decision.reason == "pushed" else facts.nothing, facts, decision)
    return {
        "verdict": decision.verdict,
        "reason": decision.reason,
        "missing": list(decision.missing),
        "further": list(told.further),
        "more": decision.more,
        "one_of": list(facts.one_of) if decision.reason in ("one_of", "weather") else [],
        **rarity(healthy),
        "probabilities": {"nothing_missing": nothing, "unknown": of_unknown(facts, decision)},
    }


def _listed(told: SearchAnswer, progress: Progress) -> list[dict[str, Any]]:
    """The candidates of the answer: what is named first, then the most probable; with their strength in each
    part of the voyages where the likeliest set holds them."""
    w, missing = told.weights, told.decision.missing
    p = w.effects | {name: w.weather[name] for name in missing if name in w.weather}
    likely = [n for n in sorted(p, key=lambda n: -p[n]) if p[n] >= LEAST_PROBABILITY][:SHOWN]
    progress("predicting held-out parts")
    shown = [*missing, *(n for n in likely if n not in missing)]
    listed = [c for c in (_candidate(told, name, p[name]) for name in shown) if c]
    if w.best.effects:
        progress("estimating each part of the voyages by itself")
        most = max(1, PARTS // len(told.case.lines))
        parts = over_time(told.case, told.found[w.best.effects], w.best.effects, most)
        for c in listed:
            if c["effect"] in parts:
                c["over_time"] = parts[c["effect"]]
    return listed


def too_small(seen: Mapping[str, bool], listed: Collection[str]) -> list[str]:
    """Effects that could not be seen at a plausible size; not those that the answer lists at their own
    (`listed`), which were seen because they are larger."""
    return [name for name, can in seen.items() if not can and name not in listed]


def _circumstances(told: SearchAnswer, listed: Sequence[str]) -> dict[str, Any]:
    """What could not be judged or seen, the water and wind of these voyages, and the noise they were judged
    under. `listed`: what the answer gives the numbers of."""
    case, noise_model = told.case, told.case.noise_model
    as_before = [n for n in told.considered.facts.as_before if told.seen.get(n, True) or n in listed]
    told_already = [*told.decision.missing, *listed, *as_before, *case.present]
    return {
        "not_judged": _not_possible(case),
        "weather": [
            _weather(told, name, share)
            for name, share in told.weights.weather.items()
            if share >= SOME or (told.causes and name in told.shown)
        ],
        "as_on_references": as_before,
        "not_visible": too_small(told.seen, told_already),
        "floor": {
            "share_surge_sway_yaw": noise_model.share,
            "sensor_factor": noise_model.sensor,
            "temper": case.temper,
        },
    }


def _candidate(told: SearchAnswer, name: str, posterior: float) -> dict[str, Any]:
    """One effect with its numbers; empty where no set that holds it was relinearised."""
    case, weighed, found, considered = told.case, told.weighed, told.found, told.considered
    if (chosen := _own_set(told, name)) is None:
        return {}
    best = found[chosen]
    numbers = parameters(case, best.posterior, name)
    return {
        "effect": name,
        "belongs_to": case.catalogue[name].belongs_to,
        "probability": capped(posterior)
        if name in case.weather
        else of_cause(considered.facts, told.decision, name, posterior),
        "posterior": capped(posterior),
        # share of the reference voyages on which kinematics had as much of an instrument's fault
        "on_references": next((c.reached for c in considered.facts.causes if c.effect == name), None),
        "parameters": numbers,
        "together_sd": joint_significance(case, best, name, numbers)
        if name in told.decision.missing
        else None,
        "typical_force": typical_force(case, best, name),
        "stream": set_and_rate(case, best, name),
        "error_horizon_s": mean_horizon_s(case.tracks, case.model),
        "error_without": _without(case, found, considered, name),
        "error_with": held_out_error(case, best)
        if np.isnan(best.open_loop_error_m)
        else best.open_loop_error_m,
        "error_floor": best.expected_error_m,
        "together_with": [n for n in best.hypothesis.effects if n != name],
        "cannot_be_told_from": list(
            considered.like[name] if name in considered.like else alike(case, weighed, name)
        ),
        "says": case.catalogue[name].sentence(case.model.ship),
    }


def _own_set(told: SearchAnswer, name: str) -> Sets | None:
    """The set with whose numbers an effect is told: the answer where it is named, else the likeliest that was
    relinearised and holds it."""
    if name in told.decision.missing and name in told.shown and told.shown in told.found:
        return told.shown
    sets = [h.effects for h in told.weighed if name in h.effects and h.effects in told.found]
    sets = sets or [s for s in told.found if name in s]  # where it stands at a size that cannot be
    return sets[0] if sets else None


def _without(case: Case, found: Mapping[Sets, Found], considered: Considered, name: str) -> float:
    """Open-loop error without a cause: with the day's weather alone; without a kind of weather: of the model
    as it is [m]."""
    return found[() if name in case.weather else considered.base].open_loop_error_m


def _weather(told: SearchAnswer, name: str, probability: float) -> dict[str, Any]:
    """One kind of today's water and weather, with its numbers, as it stands beside what is named, else in the
    likeliest set that holds it; or how restless the water is."""
    case, weighed, found = told.case, told.weighed, told.found
    sets = [h.effects for h in weighed if name in h.effects and h.effects in found]
    sets = [told.shown, *sets] if told.causes and name in told.shown else sets
    best = (
        found[sets[0]]
        if sets and (name in weighed[0].effects or name not in restless_water(case, weighed[0]))
        else None
    )
    out = {"effect": name, "belongs_to": case.catalogue[name].belongs_to, "probability": capped(probability)}
    if best is None:
        flow = SCENARIOS[weighed[0].scenario].flow * case.noise_model.flow * float(case.model.ship.U_0)
        return out | {
            "parameters": [{"name": "scatter", "value": flow, "unit": "m/s"}],
            "beyond_file": [],
            "typical_force": None,
            "stream": [],
        }
    numbers = parameters(case, best.posterior, name)
    return out | {
        "parameters": numbers,
        "beyond_file": beyond_file(case.model.ship, name, numbers),
        "typical_force": typical_force(case, best, name),
        "stream": set_and_rate(case, best, name),
    }


def _next(told: SearchAnswer, listed: Sequence[dict[str, Any]], progress: Progress) -> dict[str, Any] | None:
    """What to sail next, when two effects stand in each other's way or the voyages could not tell."""
    decision, case, found = told.decision, told.case, told.found
    if decision.verdict == "nothing_missing":
        return None
    if decision.reason == "no_power":
        progress("simulating manoeuvres that would show more")
        unseen = too_small(told.seen, case.present)
        return showing(case, case.model, [n for n in unseen if case.catalogue[n].belongs_to != "voyage"])
    named = decision.verdict == "missing" and decision.reason != "weather"
    rivals = next(
        (
            (c["effect"], o)
            for c in listed
            for o in c["cannot_be_told_from"]
            if c["effect"] in decision.missing or not named
        ),
        None,
    )
    w, one_of = told.weights, told.considered.facts.one_of
    asked = one_of if decision.reason == "one_of" else [c["effect"] for c in listed]
    if rivals is None and decision.verdict == "undecided" and len(asked) > 1:
        first, second, *_ = sorted(asked, key=lambda n: -w.each[n])
        rivals = (first, second)
    if rivals is None:
        return None
    progress(f"simulating manoeuvres that would tell {rivals[0]} from {rivals[1]}")
    chosen = _own_set(told, rivals[0])
    z = np.ones(len(case.effects)) if chosen is None else found[chosen].posterior.z
    return next_manoeuvre(case, case.model, *rivals, z)


def _not_possible(case: Case) -> list[dict[str, Any]]:
    """Effects that could not be judged, and for want of which columns or particulars."""
    return [
        {
            "effect": name,
            "lacks": [
                INPUTS.get(n, n) for n in unjudged_because(name, case.tracks, case.model, case.catalogue)
            ],
        }
        for name in case.catalogue
        if name not in case.candidates and name not in case.present
    ]

"""`twin diagnose`: which physical effect is missing, in newtons, with its confidence, or an honest answer
that is none."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.physics.ship import Ship
from twin.recording.checks import of_voyages
from twin.recording.inputs import INPUTS
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.calibration.doubts import coarse_axes
from twin.study.diagnosis.altered import sized
from twin.study.diagnosis.assemble import assemble, unjudged_because
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.led import held_out_error, horizon_s
from twin.study.diagnosis.leftover import (
    asked_for,
    changed,
    explaining,
    helpful,
    missed,
    too_small,
    undone,
    weathered,
)
from twin.study.diagnosis.manoeuvres import next_manoeuvre
from twin.study.diagnosis.moments import moments
from twin.study.diagnosis.overtime import over_time
from twin.study.diagnosis.refine import Found
from twin.study.diagnosis.search import search
from twin.study.diagnosis.verdict import SURE, alike, group, judge, parameters, shows, typical_force, weights
from twin.study.estimation.start import waves_on

SCHEMA_VERSION = 1
SHOWN = 8  # candidates in the answer: all that are at least LEAST likely, and no more than this
LEAST = 0.05


@dataclass(frozen=True)
class Diagnosis:
    """The contract's JSON, and what a report draws it from."""

    result: dict[str, Any]
    case: Case
    found: dict[tuple[str, ...], Found]


def diagnose(
    voyages: Sequence[Voyage],
    ship: Ship,
    references: Sequence[Voyage] = (),
    progress: Callable[[str], None] = lambda text: None,
) -> Diagnosis:
    """Judge all candidates jointly on these voyages."""
    case = assemble(voyages, ship, references, progress)
    weighed, found, seen = search(case, progress)
    w = weights(case, weighed)
    best = found[w.best.effects]
    explain = explaining(case, weighed, found)
    no_pair, rough = undone(case, best), weathered(case, found[()])
    leads = asked_for(case, found, w.effects, case.names(helpful(case, found, explain)), rough)
    explained = not case.news(w.best.effects) or (bool(explain) and not no_pair)
    if too_small(case, found, explain, rough):
        leads += [n for n in case.names(explain) if w.effects[n] >= SURE and changed(case, found[explain], n)]
    like = {name: alike(case, weighed, name) for name in case.names(w.best.effects)}
    sharp = shows(seen) and not missed(found[()] if case.news(w.best.effects) else best)
    blurred = no_pair or rough or (not explained and not missed(found[()]))
    coarse, happened = coarse_axes(case.path.share), moments(case, best)
    able = case.excited and not coarse
    verdict, missing = judge(
        weighed,
        w,
        like,
        leads,
        able=able,
        sharp=sharp,
        explained=explained,
        blurred=blurred,
        pushed=bool(happened),
    )
    nothing = 0.0 if happened and verdict == "unknown" else w.nothing
    likely = [n for n in sorted(w.effects, key=lambda n: -w.effects[n]) if w.effects[n] >= LEAST][:SHOWN]
    likely = sorted(dict.fromkeys([*missing, *likely]), key=lambda n: -w.effects[n])
    progress("predicting held-out parts")
    candidates = [_candidate(case, weighed, found, missing, name, w.effects[name]) for name in likely]
    resembles = [
        _candidate(case, weighed, found, missing, name, p) for name, p in w.unnamed.items() if p >= SURE
    ]
    if w.best.effects:
        progress("asking each part of the voyages")
        parts = over_time(case, best, w.best.effects)
        for c in candidates:
            if c.get("effect") in parts:
                c["over_time"] = parts[c["effect"]]
    result = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "verdict": verdict,
        "missing": missing,
        "one_of": group(weighed, w) if verdict == "undecided" and able and explained else [],
        "probabilities": {
            "nothing_missing": nothing,
            "unknown": w.unknown + w.nothing - nothing if explained else 1.0 - nothing,
        },
        "candidates": [c for c in candidates if c],
        "resembles": resembles if verdict in ("unknown", "missing") else [],
        "undo_each_other": list(w.best.effects) if no_pair else [],
        "unclear": [
            n
            for n in explain
            if n not in leads and (case.catalogue[n].kind == "SensorFault" or n in case.present)
        ],
        "moments": [m.told(case.model) for m in happened],
        "path": {
            "horizon_s": horizon_s(case.tracks[0], case.model),
            "error_without": found[()].off_m,
            "error_floor": found[()].floor_m,
        },
        "next_manoeuvre": _next(
            case,
            found,
            verdict,
            missing,
            candidates,
            {n: p for n, p in w.effects.items() if seen[n]},
            progress,
        ),
        "not_judged": _not_judged(case),
        "as_on_references": list(case.no_news),
        "not_visible": [
            n for n, can in seen.items() if not can and n not in [*missing, *case.no_news, *case.present]
        ],
        "floor": {
            "share_surge_sway_yaw": case.floor.share,
            "sensor_factor": case.floor.sensor,
            "temper": case.temper,
        },
        "voyages": [v.name for v in voyages],
        "waves": waves_on(case.tracks),
        "weather_may_mislead": rough,
        "voyages_hold_a_manoeuvre": case.excited,
        "calibrated_too_coarsely": coarse,
        "references": [v.name for v in references],
        "data_checks": of_voyages([*voyages, *references], ship),
    }
    return Diagnosis(plain(result), case, found)


def _candidate(
    case: Case,
    weighed: Sequence[Any],
    found: dict[tuple[str, ...], Found],
    missing: Sequence[str],
    name: str,
    probability: float,
) -> dict[str, Any]:
    """One effect with its numbers: what is named as it stands in the answer, the others as they stand in the
    best set that holds them."""
    sets = [h.effects for h in weighed if name in h.effects and h.effects in found]
    sets.sort(key=lambda s: name not in missing or set(s) != set(missing))
    if not sets:
        return {}
    best = found[sets[0]]
    return {
        "effect": name,
        "probability": probability,
        "parameters": parameters(case, sized(case, best), name),
        "typical_force": typical_force(case, best.model, name),
        "error_horizon_s": horizon_s(case.tracks[0], case.model),
        "error_without": found[()].off_m,
        "error_with": held_out_error(case, best) if np.isnan(best.off_m) else best.off_m,
        "error_floor": best.floor_m,
        "together_with": [n for n in best.hypothesis.effects if n != name],
        "cannot_be_told_from": alike(case, weighed, name),
        "says": (case.catalogue[name].__doc__ or "").strip().splitlines()[0],
    }


def _next(
    case: Case,
    found: dict[tuple[str, ...], Found],
    verdict: str,
    missing: Sequence[str],
    candidates: Sequence[dict[str, Any]],
    likely: dict[str, float],
    progress: Callable[[str], None],
) -> dict[str, Any] | None:
    """What to sail next, when two effects stand in each other's way or the voyages could not tell."""
    if verdict == "nothing_missing":
        return None
    listed = [c for c in candidates if c]
    rivals = next(
        (
            (c["effect"], o)
            for c in listed
            for o in c["cannot_be_told_from"]
            if c["effect"] in missing or verdict != "missing"
        ),
        None,
    )
    if rivals is None and verdict == "undecided" and len(likely) > 1:
        first, second, *_ = sorted(likely, key=lambda n: -likely[n])
        rivals = (first, second)
    if rivals is None:
        return None
    progress(f"sailing manoeuvres that would tell {rivals[0]} from {rivals[1]}")
    sets = [s for s in found if rivals[0] in s]
    z = found[sets[0]].posterior.z if sets else np.ones(len(case.effects))
    return next_manoeuvre(case, case.model, *rivals, z)


def _not_judged(case: Case) -> list[dict[str, Any]]:
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

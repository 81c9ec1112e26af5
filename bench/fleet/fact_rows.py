"""One ship of the fleet asked: a first model from particulars, calibrated on its references, then
`diagnose` on
each voyage; a row of facts and truth for each."""

import pickle
import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

import twin
from bench.fleet.hidden_causes import CATALOGUE
from bench.fleet.plausibility import build
from bench.fleet.random_ship import RandomShip
from bench.fleet.voyage_plan import FleetCase, SailedCase, generator, plan, references, sailed
from twin.errors import TwinError
from twin.physics.ship import Ship as Model
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.effect_diagnosis import Diagnosed, diagnose
from twin.study.diagnosis.open_loop_check import held_out_error
from twin.study.diagnosis.refine import Found, refine
from twin.study.first_model.first_estimate import OPTIONS, first_model

KEPT_FACTS = (
    "verdict",
    "reason",
    "missing",
    "further",
    "more",
    "one_of",
    "probabilities",
    "weather",
    "rivals",
    "answer",
    "path",
    "floor",
    "not_judged",
    "not_visible",
    "p_value",
    "p_value_at_best",
    "p_value_score",
    "facts",
)


def voyage(s: SailedCase) -> Voyage:
    how = {"velocity_frame": s.velocity_frame} if s.velocity_frame else {}
    return Voyage(s.name, s.time_s, s.columns, {"source": "bench.fleet", **how})


def calibrated(ship: RandomShip) -> tuple[Model, dict[str, Any]]:
    """The ship as its owner has it after `twin init` and `twin calibrate`; seconds and number of
    references."""
    began = time.process_time()
    given = {name: None for name, *_ in OPTIONS} | ship.given(generator(ship, 4))
    start, _ = first_model(f"{ship.family}-{ship.seed}", given)
    sailed_before = [voyage(s) for s in references(ship)]
    done = twin.calibrate(start, sailed_before)
    said = done.to_dict()
    return done.ship, {
        "references": len(sailed_before),
        "calibration_s": time.process_time() - began,
        "reference_s": sum(v.duration_s for v in sailed_before),
        "share": said["floor"]["share"],
        "left_out_scores": done.ship.notes["structural"].get("left_out_scores", []) if done.accepted else [],
        "knows": [type(e).__name__ for e in done.ship.effects],
        "fitted_by": said["fitted_by"],
        "accepted": done.accepted,
    }


def rows(
    family: str, seed: int, voyages: int, store: Path | None, done: frozenset[str], until: float = np.inf
) -> Iterator[dict[str, Any]]:
    """A row a voyage of this ship; those whose keys are `done` are not asked again. The calibrated ship is
    kept
    in `store`."""
    ship = build(family, seed)
    cases = [c for c in plan(ship, voyages) if c.key not in done]
    if not cases:
        return
    kept = store / f"{family}-{seed}.pickle" if store else None
    if kept and kept.exists():
        model, facts = pickle.loads(kept.read_bytes())
    else:
        model, facts = calibrated(ship)
        if kept:
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_bytes(pickle.dumps((model, facts)))
    for case in cases:
        if time.time() < until:
            yield _rows_of_voyage(ship, case, model, facts)


def _rows_of_voyage(ship: RandomShip, case: FleetCase, model: Model, facts: dict[str, Any]) -> dict[str, Any]:
    one, began = sailed(ship, case), time.process_time()
    row: dict[str, Any] = {
        "key": case.key,
        "family": case.family,
        "seed": case.seed,
        "kind": case.kind,
        "hidden": case.hidden,
        "flaws": one.flaws,
        "day": asdict(one.weather),
        "minutes": one.time_s[-1] / 60,
        "length_m": ship.p.L,
        "speed_mps": ship.p.U0,
        "instruments": {
            k: v for k, v in asdict(ship.kit).items() if k.startswith("has_") or k in ("coarse", "every_s")
        },
        # how late the receiver is on every voyage of this ship [s]
        "own_late_s": (ship.kit.gnss_late + ship.kit.speed_late) / 2,
        "ordered": ship.drive.ordered,
        "version": twin.__version__,
        **facts,
    }
    try:
        said = diagnose([voyage(one)], model)
        row["cpu_s"] = time.process_time() - began
    except Exception as error:  # a case that cannot be asked is a row that says so
        return row | {"failed": f"{type(error).__name__}: {error}"}
    result = said.result
    try:
        row["oracle"] = oracle(said, case)
    except TwinError:  # such as a set whose numbers no part of the voyage tells: as without one
        row["oracle"] = None
    row |= {k: result[k] for k in KEPT_FACTS if k in result}
    row["candidates"] = [
        {
            k: c[k]
            for k in (
                "effect",
                "probability",
                "posterior",
                "parameters",
                "typical_force",
                "error_without",
                "error_with",
                "error_floor",
                "cannot_be_told_from",
            )
        }
        for c in result["candidates"]
    ]
    row["judged"] = [
        {
            "effects": s,
            "weight": f.hypothesis.log_weight,
            "scenario": f.hypothesis.scenario,
            "error_m": f.open_loop_error_m,
            "expected_m": f.expected_error_m,
        }
        for s, f in said.found.items()
    ]
    return plain(row)


def oracle(said: Diagnosed, case: FleetCase) -> dict[str, Any] | None:
    """Open-loop error with the best of the day's weather that holds nothing of what is hidden, and with what
    is truly hidden beside the day's weather [m]; of several causes, by what share each of them brings that
    error down, the others known."""
    c = said.case
    true = c.ordered([n for n in case.hidden if n in CATALOGUE])
    if len(true) < len(case.hidden) or not true:
        return None
    held = {part for n in true for part in c.catalogue[n].holds}
    true = tuple(n for n in true if n not in held)

    def apart(name: str) -> bool:
        return name not in (*true, *held) and not set(c.catalogue[name].holds) & set(true)

    day = tuple(n for n in said.result["facts"]["likeliest"] if n in c.weather and apart(n))
    without = min(
        f.open_loop_error_m
        for s, f in said.found.items()
        if np.isfinite(f.open_loop_error_m) and not c.causes(s) and all(map(apart, s))
    )
    found, error = _known(said, (*day, *true))
    causes = c.causes(true) if len(true) > 1 else ()
    less = {n: _known(said, (*day, *(m for m in true if m != n)))[1] for n in causes}
    return {
        "without_m": without,
        "with_m": error,
        "gain_by_each": {n: 1 - error / of for n, of in less.items()},
        "numbers": _numbers(c, found, true),
    }


def _known(said: Diagnosed, effects: Iterable[str]) -> tuple[Found, float]:
    """This set fitted to the voyage, and its open-loop error [m]."""
    c = said.case
    chosen = c.ordered(effects)
    found = said.found.get(chosen)
    if found is None:
        found = refine(c, chosen, "usual", np.zeros(len(c.effects)), ())[0]
    error = found.open_loop_error_m
    return found, error if np.isfinite(error) else held_out_error(c, found)


def _numbers(c: Case, found: Found, effects: Iterable[str]) -> dict[str, list[float]]:
    """Each number of these effects with its standard deviation."""
    return {
        u.label: [
            float(u.centre + u.sd * found.posterior.z[i]),
            float(u.sd * found.posterior.covariance[i, i] ** 0.5),
        ]
        for i, u in enumerate(c.effects)
        if u.owner in effects
    }

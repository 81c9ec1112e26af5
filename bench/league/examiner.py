"""One question of the league: the diagnosis, and what `add` makes of it beside an oracle that was told the
truth."""

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bench.league.league_ships import ships_of
from bench.league.league_voyages import kept
from bench.league.peer import peer
from bench.league.plan import Question
from bench.league.truth import beside
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.prediction.openloop import predict
from twin.study.reference.sailed import fed
from twin.study.reference.seaway import swung
from twin.study.track.track import Track, track
from twin.study.update.adding import fitted

HORIZON_S = 120.0
_SHIPS: dict[str, dict[str, Any]] = {}


def judge(question: Question, folder: Path) -> dict[str, Any]:
    """A row of the league's log; a diagnosis that raises is a failed question, not a failed league."""
    row = {
        "key": question.key,
        "hull": question.hull,
        "kind": question.kind,
        "hidden": dict(question.hidden),
        "decoys": question.decoys,
        "known": question.known,
        "missing_truly": question.missing,
        "manoeuvre": question.manoeuvre,
        "seed": question.seed,
        "duration_s": question.duration_s,
    }
    ship, (voyage, truth) = _ship(question, folder), kept(question.case(), folder)
    wall, cpu = time.perf_counter(), time.process_time()
    try:
        answer = diagnose([voyage], ship).result
    except Exception as error:  # told in the table as a failure
        return row | {"verdict": "failed", "missing": [], "why": f"{type(error).__name__}: {error}"}
    row |= {"seconds": time.perf_counter() - wall, "cpu_seconds": time.process_time() - cpu} | kept_answer(
        answer
    )
    by_name = {c["effect"]: c for c in answer["candidates"]}
    row["parameters"] = [
        p
        for n in question.missing
        if n in answer["missing"]
        for p in beside(n, by_name[n]["parameters"], truth[n])
    ]
    if question.kind == "effect" and (
        found := peer(track(voyage, ship), Model.of(ship), question.missing[0])
    ):
        row["peer"] = found
    if question.proves:
        row |= errors(question, ship, answer["missing"], voyage, folder)
    return row


def kept_answer(answer: dict[str, Any]) -> dict[str, Any]:
    """The part of a diagnosis that the league keeps."""
    first = next((c for c in answer["candidates"] if answer["missing"][:1] == [c["effect"]]), None)
    manoeuvre = answer["next_manoeuvre"]
    return {
        "verdict": answer["verdict"],
        "missing": answer["missing"],
        "group": first["cannot_be_told_from"] if first else answer["one_of"],
        "nothing": answer["probabilities"]["nothing_missing"],
        "unknown": answer["probabilities"]["unknown"],
        "candidates": {c["effect"]: c["probability"] for c in answer["candidates"]},
        "next_manoeuvre": manoeuvre["manoeuvre"] if manoeuvre else None,
    }


def errors(
    question: Question, ship: Ship, named: Sequence[str], voyage: Any, folder: Path
) -> dict[str, float]:
    """Mean 120 s position error [m] on the other manoeuvre: as the ship was, after `add` of what was named,
    and of the truth."""
    # as `twin add` reads them
    used, other = (
        swung(track(v, ship), Model.of(ship)) for v in (voyage, kept(question.held_out(), folder)[0])
    )
    out = {"before": error_of(Model.of(ship), other)}
    out["oracle"] = error_of(added(ship, question.missing, used), other)
    same = set(named) == set(question.missing)
    out["after"] = (
        out["oracle"] if same else error_of(added(ship, named, used), other) if named else out["before"]
    )
    return out


def added(ship: Ship, names: Sequence[str], used: Track) -> Model:
    """What `twin add` makes of these effects on this voyage."""
    return fitted(ship, [find(n) for n in names], [used]).model


def error_of(model: Model, other: Track) -> float:
    windows = predict(other, fed(model, other)[0], [HORIZON_S], leads=1)
    return float(np.nanmean(windows.errors()["position"][windows.at(HORIZON_S)]))


def _ship(question: Question, folder: Path) -> Ship:
    if question.hull not in _SHIPS:
        _SHIPS[question.hull] = ships_of(question.hull, folder)
    ship: Ship = _SHIPS[question.hull][question.known[0] if question.known else ""]
    return ship

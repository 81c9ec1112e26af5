"""`twin add`: put a named effect into a ship's model, fit it, and prove that the error falls where it was not
fitted."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from twin.errors import DataError
from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.checks import of_voyages
from twin.recording.jsonable import plain
from twin.study.prediction.openloop import HORIZONS_S
from twin.study.reference.sailed import Sailed
from twin.study.reference.structure import floor_of
from twin.study.track.track import Track
from twin.study.update.added import notes, verdict, written
from twin.study.update.adding import ahead, can_be_judged, fitted, thirds
from twin.study.update.proof import Fall, by_regime, fall, judged_at, ladder

SCHEMA_VERSION = 1


@dataclass(frozen=True)
class Added:
    """What was found: the new ship (with its history), the proof, and the JSON."""

    ship: Ship
    model: Model
    fall: Fall
    result: dict[str, Any]
    held: list[Track]


def add(
    ship: Ship,
    effects: Sequence[type[Effect]],
    sailed: Sequence[Sailed],
    held_out: Sequence[Sailed] = (),
    force: bool = False,
) -> Added:
    """Fit the effects to the voyages and judge them on the held-out ones (without any: on the last third of
    each)."""
    for effect in effects:
        effect.plausible(ship).check(ship)
    can_be_judged(effects, [s.track for s in (*sailed, *held_out)])
    used, held = (
        ([s.track for s in sailed], [s.track for s in held_out])
        if held_out
        else thirds([s.track for s in sailed])
    )
    model, found = fitted(ship, effects, used)
    before, after = ahead(held, Model.of(ship), HORIZONS_S), ahead(held, model, HORIZONS_S)
    structural = floor_of(ship) is not None
    rows = ladder(before, after, HORIZONS_S, structural)
    if not rows:
        raise DataError(
            f"{', '.join(t.name for t in held)}: too short to judge by. Give another voyage with --held-out."
        )
    horizon_s = judged_at(before, [row["horizon_s"] for row in rows], ship)
    proof = fall(before, after, horizon_s)
    result = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "added": [e.__name__ for e in effects],
        "accepted": proof.proved or force,
        "forced": force and not proof.proved,
        "parameters": {
            n: {f.name: f.entry() for f in found if f.effect == n} for n in (e.__name__ for e in effects)
        },
        "judged_by": {
            "measure": proof.measure,
            "unit": proof.unit,
            "before": proof.before,
            "after": proof.after,
            "low95": proof.low95,
            "high95": proof.high95,
        },
        "horizons": rows,
        "where": by_regime(before, after, horizon_s, ship, structural),
        "voyages": [s.provenance() for s in sailed],
        "held_out": [s.provenance() for s in held_out]
        or [s.provenance() | {"part": "last third"} for s in sailed],
        "notes": notes(ship, found, sailed, held_out),
        "data_checks": of_voyages([s.voyage for s in (*sailed, *held_out)], ship),
    }
    result["verdict"] = verdict(result, proof)
    result = plain(result)
    return Added(written(ship, model, result), model, proof, result, held)

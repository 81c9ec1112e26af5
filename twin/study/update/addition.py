"""`twin add`: put a named effect into a ship's model, fit it, and prove that what was not fitted is likelier
with it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.checks import of_voyages
from twin.recording.jsonable import plain
from twin.recording.progress import Progress, silent
from twin.study.prediction.openloop import HORIZONS_S
from twin.study.reference.sailed import Sailed
from twin.study.reference.structure import noise_model_of
from twin.study.track.track import Track
from twin.study.update.added import notes, verdict, written
from twin.study.update.adding import fitted, require_inputs, thirds
from twin.study.update.fall import Fall, by_regime, error_rows, fall
from twin.study.update.held_parts import predicted
from twin.study.update.proof import HeldOutProof, prove

SCHEMA_VERSION = 1
# what a proof rests on
HELD_OUT, LAST_THIRD, CROSS_VALIDATED = "held-out voyages", "last third", "cross-validated"


@dataclass(frozen=True)
class Added:
    """What was found: the new ship (with its history), the proof and its illustration in metres, and the
    JSON."""

    ship: Ship
    model: Model
    proof: HeldOutProof
    fall: Fall
    result: dict[str, Any]
    held: list[Track]


def add(
    ship: Ship,
    effects: Sequence[type[Effect]],
    sailed: Sequence[Sailed],
    held_out: Sequence[Sailed] = (),
    force: bool = False,
    cross_validated: bool = False,
    progress: Progress = silent,
) -> Added:
    """Fit the effects to the voyages and judge them on the held-out ones; without any on the last third of
    each, or (`cross_validated`) on every third in turn. DataError: a sign, unit or frame of one is proved
    wrong, or what is held out is too short, or has too few positions, to judge by."""
    checks = of_voyages([s.voyage for s in (*sailed, *held_out)], ship)
    for effect in effects:
        effect.plausible(ship).check(ship)
    require_inputs(effects, [s.track for s in (*sailed, *held_out)])
    used, held, kind = _divided([s.track for s in sailed], [s.track for s in held_out], cross_validated)
    made = fitted(ship, effects, used, progress)
    progress("predicting what was held out")
    windows = predicted(made, held, HORIZONS_S, cross_validated)
    proof = prove(
        windows.judged_before,
        windows.judged_after,
        windows.errors,
        windows.horizons_s,
        float(ship.scale("time")),
    )
    structural = noise_model_of(ship) is not None
    rows = error_rows(windows.before, windows.after, windows.shown_s, ship, structural)
    shown = fall(windows.before, windows.after, [row["horizon_s"] for row in rows] or windows.horizons_s)
    parts = (
        {} if kind == HELD_OUT else {"part": "last third" if kind == LAST_THIRD else "every third in turn"}
    )
    result = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "added": [e.__name__ for e in effects],
        "accepted": proof.proved or force,
        "forced": force and not proof.proved,
        "parameters": _by_effect(made.numbers),
        "beside": _by_effect(made.beside),
        "proof": {"kind": kind} | proof.entry(),
        "judged_by": shown.entry(),
        "horizons": rows,
        "where": by_regime(windows.before, windows.after, shown.horizon_s, ship, structural),
        "voyages": [s.provenance() for s in sailed],
        "held_out": [s.provenance() | parts for s in held_out or sailed],
        "notes": notes(ship, made, sailed, held_out, kind == LAST_THIRD),
        "data_checks": checks,
    }
    result["verdict"] = verdict(result, proof, shown)
    result = plain(result)
    return Added(written(ship, made.model, result), made.model, proof, shown, result, held)


def _divided(
    tracks: list[Track], held_out: list[Track], cross_validated: bool
) -> tuple[list[Track], list[Track], str]:
    """What is fitted, what is judged, and how to say so."""
    if held_out:
        return tracks, held_out, HELD_OUT
    return (tracks, tracks, CROSS_VALIDATED) if cross_validated else (*thirds(tracks), LAST_THIRD)


def _by_effect(numbers: Sequence[Any]) -> dict[str, dict[str, Any]]:
    return {
        name: {n.name: n.entry() for n in numbers if n.effect == name}
        for name in dict.fromkeys(n.effect for n in numbers)
    }

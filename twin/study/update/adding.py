"""Fit named effects to voyages, the core kept as it is, and judge them on windows that were not used."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.live.signals.channels import BY_NAME
from twin.physics.effect import Effect
from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.jsonable import short
from twin.study.estimation.columns import Unknown, effect_unknowns
from twin.study.estimation.fit import Fit, fit
from twin.study.estimation.innovations import Floor, innovate, linearise
from twin.study.prediction.openloop import Windows, predict
from twin.study.reference.nuisance import TEMPER, from_ship, nuisance_unknowns
from twin.study.reference.sailed import fed
from twin.study.reference.seaway import levelled
from twin.study.reference.structure import floor_of
from twin.study.track.track import Track

UNTOUCHED = 0.1  # a number whose doubt shrank by less was not excited
FIELDS = {c.attribute: c.name for c in BY_NAME.values()} | {
    "wind_to": "true_wind_direction_deg",
    "wave_to": "wave_direction_deg",
}


@dataclass(frozen=True)
class Found:
    """One number of an added effect, with its 95 % interval (inside its box) and how much of the doubt the
    voyages removed."""

    effect: str
    name: str
    unit: str
    value: float
    sd: float
    low95: float
    high95: float
    gained: float

    def entry(self) -> dict[str, Any]:
        return {
            "value": self.value,
            "unit": self.unit,
            "sd": self.sd,
            "low95": self.low95,
            "high95": self.high95,
        }


def can_be_judged(effects: Sequence[type[Effect]], tracks: Sequence[Track]) -> None:
    """DataError when an effect needs what a voyage did not record."""
    for effect in effects:
        for t in tracks:
            lacks = sorted(t.missing().intersection(effect.needs))
            if lacks:
                raise DataError(
                    f"{t.name}: {effect.__name__} needs {', '.join(FIELDS.get(f, f) for f in lacks)}, which "
                    "was not recorded. "
                    "Record it, leave this voyage out, or choose another effect."
                )


def in_one(model: Model, tracks: Sequence[Track]) -> Model:
    """The model without the effects that any of the tracks cannot feed."""
    for t in tracks:
        model, _ = fed(model, t)
    return model


def fitted(ship: Ship, effects: Sequence[type[Effect]], tracks: Sequence[Track]) -> tuple[Model, list[Found]]:
    """The ship's model with these effects at their most probable size."""
    base, known = Model.of(ship), catalogue()
    known = known | {e.__name__: e for e in effects}
    unknowns = [u for e in effects for u in effect_unknowns(e, Model(ship))]
    floor = floor_of(ship) or Floor()
    usable = in_one(base, tracks)
    tracks = [levelled(t) for t in tracks]
    found = fit(tracks, usable, unknowns, known, floor, temper=_temper(ship))
    sd = _doubt(found, base, tracks, floor, known, _temper(ship))
    names = {e.__name__ for e in effects}
    made = [_written(e, ship) for e in found.model.effects if type(e).__name__ in names]
    value = [float(getattr(e, u.name)) for u in unknowns for e in made if type(e).__name__ == u.owner]
    return base.but(*made), [_found(u, v, s) for u, v, s in zip(unknowns, value, sd, strict=True)]


def _written(effect: Effect, ship: Ship) -> Effect:
    """The effect with as many digits as a file should hold, still inside its boxes."""
    values = {}
    for p in effect.params():
        low, high = p.box(ship)
        values[p.name] = min(max(short(float(getattr(effect, p.name))), low), high)
    return effect.but(**values)


def _temper(ship: Ship) -> float:
    """How much less the innovations tell than white ones would, as calibration found it."""
    return float(ship.notes.get("structural", {}).get("temper", TEMPER))


def _doubt(
    found: Fit,
    base: Model,
    tracks: Sequence[Track],
    floor: Floor,
    known: dict[str, type[Effect]],
    temper: float,
) -> np.ndarray:
    """(P,) standard errors, the doubt about core and instruments included: it is wider than that of a fit
    with the core fixed. How much of the effect is usual on her is among them: the reference voyages cannot
    tell it from her core, but tell well what both together are."""
    beside = nuisance_unknowns(base, known)
    every: list[Unknown] = [*found.unknowns, *beside]
    at = {u.label: float(value) for u, value in zip(found.unknowns, found.value, strict=True)}
    lines = [linearise(t, found.model, every, known, at) for t in tracks]
    A, _, _ = innovate(lines, [floor])[0].total()
    sd, P = np.array([u.sd for u in every]), len(found.unknowns)
    A = A * np.outer(sd, sd) / temper
    A[:P, :P] += np.eye(P)
    A[P:, P:] += from_ship(base, beside).information
    return np.sqrt(np.diag(np.linalg.inv(A))[:P]) * sd[:P]


def _found(u: Unknown, value: float, sd: float) -> Found:
    low, high = max(u.lo, value - 1.96 * sd), min(u.hi, value + 1.96 * sd)
    return Found(
        u.owner,
        u.name,
        u.unit,
        float(value),
        float(sd),
        float(low),
        float(high),
        1.0 - min(sd / u.sd, 1.0) ** 2,
    )


def thirds(tracks: Sequence[Track]) -> tuple[list[Track], list[Track]]:
    """The first two thirds of every voyage, and the last."""
    cut = [round(2 * len(t) / 3) for t in tracks]
    return [t.part(0, k) for t, k in zip(tracks, cut, strict=True)], [
        t.part(k, len(t)) for t, k in zip(tracks, cut, strict=True)
    ]


def ahead(tracks: Sequence[Track], model: Model, horizons_s: Sequence[float]) -> list[Windows]:
    """Open-loop predictions of every voyage."""
    floor = floor_of(model.ship)
    return [predict(t, fed(model, t)[0], horizons_s, floor=floor, seed=i) for i, t in enumerate(tracks)]

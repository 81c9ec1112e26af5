"""Fit named effects to voyages as a diagnosis would: the same likelihood, the same nuisances, the same number
with the same interval.

The named effects are a hypothesis like any other (refine.py): core, instruments, and a little of every other
effect are integrated out as the reference voyages left them. The water and the weather of the voyage are no
part of the ship: a stream, constant or slowly varying, and wind and sea that were recorded and that the model
does not know, stand beside the named effects where they make the voyages likelier."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.errors import DataError, SettingsError
from twin.live.signals.channels import BY_NAME
from twin.physics.effect import Effect
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.progress import Progress, silent
from twin.study.diagnosis.as_filed import in_file, model_with
from twin.study.diagnosis.assemble import of_tracks
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found, Sets, standing
from twin.study.diagnosis.verdict import parameters
from twin.study.estimation.box import at_an_end
from twin.study.estimation.columns import Unknown
from twin.study.estimation.innovations import innovate
from twin.study.prediction.openloop import Windows, predict
from twin.study.reference.evidence import Posterior, boxed, given, posterior, reduce
from twin.study.reference.sailed import fed
from twin.study.reference.structure import noise_model_of
from twin.study.track.track import Track
from twin.study.update.beside import beside_the_voyage

FOLDS = 3  # parts of every voyage, each predicted with numbers fitted to the others
UNTOUCHED = 0.1  # a number whose variance changed by a smaller share was not excited
FIELDS = {c.attribute: c.name for c in BY_NAME.values()} | {
    "wind_to": "true_wind_direction_deg",
    "wave_to": "wave_direction_deg",
}


@dataclass(frozen=True)
class Number:
    """One number of an effect, with its 95 % interval (inside its box) and the share by which the voyages
    changed its prior's variance (wider where it is far beyond the usual)."""

    effect: str
    name: str
    unit: str
    value: float
    sd: float
    low95: float
    high95: float
    gained: float
    at_box_end: bool

    def entry(self) -> dict[str, Any]:
        """Its entry in the JSON."""
        return {
            "value": self.value,
            "unit": self.unit,
            "sd": self.sd,
            "low95": self.low95,
            "high95": self.high95,
            "at_box_end": self.at_box_end,
        }


@dataclass(frozen=True)
class Fitted:
    """The named effects on these voyages: the model with them (and nothing of the voyage), their numbers,
    those of the voyage's own water and weather, and what another part of the voyages would make of them."""

    model: Model
    numbers: list[Number]
    beside: list[Number]
    names: Sets
    case: Case
    found: Found

    def of_parts(self) -> list[Model]:
        """For each of the FOLDS of every voyage the model with numbers fitted to the others. What changes
        with the clock is taken as the whole voyages have it: no other hour tells of it."""
        case, chosen = self.case, self.found.hypothesis.effects
        lines, at = standing(case, self.found)
        normal = innovate(lines, case.scenarios([self.found.hypothesis.scenario], self.found.doubt), None)[0]
        of = parts_of(case.tracks, [line.track for line in lines], normal.where)
        lasts = np.array(["t" not in case.catalogue[u.owner].needs for u in case.effects])
        models = []
        for k in range(FOLDS):
            part = reduce(normal.only(of != k), case.nuisance, case.unknowns, case.effects, case.temper, at)
            z, left = self.found.posterior.z.copy(), given(part, self.found.posterior.z, ~lasts)
            z[lasts] = boxed(left, chosen, posterior(left, chosen)).z
            models.append(model_with(self.case, self.names, z))
        return models


def part_of(step: float, steps: int) -> int:
    """The part of a voyage of so many steps in which a step of its track lies."""
    return min(FOLDS - 1, int(FOLDS * step / steps))


def parts_of(
    tracks: Sequence[Track], read: Sequence[Track], segments: Sequence[tuple[int, int, int]]
) -> np.ndarray:
    """(S,) in which part [count] of its voyage each segment (track, first, last) lies, of what was `read` of
    `tracks`."""
    steps = [np.searchsorted(t.steps(), r.steps()) for t, r in zip(tracks, read, strict=True)]
    return np.array([part_of(float(steps[i][[a, b - 1]].mean()), len(tracks[i])) for i, a, b in segments])


def require_inputs(effects: Sequence[type[Effect]], tracks: Sequence[Track]) -> None:
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


def fitted(
    ship: Ship,
    effects: Sequence[type[Effect]],
    tracks: Sequence[Track],
    progress: Progress = silent,
) -> Fitted:
    """These effects where the voyages have them, beside the voyages' own water and weather. SettingsError:
    an effect is none that these voyages can be asked about."""
    case = of_tracks(tracks, ship, progress=progress, asked=effects)
    unknown = [e.__name__ for e in effects if e.__name__ not in case.candidates]
    if unknown:
        raise SettingsError(
            f"{', '.join(unknown)}: not in the catalogue of effects that these voyages can "
            "judge. See twin effects."
        )
    names = case.ordered([e.__name__ for e in effects])
    progress(f"fitting {', '.join(names)}")
    return of_hypothesis(case, names, beside_the_voyage(case, names, progress))


def of_hypothesis(case: Case, names: Sets, found: Found) -> Fitted:
    """What was found of the named effects, and of what stands beside them."""
    numbers = _numbers(case, found)
    return Fitted(
        model_with(case, names, found.posterior.z),
        [n for n in numbers if n.effect in names],
        [n for n in numbers if n.effect not in names],
        names,
        case,
        found,
    )


def _numbers(case: Case, found: Found) -> list[Number]:
    """Every number of the hypothesis of which the recordings tell, as the diagnosis has it."""
    told = found.posterior
    said = {
        f"{name}.{p['name']}": p for name in found.hypothesis.effects for p in parameters(case, told, name)
    }
    return [
        _number(u, said[u.label], told, i)
        for name in found.hypothesis.effects
        for i, u in enumerate(case.effects)
        if u.owner == name and u.label in said
    ]


def _number(u: Unknown, said: Mapping[str, Any], told: Posterior, i: int) -> Number:
    """Unknown `i` of the effects, with the interval that was `said` of it."""
    value = in_file(u.centre + u.sd * float(told.z[i]), u.lo, u.hi)
    return Number(
        u.owner,
        u.full_name,
        u.unit,
        value,
        u.sd * float(np.sqrt(told.covariance[i, i])),
        min(float(said["low95"]), value),
        max(float(said["high95"]), value),
        abs(1.0 - float(told.covariance[i, i])),
        at_an_end(value, u.lo, u.hi, u.centre, u.sd),
    )


def lasting(names: Sequence[str]) -> list[str]:
    """Those effects that belong to ship or instruments and not to one voyage."""
    return [n for n in names if find(n).lasts()]


def thirds(tracks: Sequence[Track]) -> tuple[list[Track], list[Track]]:
    """The first two thirds of every voyage, and the last."""
    cut = [round(2 * len(t) / 3) for t in tracks]
    return [t.part(0, k) for t, k in zip(tracks, cut, strict=True)], [
        t.part(k, len(t)) for t, k in zip(tracks, cut, strict=True)
    ]


def ahead(tracks: Sequence[Track], model: Model, horizons_s: Sequence[float]) -> list[Windows]:
    """Open-loop predictions of every voyage."""
    noise_model = noise_model_of(model.ship)
    return [
        predict(t, fed(model, t)[0], horizons_s, noise_model=noise_model, seed=i)
        for i, t in enumerate(tracks)
    ]

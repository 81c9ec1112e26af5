"""What is usual on a ship: what its reference voyages leave known of the core, of every lasting effect and of
the instruments."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.study.estimation.columns import Unknown
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import Linear, linearise
from twin.study.prediction.left_out import models_without, path_error
from twin.study.reference.derivatives import first_prior, one_step_core
from twin.study.reference.healthy import left_out_scores
from twin.study.reference.nuisance import known_from, nuisance_unknowns, temper_of, usual_unknowns
from twin.study.reference.reading import fitted_parts
from twin.study.reference.sailed import fed
from twin.study.reference.structure import structural_noise_beside
from twin.study.reference.weather_baseline import strengths
from twin.study.track.track import Track

LASTING_SE = 4.0  # standard errors


def usual(ship: Ship, by_steps: Ship, tracks: Sequence[Track], noise_model: NoiseModel) -> dict[str, Any]:
    """Offsets from the ship `by_steps` (its core is the one by which the noise model was found) and their
    covariance, in the unknowns' own units; by how much numbers differ from voyage to voyage; and the noise
    model `beside` all that. A diagnosis starts from here. In `path_error`, errors of `ship`."""
    model, known = Model.of(by_steps), of_ship(by_steps)
    unknowns, lines = _linearised(by_steps, tracks)
    beside = structural_noise_beside(lines, unknowns, noise_model)
    temper = temper_of(innovate(lines, [beside])[0], unknowns)
    centres = np.array([first_prior(u, by_steps).centre for u in unknowns])
    references = known_from(lines, unknowns, beside, temper, centres)
    nuisance, between = references.nuisance(), references.between
    off = one_step_core(ship, by_steps)
    if off:  # how far leaving a voyage out moves a core is told by the equations about that core
        unknowns, lines = _linearised(ship, tracks)
    path = path_errors(ship, tracks, lines, unknowns, beside, temper, centres, references.scatter)
    sd = np.array([u.sd for u in nuisance.unknowns])
    covariance = np.linalg.inv(nuisance.information)
    return {
        "labels": [u.label for u in nuisance.unknowns],
        "offset": (sd * (covariance @ nuisance.pull)).tolist(),
        "covariance": (covariance * np.outer(sd, sd)).tolist(),
        "daily": nuisance.daily,
        "between_voyages": between,
        "beside": plain(asdict(beside)),
        "temper_beside": temper,
        "weather": strengths(tracks, model, known),
        "left_out_scores": left_out_scores(tracks, model, known, references, beside, temper),
    } | {name: x for name, x in (("path_error", path), ("one_step_core", off)) if x}


def _linearised(ship: Ship, tracks: Sequence[Track]) -> tuple[tuple[Unknown, ...], list[Linear]]:
    """All that a reference voyage may tell of the ship, and what is read of these voyages linearised about
    it."""
    model, known = Model.of(ship), of_ship(ship)
    unknowns, parts = usual_unknowns(model, known), fitted_parts(tracks, model)
    return unknowns, [linearise(t, fed(model, t)[0], unknowns, known) for t in parts]


def path_errors(
    ship: Ship,
    tracks: Sequence[Track],
    lines: Sequence[Linear],
    unknowns: Sequence[Unknown],
    noise_model: NoiseModel,
    temper: float,
    centres: np.ndarray,
    scatter: np.ndarray,
) -> dict[str, Any]:
    """What the ship file keeps of the open-loop error on these voyages, each left out in turn
    (reference/path_error.py); empty where nothing can be predicted. `lines`: `tracks` linearised in
    `unknowns`; `centres` (P,): means of the unknowns' priors, in the unknowns' own units; `scatter` (P,):
    variance of each from voyage to voyage, in prior widths squared."""
    model, sd = Model.of(ship), np.array([u.sd for u in unknowns])
    pull = (centres - np.array([u.centre for u in unknowns])) / sd
    without = models_without(
        model, unknowns, innovate(lines, [noise_model])[0], scatter, pull, temper, of_ship(ship)
    )
    found = path_error(model, tracks, without)
    return found.entry() if found else {}


def significantly_there(ship: Ship, found: dict[str, Any]) -> list[dict[str, Any]]:
    """What this ship clearly shows of lasting effects: not wrong, but part of it. What no ship can show (a
    rudder ahead of its order) stands in for something else, and is allowed for without being told."""
    of = {u.label: u for u in nuisance_unknowns(Model.of(ship), of_ship(ship))}
    can = {label: (u.lo - u.centre, u.hi - u.centre) for label, u in of.items()}
    sd = np.sqrt(np.diag(np.array(found["covariance"])))
    return [
        {"name": label, "value": float(v), "sd": float(s), "unit": of[label].unit}
        for label, v, s in zip(found["labels"], found["offset"], sd, strict=True)
        if not label.startswith(("core.", "form."))
        and abs(v) > LASTING_SE * s
        and can[label][0] <= v <= can[label][1]
    ]

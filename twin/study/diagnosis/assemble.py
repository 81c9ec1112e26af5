"""From voyages and a ship file to a case that can be judged: tracks, candidates, what is known beforehand."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from twin.errors import DataError
from twin.physics.effect import Effect
from twin.physics.effects import of_ship, unnamed_of
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.ship_notes import positive, read_from
from twin.recording.progress import Progress, silent
from twin.recording.voyage import Voyage
from twin.study.diagnosis.case import MOST_SEGMENTS, ODDS, ODDS_UNNAMED, ODDS_WEATHER, Case, settle
from twin.study.diagnosis.horizon import horizon_s, require_positions
from twin.study.estimation.columns import Unknown, core_unknowns, rough_unknowns
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import Linear
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.derivatives import with_one_step_core
from twin.study.reference.evidence import Nuisance
from twin.study.reference.nuisance import (
    TEMPER,
    from_ship,
    known_from,
    nuisance_unknowns,
    placed_by_owner,
    temper_of,
    usual_of_file,
    usual_unknowns,
    with_effects,
)
from twin.study.reference.reading import read_lines
from twin.study.reference.sailed import refuse_twice, samples_hash
from twin.study.reference.seaway import swung
from twin.study.reference.structure import noise_model_of, structural_noise, structural_noise_beside
from twin.study.reference.weather_baseline import as_usual, strengths
from twin.study.track.excitation import manoeuvred
from twin.study.track.segments import long_enough, longest_s, too_short
from twin.study.track.track import Track, track


def assemble(
    voyages: Sequence[Voyage],
    ship: Ship,
    references: Sequence[Voyage] = (),
    progress: Progress = silent,
) -> Case:
    """Everything `search` needs. DataError: the voyages cannot be used at all, or one is given twice or as a
    reference too; SettingsError: the ship file does not hold a calibration as it was written."""
    if not voyages:
        raise DataError("no voyage given. Name at least one file with measurements.")
    called = [v.name for v in voyages] + [f"reference voyage {v.name}" for v in references]
    refuse_twice((name, samples_hash(v)) for name, v in zip(called, (*voyages, *references), strict=True))
    progress("smoothing tracks")
    tracks = [long_enough(track(v, ship), ship) for v in voyages]
    _refuse_pieces(tracks, Model.of(ship))
    require_positions(tracks, Model.of(ship))
    about = Model.of(with_one_step_core(ship))
    return of_tracks([swung(t, about) for t in tracks], ship, references, progress)


def _refuse_pieces(tracks: Sequence[Track], model: Model) -> None:
    """DataError where no voyage is whole for as long as predictions of it are judged."""
    if all(longest_s(t) < horizon_s(t, model) for t in tracks):
        least = min(horizon_s(t, model) for t in tracks)
        raise too_short(", ".join(t.name for t in tracks), least)


def of_tracks(
    sailed: Sequence[Track],
    ship: Ship,
    references: Sequence[Voyage] = (),
    progress: Progress = silent,
    asked: Sequence[type[Effect]] = (),
) -> Case:
    """The same of tracks, with what waves do to them already found (`twin add` has some of a voyage for the
    fit and some for the proof). `asked`: effects that are judged although they wait for kinematics
    (`Effect.suspected_first`); of those in the ship file a change is judged all the same."""
    model, about, tracks = Model.of(ship), Model.of(with_one_step_core(ship)), distinct(sailed)
    wanted = {*asked, *(type(e) for e in model.effects)}
    catalogue = {n: e for n, e in of_ship(ship).items() if not e.suspected_first or e in wanted}
    unnamed = {e.__name__: e for e in unnamed_of(ship)}
    judged = catalogue | unnamed
    candidates = tuple(
        n for n in judgeable(tracks, model, judged) if judged[n] in asked or not placed_by_owner(n, ship)
    )
    as_before = as_usual(strengths(tracks, model, catalogue), _felt_before(references, model, catalogue))
    own = {
        n for n in candidates if judged[n].is_weather() and not judged[n].lasts() and judged[n] not in asked
    }
    effects = tuple(
        u
        for name in candidates
        for u in of_each(effect_unknowns(judged[name], about), tracks if name in own else ())
    )
    nuisance, rough = nuisance_unknowns(about, catalogue), rough_unknowns(about)
    unknowns = with_effects((*nuisance, *rough), effects, about, catalogue)
    before = (
        _of_references(references, about, catalogue, progress)
        if references
        else _of_calibration(about, nuisance)
    )
    daily = usual_of_file(model, catalogue) | dict(before.known.daily)
    daily |= {u.label: daily[key] for u in effects if (key := f"{u.owner}.{u.name}") in daily}
    known = replace(before.known.beside(rough), daily=daily)
    progress("linearising the ship and its instruments along the tracks")
    case = Case(
        tracks=tracks,
        model=model,
        linearised=about,
        catalogue=judged,
        candidates=candidates,
        unknowns=unknowns,
        effects=effects,
        nuisance=known,
        noise_model=before.noise_model,
        path=before.path,
        temper=before.temper,
        odds={
            n: ODDS_WEATHER if e.is_weather() else ODDS_UNNAMED if n in unnamed else ODDS
            for n, e in judged.items()
        },
        lines=read_lines(tracks, about, unknowns, judged, MOST_SEGMENTS),
        excited=any(manoeuvred(t, ship) for t in tracks),
        white=before.noise_model.white,
        scatter=before.noise_model.sensor,
        as_before=as_before,
        unnamed=tuple(unnamed),
    )
    return settle(case)


def distinct(tracks: Sequence[Track]) -> tuple[Track, ...]:
    """The tracks, those of one name told apart by their number."""
    names = [t.name for t in tracks]
    return tuple(
        t if names.count(t.name) == 1 else replace(t, name=f"{t.name} ({i})")
        for i, t in enumerate(tracks, start=1)
    )


def of_each(unknowns: Sequence[Unknown], tracks: Sequence[Track]) -> list[Unknown]:
    """These numbers for each of the voyages by itself, where there are several: each day has its own
    water."""
    if len(tracks) < 2:
        return list(unknowns)
    return [replace(u, voyage=t.name) for t in tracks for u in unknowns]


class KnownBefore(NamedTuple):
    """What was known of the ship before these voyages: the nuisance, and the noise models and temper as
    `Case` has them."""

    known: Nuisance
    noise_model: NoiseModel
    path: NoiseModel
    temper: float


def _of_calibration(model: Model, nuisance: tuple[Unknown, ...]) -> KnownBefore:
    """As the ship file has it."""
    path = noise_model_of(model.ship) or NoiseModel()
    beside = noise_model_of(model.ship, "beside") or path
    return KnownBefore(from_ship(model, nuisance), beside, path, _temper(model.ship))


def _of_references(
    references: Sequence[Voyage], model: Model, catalogue: dict[str, type[Effect]], progress: Progress
) -> KnownBefore:
    """As these reference voyages tell it; under the ship file's noise models, if it has them."""
    ship = model.ship
    path = noise_model_of(ship) or NoiseModel()
    noise_model = noise_model_of(ship, "beside") or path
    progress("reading the reference voyages")
    usual = usual_unknowns(model, catalogue)
    lines = read_lines(
        [swung(long_enough(track(v, ship), ship), model) for v in references], model, usual, catalogue
    )
    if noise_model_of(ship) is None:
        progress("estimating the noise model")
        path = structural_noise(_of_core(lines, usual), core_unknowns(model))
        noise_model = structural_noise_beside(lines, usual, path)
    temper = temper_of(innovate(lines, [noise_model])[0], usual)
    return KnownBefore(known_from(lines, usual, noise_model, temper).nuisance(), noise_model, path, temper)


def _felt_before(
    references: Sequence[Voyage], model: Model, catalogue: dict[str, type[Effect]]
) -> dict[str, float]:
    """How hard measured weather pushed it on the reference voyages, or on those of its calibration."""
    if references:
        return strengths([track(v, model.ship) for v in references], model, catalogue)
    with read_from(model.ship, "[structural] weather"):
        kept = model.ship.notes.get("structural", {}).get("weather", {})
        return {name: float(strength) for name, strength in kept.items()}


def _temper(ship: Ship) -> float:
    """How much less than its likelihood a voyage tells, beside all that is usual on this ship."""
    notes = ship.notes.get("structural", {})
    with read_from(ship, "[structural] temper"):
        return positive(notes.get("temper_beside", notes.get("temper", TEMPER)))


def _of_core(lines: Sequence[Linear], unknowns: Sequence[Unknown]) -> list[Linear]:
    """The same with the core's columns alone."""
    core = np.array([i for i, u in enumerate(unknowns) if u.owner == "core"])
    return [line.only(core) for line in lines]


def judgeable(tracks: Sequence[Track], model: Model, catalogue: dict[str, type[Effect]]) -> tuple[str, ...]:
    """Effects whose inputs at least one voyage holds; of one that the ship has already, a change of it."""
    return tuple(name for name in catalogue if not unjudged_because(name, tracks, model, catalogue))


def unjudged_because(
    name: str, tracks: Sequence[Track], model: Model, catalogue: dict[str, type[Effect]]
) -> tuple[str, ...]:
    """The inputs or particulars for want of which this effect cannot be judged on any of the voyages."""
    effect = catalogue[name]
    lacking = [tuple(n for n in effect.needs if n in t.missing()) for t in tracks]
    if all(lacking):
        return min(lacking, key=len)
    return effect.lacking(model.ship)

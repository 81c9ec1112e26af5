"""Every number that could be wrong, as a column: what one unit of it does to the accelerations and to the
readings.

Derivatives of the core and parameters of the effects are treated alike; a column is a secant over a plausible
size, so that a parameter which is not quite linear counts with what it would really do."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.physics.actuators import NUMBERS, OWN, KeptForces
from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.physics.ship import DERIVATIVES, Ship
from twin.physics.ship_notes import positive, read_from
from twin.study.estimation import form, rough, wave_induced
from twin.study.estimation.respond import (
    accelerations,
    by_lateness,
    faulty,
    moving,
    readings,
    respond,
    sailing,
)
from twin.study.track.track import Track


@dataclass(frozen=True)
class Unknown:
    """One number to be found: whose it is, where it may lie and how wide its prior is (all in the number's
    own unit)."""

    owner: str  # "core" or the name of an effect
    name: str
    unit: str
    centre: float  # prior mean: the ship file's value, or the null of an effect that it does not have
    sd: float
    lo: float
    hi: float
    every_day: bool = False  # whether each day brings a little of it
    # other effects whose number of this name it is, too; of the core: whole names of numbers that it also is
    also: tuple[str, ...] = ()
    varies: float = 0.0  # standard deviation between healthy voyages of one ship, in `sd`
    age: bool = False  # whether it is the age of a reading, which differs from voyage to voyage
    of_file: bool = False  # whether it is how the ship answers to weather that its file knows
    turning: str = ""  # of a compass or receiver: the number of its effect that is the same (of_effect.py)
    voyage: str | None = None  # the track's name of the only voyage on which it acts; None: on all

    @property
    def label(self) -> str:
        """Owner and name, as in core.N_r."""
        return f"{self.owner}.{self.full_name}"

    @property
    def full_name(self) -> str:
        """Its name; of a number that one voyage has for itself, with that voyage."""
        return self.name if self.voyage is None else f"{self.name} of {self.voyage}"

    def acts_on(self, track: Track) -> bool:
        """Whether it does anything on this voyage."""
        return self.voyage in (None, track.name)

    def of_effect(self, value: float) -> dict[str, float]:
        """The numbers of its effect at this value of it."""
        return dict.fromkeys((self.name, self.turning) if self.turning else (self.name,), value)

    @property
    def names(self) -> tuple[str, ...]:
        """Of a number of the core: all the ship's numbers that it is."""
        return self.name, *self.also


def owner_of(label: str) -> str:
    """The owner in a label; names of the core's own numbers may have a dot (core.port.gain), and effects."""
    return "core" if label.startswith("core.") else label.rpartition(".")[0]


FIXED = ("t", "w", "x_R", "epsilon")  # scale other derivatives one for one: the data cannot tell them apart
LATE = "late"  # owner of the instruments' usual lateness: a column, but no part of any model
FORM = "form"  # owner of what the core leaves out of calm water (form.py): the same
SEA = "sea"  # owner of what one wave does at once (wave_induced.py): the same
# owner of what the forms of effects that were added since calibration miss (rough.py): the same
ROUGH = "rough"
NO_MODEL = (LATE, FORM, SEA, ROUGH)
LATENESS = {"log": [6, 7], "compass": [2], "gyro": [5]}  # instrument -> its readings


def lateness_unknowns() -> list[Unknown]:
    """How late each instrument usually is [s]; satellite positions have SensorDelay."""
    return [Unknown(LATE, name, "s", 0.0, 0.15, -1.0, 3.0, age=True) for name in LATENESS]


def form_unknowns() -> list[Unknown]:
    """How much of each term that the core does not have a ship may have [prime units]."""
    return _beside_the_model(FORM, form.TERMS)


def sea_unknowns() -> list[Unknown]:
    """How much of what swings it in time with the waves is the helm's, and goes with the yaw."""
    return _beside_the_model(SEA, wave_induced.TERMS)


def rough_unknowns(model: Model) -> list[Unknown]:
    """How much the forms of weather, and of effects that were added since calibration, miss, in units of what
    they may."""
    return _beside_the_model(ROUGH, dict.fromkeys(rough.TERMS, 1.0)) if rough.added(model) else []


def _beside_the_model(owner: str, terms: dict[str, float]) -> list[Unknown]:
    return [Unknown(owner, name, "", 0.0, sd, -10.0 * sd, 10.0 * sd) for name, sd in terms.items()]


def core_unknowns(model: Model) -> list[Unknown]:
    """The core's derivatives, with the ship file's own standard errors where it has them."""
    own = model.ship.notes.get("derivatives", {})
    out = []
    for name, value, m, also in _learnable(model.ship):
        entry = own.get(name, {})
        told = entry.get("prior_sd") if isinstance(entry, dict) else None
        if told is None:
            sd = max(m["sd"], 0.15 * abs(value) if "." not in name else 0.0)
        else:
            with read_from(model.ship, f"[derivatives] prior_sd of {name}"):
                sd = positive(told)
        out.append(Unknown("core", name, m["unit"], value, sd, m["lo"], m["hi"], also=also))
    return out


# of the propeller and the rudder that a ship with actuators of its own has not, or shares with these
OF_SCREW = ("K_T0", "K_T1")
OF_RUDDER = ("kappa", "C_L", "t_R", "a_H", "x_H", "gamma_v", "gamma_r", "gamma_a")


def _learnable(ship: Ship) -> Iterator[tuple[str, float, Mapping[str, Any], tuple[str, ...]]]:
    """(name, value, declaration, what else is the same number) of every number of the core that voyages may
    tell."""
    rudders = any(a.A_R is not None for a in ship.actuators)
    off = (*OF_SCREW, *(() if rudders else OF_RUDDER)) if ship.actuators else ()
    for f in DERIVATIVES:
        if f.name not in FIXED and f.metadata["sd"] and f.name not in off:
            yield f.name, float(getattr(ship.derivatives, f.name)), f.metadata, ()
    for (name, value, *_), owners in _of_actuators(ship).items():
        one, *others = (f"{owner}.{name}" for owner in owners)
        yield one, value, NUMBERS[name].metadata, tuple(others)


def _of_actuators(ship: Ship) -> dict[tuple[str, float, object], list[str]]:
    """(name, value, whose) of every number of the actuators that voyages may tell, and the actuators that
    share it: the curve of a make and its gain are one, as long as the ship file has them alike for all of
    them. Only where several share a gain has each a gain of its own beside it (a hierarchical prior, written
    so that the numbers' own priors are independent; Gelman et al. 2013, Bayesian Data Analysis, ch. 5)."""
    out: dict[tuple[str, float, object], list[str]] = {}
    for a in ship.actuators:
        for name in a.estimated():
            whose = a.name if name in OWN else a.make
            out.setdefault((name, float(getattr(a, name)), whose), []).append(a.name)
    alone = {owners[0] for (name, *_), owners in out.items() if name == "gain" and len(owners) == 1}
    return {key: owners for key, owners in out.items() if key[0] != "own_gain" or key[2] not in alone}


def columns(
    track: Track,
    model: Model,
    unknowns: Sequence[Unknown],
    catalogue: dict[str, type[Effect]],
    at: dict[str, float] | None = None,
    dtype: type = np.float64,
    same: Mapping[int, tuple[np.ndarray, np.ndarray]] | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3, P) accelerations and (N, 8, P) readings for one unit of each unknown, about the model (or `at`
    label -> value). `same`: columns that are known already, (N, 3) and (N, 8) by their places."""
    kept = KeptForces()
    s, acceleration = sailing(track, model, kept)
    late_s, prompt = model.prompt()
    reading = readings(s, prompt)
    A: np.ndarray = np.zeros((len(track), 3, len(unknowns)), dtype)
    R: np.ndarray = np.zeros((len(track), 8, len(unknowns)), dtype)
    missing, owners = track.missing(), {u.owner for u in unknowns}
    missed = rough.accelerations(track, model) if ROUGH in owners else {}
    formed = form.accelerations(track, model) if FORM in owners else {}
    in_waves = wave_induced.columns(track, model) if SEA in owners else {}
    for j, unknown in enumerate(unknowns):
        if same and j in same:
            A[:, :, j], R[:, :, j] = same[j]
            continue
        if unknown.owner == ROUGH:
            A[:, :, j] = missed[unknown.name]
            continue
        if unknown.owner == LATE:
            late = LATENESS[unknown.name]
            R[:, late, j] = -np.gradient(reading[:, late], track.h, axis=0)
            continue
        if unknown.owner == FORM:
            A[:, :, j] = formed[unknown.name]
            continue
        if unknown.owner == SEA:
            A[:, :, j], R[:, :, j] = in_waves[unknown.name]
            continue
        if unknown.owner != "core" and missing.intersection(catalogue[unknown.owner].needs):
            continue  # without its input the effect does nothing on this track
        if not unknown.acts_on(track):
            continue
        here = (at or {}).get(unknown.label)
        fault = unknown.owner != "core" and catalogue[unknown.owner].kind == "SensorFault"
        step = _step(unknown, here, fault)
        other = changed(model, unknown, (unknown.centre if here is None else here) + step, catalogue)
        if fault:  # it changes what is read, and not how the ship moves
            later_s, shown = other.prompt()
            R[:, :, j] = (readings(s, shown) - reading) / step
            if later_s != late_s:
                R[:, :, j] += (later_s - late_s) / step * by_lateness(track, reading, unknown.sd)
            continue
        if unknown.owner == "core" and not model.faults:  # a right instrument shows nothing of it
            A[:, :, j] = (accelerations(track, other, kept) - acceleration) / step
            continue
        a, r = respond(track, other.prompt()[1], kept)
        A[:, :, j], R[:, :, j] = (a - acceleration) / step, (r - reading) / step
    return A, R


def turns(
    track: Track,
    model: Model,
    unknowns: Sequence[Unknown],
    catalogue: dict[str, type[Effect]],
    at: dict[str, float] | None = None,
) -> dict[int, np.ndarray]:
    """Of each number of a fault that the model's instruments have (its column): (N, 8, 8) what one unit of it
    changes of the readings per unit of what they show beside the smooth motion. That motion holds a little of
    the instruments' noise: alone it would tell a fault wrongly that turns, scales or delays what they show.
    (Of one they do not have yet: what they show beside it may be that fault's own doing. Of how late they
    are: `by_lateness` evens that noise out, and what they show of a moment is no slope of it.)"""
    present = {type(fault).__name__ for fault in model.faults}
    if not present.intersection(u.owner for u in unknowns):
        return {}
    right, out = moving(track, model), {}
    shown = faulty(right, model)
    undo = np.linalg.inv(shown)
    for j, unknown in ((j, u) for j, u in enumerate(unknowns) if u.owner in present):
        here = (at or {}).get(unknown.label)
        step = _step(unknown, here, True)
        other = changed(model, unknown, (unknown.centre if here is None else here) + step, catalogue)
        if other.prompt()[0] != model.prompt()[0]:
            continue
        out[j] = ((faulty(right, other) - shown) @ undo / step).astype(np.float32)
    return out


def beside(
    track: Track,
    model: Model,
    unknown: Unknown,
    catalogue: dict[str, type[Effect]],
    at: dict[str, float] | None = None,
) -> tuple[Model, float] | None:
    """The model with a little more of a number, and how much more; None if that moves nothing on this
    track."""
    if unknown.owner in NO_MODEL or not unknown.acts_on(track):
        return None
    if unknown.owner != "core" and (
        catalogue[unknown.owner].kind == "SensorFault"
        or track.missing().intersection(catalogue[unknown.owner].needs)
    ):
        return None
    here = (at or {}).get(unknown.label, unknown.centre)
    step = 0.1 * unknown.sd if here + 0.1 * unknown.sd <= unknown.hi else -0.1 * unknown.sd
    return changed(model, unknown, here + step, catalogue), step


def _step(unknown: Unknown, here: float | None, fine: bool) -> float:
    """A plausible step that stays in the box: a whole prior width from the number's centre (null, or where a
    fit centred it anew, as the core), a tenth of one about a value found off it, and where the instruments
    are so `fine` that what is not linear shows: their own faults."""
    size = unknown.sd if here in (None, unknown.centre) and not fine else 0.1 * unknown.sd
    start = unknown.centre if here is None else here
    return size if start + size <= unknown.hi else -size


def changed(model: Model, unknown: Unknown, value: float, catalogue: dict[str, type[Effect]]) -> Model:
    """The model with one number changed; an effect that is not in it yet is put in at null first."""
    if unknown.owner in NO_MODEL:
        return model
    if unknown.owner == "core":
        return Model(model.ship.with_derivatives(**dict.fromkeys(unknown.names, value)), model.effects)
    of = {type(e).__name__: e for e in model.effects}
    owners = (unknown.owner, *unknown.also)
    effects = (of.get(name) or catalogue[name].absent(model.ship) for name in owners)
    return model.but(*(e.but(**unknown.of_effect(value)) for e in effects))


def with_values(
    model: Model, unknowns: Sequence[Unknown], values: Sequence[float], catalogue: dict[str, type[Effect]]
) -> Model:
    """The model with all these numbers put in, each kept inside its box."""
    for unknown, value in zip(unknowns, values, strict=True):
        model = changed(model, unknown, float(np.clip(value, unknown.lo, unknown.hi)), catalogue)
    return model

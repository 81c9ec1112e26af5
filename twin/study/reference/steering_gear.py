"""Whether what was recorded of the rudder, or of another actuator, is its order: then what lags behind the
order stands between it and the ship, and belongs to its model.

A rudder that is ordered at once arrives seconds later, and by then the ship has turned by less than the core
would have it; a thruster's turns follow its command likewise. Taken for what acts, the order bends every
derivative; a fault of rudder, thruster or gear can then not be told from the core's. So each of a few gears
is put between, and the reference voyages say how much more probable they are with it (the core's freedom
integrated out). Like actuators share one lag, unless the voyages clearly ask for one each."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from twin.physics.actuators import KINDS
from twin.physics.actuators.kinds import OF_WAKE
from twin.physics.effect import Effect, Lag
from twin.physics.effects import OfActuator, of_role, of_ship
from twin.physics.model import Model
from twin.physics.ship_like import ShipLike
from twin.study.estimation.columns import Unknown, with_values
from twin.study.estimation.fit import Catalogue, Fit, evidence, fit, present
from twin.study.estimation.in_order import likeliest_in_order
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import Linear, linearise
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.track.track import Track

# of the plausible gear's; the first is as fast as a large tanker's must be
SLOWER, LATER = (0.5, 1.0, 2.0, 4.0), (1.0, 2.0, 4.0)
# log evidence, tempered, that a gear must add: where the rudder itself was recorded it adds nothing at all
GEAR_LOG_BAYES = 20.0
MASSES = {"X_udot", "Y_vdot", "Y_rdot", "N_vdot", "N_rdot"}
RUDDER_READS = {"K_T0", "K_T1", *OF_WAKE}
Gears = tuple[type[Effect], ...]  # of like actuators


def gears_of(ship: ShipLike) -> tuple[Gears, ...]:
    """The lags that may stand between a ship's orders and what acts: its steering gear, or those of its
    actuators, like ones together."""
    if not ship.actuators:
        return ((of_role("gear"),),)
    alike: dict[object, list[type[Effect]]] = {}
    for effect in of_ship(ship).values():
        if issubclass(effect, OfActuator) and issubclass(effect, Lag) and len(effect.names) == 1:
            alike.setdefault(ship.actuator(effect.actuator).make, []).append(effect)
    return tuple(map(tuple, alike.values()))


def gear_unknowns(model: Model) -> tuple[Unknown, ...]:
    """The numbers of the gears that the model has, about no gear: of like actuators whose lags are the same,
    one for all; of a ship with one rudder its steering gear's, whichever lag it has."""
    out: list[Unknown] = []
    for gears in gears_of(model.ship) if model.lags else ():
        there = [e for e in model.lags if type(e) in gears]
        if len({tuple(e.values().values()) for e in there}) == 1 and len(there) == len(gears):
            out += _shared(gears, Model(model.ship))
        else:
            some = [g for g in gears if not model.ship.actuators or g in map(type, there)]
            out += [u for g in some for u in effect_unknowns(g, Model(model.ship))]
    return tuple(out)


def _shared(gears: Gears, model: Model) -> list[Unknown]:
    first, *others = gears
    also = tuple(g.__name__ for g in others)
    return [replace(u, also=also) for u in effect_unknowns(first, model)]


def with_or_without_gear(
    tracks: Sequence[Track], model: Model, unknowns: Sequence[Unknown], known: Catalogue, temper: float
) -> Fit:
    """The core's fit (and these other unknowns') with rudder or actuators as they were recorded or, if that
    makes the voyages clearly more probable, with a gear before them.

    The gear is looked for beside the core as it is at first and, if it is not found there, as it was fitted
    without one: a core that was fitted to an order has taken on a part of the gear, and the more so the
    slower that is."""

    def fitted(first: Model) -> Fit:
        return beside_its_gear(tracks, first, unknowns, known, temper)

    found = fitted(model)
    if not model.ship.actuators and model.lags:
        return found
    for gears in gears_of(model.ship):
        if _there(gears, found.model):
            continue
        for begun in (model.but(*found.model.lags), found.model):
            free = about(unknowns, begun)
            with_gear = _geared(begun, gears, tracks, free, known, temper)
            if with_gear is begun:
                with_gear = _apart(begun, gears, tracks, free, known, temper)
            if with_gear is begun or (better := fitted(with_gear)).cost >= found.cost - 2.0 * GEAR_LOG_BAYES:
                continue
            found, free = better, about(unknowns, better.model)
            own = _apart(found.model, gears, tracks, free, known, temper)
            if own is not found.model and (better := fitted(own)).cost < found.cost - 2.0 * GEAR_LOG_BAYES:
                found = better
            break
    return found


def beside_its_gear(
    tracks: Sequence[Track], model: Model, unknowns: Sequence[Unknown], known: Catalogue, temper: float
) -> Fit:
    """The core's fit (and these other unknowns') with the gears that the model has."""
    every = (*unknowns, *gear_unknowns(model))
    return fit(tracks, model, every, known, NoiseModel(), temper=temper, smooth=True)


def geared(
    model: Model, tracks: Sequence[Track], unknowns: Sequence[Unknown], known: Catalogue, temper: float
) -> Model:
    """The model with the most probable gears, if the voyages clearly ask for them; a gear that is there
    already stays."""
    if not model.ship.actuators and model.lags:
        return model
    for gears in gears_of(model.ship):
        if not _there(gears, model):
            model = _geared(model, gears, tracks, unknowns, known, temper)
    return model


def _there(gears: Gears, model: Model) -> bool:
    whose = {name for g in gears for name in _late(g)}
    return any(type(e) in gears or whose & {*_late(type(e))} for e in model.lags)


def _late(gear: type[Effect]) -> tuple[str, ...]:
    """The actuators that answer late by it; none of a steering gear."""
    return gear.names if issubclass(gear, OfActuator) else ()


def _geared(
    model: Model,
    gears: Gears,
    tracks: Sequence[Track],
    unknowns: Sequence[Unknown],
    known: Catalogue,
    temper: float,
) -> Model:
    """The model with the most probable of a few lags, the same for all these actuators, or as it is."""
    sd = np.array([u.sd for u in unknowns])

    def with_gear(later: float, slower: float) -> Model:
        return model.but(*(_times(gear.plausible(model.ship), later, slower) for gear in gears))

    same = not_behind(gears, unknowns, model.ship)
    first = [linearise(t, model.without_inputs(t.missing())[0], unknowns, known) for t in tracks]
    none = evidence(innovate(first, [NoiseModel()])[0], sd) / temper
    first = [line.only(np.array(same, int)) for line in first]

    def lines_of(later: float, slower: float) -> list[Linear]:
        other = with_gear(later, slower)
        free = about(unknowns, other)
        return [
            linearise(t, other.without_inputs(t.missing())[0], free, known, like=line, same=same)
            for t, line in zip(tracks, first, strict=True)
        ]

    def likely(later: float, slower: float) -> float:
        return evidence(innovate(lines_of(later, slower), [NoiseModel()])[0], sd) / temper

    score, slower = likeliest_in_order(lambda k: likely(0.0, k), (none, 0.0), SLOWER)
    score, later = likeliest_in_order(lambda k: likely(k, slower), (score, 0.0), LATER)
    return with_gear(later, slower) if score > none + GEAR_LOG_BAYES else model


def not_behind(gears: Gears, unknowns: Sequence[Unknown], ship: ShipLike) -> list[int]:
    """Places of the core's numbers that do the same whatever these gears do: those that neither change the
    mass, by which every force is divided, nor what the actuators behind the gears make of their orders."""
    behind = [ship.actuator(g.actuator) for g in gears if issubclass(g, OfActuator)]
    reads = {name for a in behind for name in KINDS[a.kind].reads} if behind else RUDDER_READS
    names, own = MASSES | reads, tuple(f"{a.name}." for a in behind)
    return [
        j
        for j, u in enumerate(unknowns)
        if u.owner == "core" and not any(n in names or n.startswith(own) for n in u.names)
    ]


def _times(gear: Effect, later: float, slower: float) -> Effect:
    """A gear with its dead time, and all its other times, so many times as long."""
    return gear.but(**{n: (later if n == "delay" else slower) * v for n, v in gear.values().items()})


def _apart(
    model: Model,
    gears: Gears,
    tracks: Sequence[Track],
    unknowns: Sequence[Unknown],
    known: Catalogue,
    temper: float,
) -> Model:
    """The model with a lag for each of these actuators, if the voyages clearly tell them apart from the one
    for all that it has, or from none; else as it is."""
    if len(gears) == 1:
        return model
    own = [u for g in gears for u in effect_unknowns(g, model)]
    every, first, size = (*unknowns, *own), len(unknowns), len(own) // len(gears)
    lines = [linearise(t, model.without_inputs(t.missing())[0], every, known) for t in tracks]
    normal, sd = innovate(lines, [NoiseModel()])[0], np.array([u.sd for u in every])
    alike = np.eye(len(every), first + size)
    if _there(gears, model):  # the same number of each is one
        alike[first:, first:] = np.tile(np.eye(size), (len(gears), 1))
    else:
        alike[first:] = 0.0
    together = evidence(normal.in_terms_of(alike), sd[: first + size])
    if evidence(normal, sd) <= together + GEAR_LOG_BAYES * temper:
        return model
    A, b, _ = normal.total()
    moved = np.linalg.solve(A / temper + np.diag(sd**-2.0), b / temper)[first:]
    return with_values(model, own, [u.centre + x for u, x in zip(own, moved, strict=True)], known)


def about(unknowns: Sequence[Unknown], model: Model) -> list[Unknown]:
    """The same numbers, centred where the model has them: a column is about its number's centre."""
    return [replace(u, centre=present(model, u)) for u in unknowns]

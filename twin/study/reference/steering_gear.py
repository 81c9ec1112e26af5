"""Whether what was recorded as the rudder is its order: then the steering gear stands between it and the
ship, and belongs to its model.

A rudder that is ordered at once arrives seconds later, and by then the ship has turned by less than the core
would have it. Taken for the rudder, the order bends every derivative of sway and yaw; a fault of rudder or
gear can then not be told from the core's. So each of a few gears is put between, and the reference voyages
say how much more probable they are with it (the core's freedom integrated out)."""

from collections.abc import Sequence

import numpy as np

from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.study.estimation.columns import Unknown, effect_unknowns
from twin.study.estimation.fit import Catalogue, Fit, evidence, fit
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import linearise
from twin.study.track.track import Track

# L/U_0; the first is as fast as a large tanker's must be
TRAVEL, DELAY = (0.35, 0.7, 1.4, 2.8), (0.05, 0.1, 0.2)
# log evidence, tempered, that a gear must add: where the rudder itself was recorded it adds nothing at all
GEAR_LOG_BAYES = 20.0


def gear_unknowns(model: Model) -> tuple[Unknown, ...]:
    """The gear's numbers, about no gear."""
    return tuple(effect_unknowns(of_role("gear"), Model(model.ship)))


def with_or_without_gear(
    tracks: Sequence[Track], model: Model, unknowns: Sequence[Unknown], known: Catalogue, temper: float
) -> Fit:
    """The core's fit (and these other unknowns') with the rudder as it was recorded or, if that makes the
    voyages clearly more probable, with a steering gear before it. The gear is looked for beside the core as
    it is at first and, if it is not found there, as it was fitted without
    one: a core that was fitted to an order has taken on a part of the gear, and the more so the slower that
        is."""

    def fitted(about: Model) -> Fit:
        return fit(
            tracks,
            about,
            (*unknowns, *(gear_unknowns(about) if about.lags and not about.ship.actuators else ())),
            known,
            NoiseModel(),
            temper=temper,
            smooth=True,
        )

    without = fitted(model)
    if model.lags or model.ship.actuators:
        return without
    for begun in (model, without.model):
        if (with_gear := geared(begun, tracks, unknowns, known, temper)).lags and (
            found := fitted(with_gear)
        ).cost < without.cost - 2.0 * GEAR_LOG_BAYES:
            return found
    return without


def geared(
    model: Model, tracks: Sequence[Track], unknowns: Sequence[Unknown], known: Catalogue, temper: float
) -> Model:
    """The model with the most probable steering gear, if the voyages clearly ask for one; a gear that is
    there already stays."""
    if model.lags or model.ship.actuators:
        return model
    sd, time = np.array([u.sd for u in unknowns]), float(model.ship.scale("time"))

    none_yet = of_role("gear").absent(model.ship)

    def with_gear(delay: float, travel: float) -> Model:
        return model.but(none_yet.but(delay=delay * time, travel_time=travel * time))

    def probable(m: Model) -> float:
        lines = [linearise(t, m.without_inputs(t.missing())[0], unknowns, known) for t in tracks]
        return evidence(innovate(lines, [NoiseModel()])[0], sd) / temper

    none = (probable(model), 0.0, 0.0)
    _, _, travel = slow = max(none, *((probable(with_gear(0.0, k)), 0.0, k) for k in TRAVEL))
    score, delay, travel = max(slow, *((probable(with_gear(k, travel)), k, travel) for k in DELAY))
    return with_gear(delay, travel) if score > none[0] + GEAR_LOG_BAYES else model

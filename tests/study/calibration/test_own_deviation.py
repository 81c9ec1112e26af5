"""A compass that deviates with the heading and turns the speed over ground with it: the core's fit asks for its
curve, and neither a healthy boat nor one in a stream does."""

from dataclasses import replace

import numpy as np
import pytest

from bench.small_boats import sailed, ship_of
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.study.calibration.own_deviation import own_deviation
from twin.study.calibration.ways import COMPASS, best_way
from twin.study.estimation.columns import core_unknowns, with_values
from twin.study.estimation.fit import Fit, fit, present
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.linear import linearise
from twin.study.reference.nuisance import TEMPER, instruments
from twin.study.reference.steering_gear import gear_unknowns, gears_of
from twin.study.track.track import track

BOAT, SECONDS = "screws and bow thruster", 120.0
HEADING, U, V = "heading_true_north_deg", "surge_velocity_mps", "sway_velocity_mps"


def deviating(voyage, C):
    """As a compass shows it that is C cos(psi) [rad] off, and turns speed over ground."""
    e = C * np.cos(np.radians(voyage[HEADING]))
    over_ground = (voyage[U] + 1j * voyage[V]) * np.exp(-1j * e)
    shown = {HEADING: voyage[HEADING] + np.degrees(e), U: over_ground.real, V: over_ground.imag}
    return replace(voyage, columns=dict(voyage.columns) | shown)


def carried(voyage, north):
    """In a stream toward north [m/s]."""
    psi, t = np.radians(voyage[HEADING]), voyage.time_s - voyage.time_s[0]
    shown = {
        "north_m": voyage["north_m"] + north * t,
        U: voyage[U] + north * np.cos(psi),
        V: voyage[V] - north * np.sin(psi),
    }
    return replace(voyage, columns=dict(voyage.columns) | shown)


@pytest.mark.parametrize(
    ("changed", "asked"),
    [
        (lambda v: v, ()),
        (lambda v: carried(v, 0.15), ()),
        (lambda v: deviating(v, 0.12), ("B", "C")),
    ],
    ids=["healthy", "stream", "deviation"],
)
def test_only_a_deviation_is_asked_for(changed, asked):
    ship = ship_of(BOAT)
    model, known = Model.of(ship), of_ship(ship)
    tracks = [track(changed(sailed(BOAT, seed, SECONDS, 3)), ship) for seed in (1, 2)]
    found = fit(tracks, model, core_unknowns(model), known, NoiseModel(), temper=TEMPER, smooth=True)
    assert tuple(u.name for u in own_deviation(tracks, found, known, TEMPER)) == asked


def test_a_curve_that_no_prediction_asks_for_leaves_nothing_in_the_ship_file():
    curve = COMPASS(B=0.4)
    noted = {
        "effects": {COMPASS.__name__: {"B": {"value": 0.4}}},
        "structural": {"beside_effects": [COMPASS.__name__]},
    }
    ship = replace(ship_of(BOAT).with_effects(curve), notes=noted)
    held_out = [(track(sailed(BOAT, 3, 60.0, 3), ship), 0)]
    best = best_way(ship, [], [], held_out, by="steps", found_curve=True, progress=lambda text: None)
    assert best.way == "steps" and not best.ship.effects
    assert best.ship.notes == {"effects": {}, "structural": {"beside_effects": []}}
    kept = best_way(ship, [], [], held_out, by="steps", found_curve=False, progress=lambda text: None)
    assert kept.ship is ship


def test_a_curve_is_asked_for_about_the_model_that_was_found(monkeypatch):
    """Test: a fit whose lags and instruments were found off their priors' centres. Expected: every number stands
    where the model has it."""
    ship, off = ship_of(BOAT), []
    known, model = of_ship(ship), Model.of(ship)
    faults = [u for u in instruments(model, known) if u.owner == "HeadingBias"]
    lags = gear_unknowns(model.but(*(e.plausible(ship) for e in gears_of(ship)[0])))
    every = (*core_unknowns(model), *faults, *lags)
    tracks = [track(sailed(BOAT, 1, 60.0, 3), ship)]
    there = with_values(model, every, [u.centre + 0.5 * u.sd for u in every], known)
    found = Fit(there, every, np.empty(0), np.empty((0, 0)), (), None, 0.0)

    def noted(t, model, unknowns, known):
        off.extend(u.label for u in unknowns if u.centre != present(model, u))
        return linearise(t, model, unknowns, known)

    monkeypatch.setattr("twin.study.calibration.own_deviation.linearise", noted)
    own_deviation(tracks, found, known, TEMPER)
    assert faults and lags and off == []

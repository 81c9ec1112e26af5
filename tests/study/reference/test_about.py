"""What one unit of a number does is asked about the place where the model has it."""

import numpy as np
import pytest

from tests.study.conftest import sail, ship
from twin.physics.effects import find, of_ship
from twin.physics.model import Model
from twin.study.estimation.columns import Unknown, changed, columns, core_unknowns, with_values
from twin.study.estimation.fit import present
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.estimation.respond import respond
from twin.study.reference import steering_gear
from twin.study.reference.nuisance import TEMPER
from twin.study.reference.steering_gear import about, with_or_without_gear
from twin.study.track.track import track

OWNERS = ("SteeringLag", "SpeedLogScale", "Wind")
SEED = 2  # of a voyage on which the rudder is put from one side to the other


def unknowns() -> list[Unknown]:
    """Of the core, of a gear, of an instrument and of the weather, about a ship that has none of them."""
    none = Model.of(ship())
    core = [u for u in core_unknowns(none) if u.name in ("Y_ur", "N_rr", "gamma_r")]
    return [*core, *(u for owner in OWNERS for u in effect_unknowns(find(owner), none))]


@pytest.fixture(scope="module")
def windy():
    return track(sail(seed=SEED, seconds=400.0, wind=9.0), ship())


@pytest.mark.parametrize("unknown", unknowns(), ids=lambda u: u.label)
def test_about_a_model_that_moved_a_column_is_what_one_unit_does_there(windy, unknown):
    """Test: a number found three quarters of its prior's width off. Expected: the column is the secant from that
    place on, over a prior's width, of a fault over a tenth of one."""
    known, value = of_ship(ship()), unknown.centre + 0.75 * unknown.sd
    there = with_values(Model.of(ship()), [unknown], [value], known)
    A, R = columns(windy, there, about([unknown], there), known)
    step = (0.1 if unknown.owner == "SpeedLogScale" else 1.0) * unknown.sd
    here, other = (respond(windy, changed(there, unknown, value + k * step, known)) for k in (0.0, 1.0))
    assert np.abs(A).max() + np.abs(R).max() > 0.0
    for column, before, after in zip((A, R), here, other, strict=True):
        np.testing.assert_allclose(column[..., 0], (after - before) / step, rtol=1e-6, atol=1e-12)


def test_a_gear_is_looked_for_about_the_model_beside_which_it_is_tried(windy, monkeypatch):
    """Test: two voyages whose rudder was recorded itself. Expected: also where a gear is tried beside the core as
    it was fitted every number stands where that model has it."""
    off, places = [], set()

    def noted(t, model, every, *rest, **options):
        off.extend(u.label for u in every if u.centre != present(model, u))
        places.add(float(model.ship.derivative("N_rr")))
        return made(t, model, every, *rest, **options)

    made = steering_gear.linearise
    monkeypatch.setattr(steering_gear, "linearise", noted)
    few = [u for u in unknowns() if u.owner in ("core", "SpeedLogScale")]
    found = with_or_without_gear([windy], Model.of(ship()), few, of_ship(ship()), TEMPER)
    assert not found.model.lags and len(places) == 2 and off == []

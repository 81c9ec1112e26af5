"""The last fit, of every voyage, chooses nothing by voyages that it is fitted to: what was chosen before stays."""

from dataclasses import replace

import pytest

from bench.real.planted_faults import antenna_elsewhere
from bench.small_boats import sailed, ship_of
from tests.study.calibration.test_own_deviation import BOAT
from tests.thorough import thorough
from twin.physics.effects import find
from twin.study.calibration import ways
from twin.study.calibration.core_fit import fitted_core
from twin.study.calibration.held_out import HeldOutErrors
from twin.study.calibration.ways import COMPASS, best_way, deviates
from twin.study.reference.sailed import sailed as tracked

AHEAD_M, SECONDS = 1.5, 60.0
ANTENNA = find("AntennaOffset")


@pytest.mark.parametrize("better", [True, False], ids=["better with it", "better without"])
def test_a_curve_stays_chosen_or_dropped_whatever_a_voyage_says_that_is_fitted(better, monkeypatch):
    """Expected: asked, the ship that predicts better; where the other was chosen before, the other."""
    name = COMPASS.__name__
    noted = {"effects": {name: {}}, "structural": {"beside_effects": [name]}}
    bare = ship_of(BOAT)
    ship = replace(bare.with_effects(COMPASS(C=0.12)), notes=noted)

    def errors(model, _):
        off_m = 1.0 if any(isinstance(e, COMPASS) for e in model.effects) == better else 2.0
        return HeldOutErrors([{"windows": 1, "position_m": off_m, "heading_deg": off_m}], [])

    def best(like):
        asked = {"by": "steps", "found_curve": True, "progress": lambda text: None, "like": like}
        return best_way(ship, [], [], [], **asked)

    monkeypatch.setattr(ways, "errors", errors)
    first, other = best(None), bare if better else ship
    assert deviates(first.ship) is better
    assert deviates(best(first).ship) is better
    assert deviates(best(first._replace(ship=other)).ship) is not better


@pytest.fixture(scope="module")
def first():
    """A boat whose antenna stands elsewhere on two voyages and not on the one that is held out: it was found, and
    dropped; and the three voyages."""
    ship = ship_of(BOAT)
    voyages = [sailed(BOAT, seed, SECONDS, 3) for seed in (1, 2, 3)]
    *fitted, held = [tracked(antenna_elsewhere(v, AHEAD_M), ship) for v in voyages]
    sound = tracked(voyages[-1], ship)
    return fitted_core(fitted, [(sound.track, 0)], ship, by="steps"), [*fitted, held], ship


def has_antenna(found):
    return any(isinstance(e, ANTENNA) for e in found.chosen.ship.effects)


@thorough
def test_an_antenna_that_was_dropped_is_not_put_back_by_voyages_that_were_fitted(first):
    """Test: fitted once more, with all voyages, the third as the first two. Expected: found and not the ship's; by
    a fit of its own it is."""
    before, every, ship = first
    assert before.core.antenna is not None and not before.moved and not has_antenna(before)
    held = [(every[-1].track, 0)]
    again = fitted_core(every, held, ship, begun=before)
    assert again.core.antenna.ahead == pytest.approx(AHEAD_M, rel=0.3)
    assert not has_antenna(again) and again.chosen.way == "steps"
    kept = replace(before, chosen=before.chosen._replace(ship=ship.with_effects(before.core.antenna)))
    assert has_antenna(fitted_core(every, held, ship, begun=kept))

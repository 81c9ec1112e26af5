"""The next manoeuvre: each can be sailed by any ship, and the advised one excites what it should."""

import numpy as np
import pytest

from twin.physics.effects import find
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.manoeuvres import MANOEUVRES, next_manoeuvre, reason, sail


@pytest.fixture(scope="module")
def case(tanker, voyages):
    return assemble([voyages["straight"]], tanker)


@pytest.mark.parametrize("name", MANOEUVRES)
def test_the_ship_sails_every_manoeuvre(case, name):
    t = sail(case, case.model, MANOEUVRES[name][0])
    assert np.isfinite(t.state).all()
    assert t.state[:, 3].max() < 2.0 * float(case.model.ship.U_0)


@pytest.mark.parametrize("name", MANOEUVRES)
def test_a_model_that_runs_away_has_sailed_no_manoeuvre(case, name):
    """Test: a hull that pushes it on. Expected: a track that ends, and no advice that was made of it."""
    wild = case.model.but(find("TowForce").absent(case.model.ship).but(ahead=1e300))
    assert np.isnan(sail(case, wild, MANOEUVRES[name][0]).state[-1]).any()
    assert next_manoeuvre(case, wild, "HullFouling", "PropellerWear", np.ones(len(case.effects))) is None


def test_fouling_and_a_worn_propeller_are_told_apart_by_changing_speed(case):
    z = np.ones(len(case.effects))
    advice = next_manoeuvre(case, case.model, "HullFouling", "PropellerWear", z)
    assert advice is not None
    assert advice["separates"] == ["HullFouling", "PropellerWear"]
    assert "speed" in advice["manoeuvre"] or "circle" in advice["manoeuvre"]
    assert "to 1" in advice["why"]


def test_a_model_that_can_be_sailed_through_one_manoeuvre_alone_has_it_named_without_another():
    alone = reason({"zigzag 10/10": 3.0}, "zigzag 10/10")
    beside = reason({"zigzag 10/10": 3.0, "turning circles": 1.0}, "zigzag 10/10")
    assert "runs away" in alone and "next best" not in alone
    assert "next best: turning circles" in beside

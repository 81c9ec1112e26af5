"""How much a healthy ship's numbers differ between voyages, before its own voyages say so."""

import numpy as np
import pytest

from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.reference.between import BetweenVoyages, scattered
from twin.study.reference.nuisance import Known, usual_unknowns
from twin.study.reference.variation import USUAL_SHARES, usual_scatter


@pytest.fixture(scope="module")
def unknowns():
    ship = load("kvlcc2")
    return usual_unknowns(Model.of(ship), of_ship(ship))


def test_what_differs_is_met_on_a_ship_and_is_of_its_instruments(unknowns):
    assert {u.owner for u, v in zip(unknowns, usual_scatter(unknowns), strict=True) if v} == set(USUAL_SHARES)
    assert all(of_ship(load("kvlcc2"))[name].kind == "SensorFault" for name in USUAL_SHARES)


def test_the_next_voyage_is_never_known_better_than_healthy_voyages_differ(unknowns):
    """Test: two reference voyages that tell everything, and agree. Expected: of each number the variance foretold
    for the next voyage is what is usual, and half of it again, for the ship's own is known from two."""
    exact = BetweenVoyages(1e9 * np.eye(len(unknowns)), np.zeros(len(unknowns)), 0.0)
    usual, none = usual_scatter(unknowns), np.zeros(len(unknowns))
    known = Known(unknowns, (exact, exact), scattered((exact, exact), none, usual), usual, none)
    foretold = np.diag(np.linalg.inv(known.nuisance().information))
    of_ship_itself = np.array([v for v, u in zip(usual, unknowns, strict=True) if not u.every_day])
    np.testing.assert_allclose(foretold, 1.5 * of_ship_itself, rtol=0.05, atol=1e-8)
    assert known.between == {}

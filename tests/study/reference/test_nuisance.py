"""What two reference voyages establish of the next one."""

import numpy as np

from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.reference.between import BetweenVoyages, scattered
from twin.study.reference.nuisance import Known, usual_unknowns


def test_the_next_voyage_is_never_known_better_than_healthy_voyages_differ():
    """Test: two reference voyages that tell everything, and agree. Expected: of each number the variance foretold
    for the next voyage is what is usual, and half of it again, for the ship's own is known from two; of no number is
    it said that it differs."""
    ship = load("kvlcc2")
    unknowns = usual_unknowns(Model.of(ship), of_ship(ship))
    exact = BetweenVoyages(1e9 * np.eye(len(unknowns)), np.zeros(len(unknowns)), 0.0)
    usual, none = np.array([u.varies**2 for u in unknowns]), np.zeros(len(unknowns))
    known = Known(unknowns, (exact, exact), scattered((exact, exact), none, usual), usual, none)
    foretold = np.diag(np.linalg.inv(known.nuisance().information))
    lasting_ones = np.array([v for v, u in zip(usual, unknowns, strict=True) if not u.every_day])
    np.testing.assert_allclose(foretold, 1.5 * lasting_ones, rtol=0.05, atol=1e-8)
    assert known.between == {}
    assert {u.owner for u in unknowns if u.varies} == {"HeadingBias", "SpeedLogMisalignment"}

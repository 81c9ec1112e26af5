"""What differs between voyages is learned as it was drawn."""

import numpy as np

from bench.fleet.variation_fit import OneShip, learned
from twin.study.reference.between import BetweenVoyages

KINDS = ("yaw moment of turning", "sway and yaw")
DRAWN = {"yaw moment of turning": 0.3, "sway and yaw": 0.0}
TOLD = 100.0  # what a voyage tells of each number, in priors


def random_ships(count, rng):
    """Ships of two numbers, the first of which differs between voyages: three references and six healthy ones."""
    for _ in range(count):
        own, said = rng.standard_normal(2), []
        for _ in range(9):
            there = own + [DRAWN[k] for k in KINDS] * rng.standard_normal(2)
            read = there + rng.standard_normal(2) / np.sqrt(TOLD)
            said.append(BetweenVoyages(TOLD * np.eye(2), TOLD * read, TOLD * float(read @ read)))
        yield OneShip("", KINDS, np.zeros(2), np.zeros(2), tuple(said[:3]), tuple(said[3:]))


def test_the_shares_that_ships_were_drawn_with_are_learned():
    shares = learned(list(random_ships(20, np.random.default_rng(5))))
    assert 0.2 <= shares["yaw moment of turning"] <= 0.4
    assert shares["sway and yaw"] <= 0.03
    assert all(not v for k, v in shares.items() if k not in KINDS)  # nothing speaks of these

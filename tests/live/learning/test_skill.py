"""The gate of what was learned: it opens by what came true, of all rows together."""

import random
from math import sin

import pytest

from twin.live.learning.skill import Proof

H = 0.1  # L/U_0 between two words of a row


def after(wanted, steps=400, spread=(0.01, 0.01, 0.01), seed=1):
    """The gate after every row was promised sin and got wanted(row, promised, dice)."""
    proof, dice = Proof(), random.Random(seed)
    for k in range(steps):
        promised = 0.3 * sin(0.2 * k)
        for r in range(3):
            proof.weigh(r, wanted(r, promised, dice), promised, spread[r], H)
    return proof.gate


def test_what_came_true_acts_whole_and_what_came_out_the_other_way_not_at_all():
    assert after(lambda r, p, dice: p + dice.gauss(0.0, 0.1)) == 1.0
    assert after(lambda r, p, dice: -p + dice.gauss(0.0, 0.1)) == 0.0


@pytest.mark.parametrize("seed", range(5))
def test_of_noise_nothing_comes_true(seed):
    assert after(lambda r, p, dice: dice.gauss(0.0, 0.1), seed=seed) < 0.1


def test_a_row_in_a_heavy_sea_is_vouched_for_by_the_others():
    """Test: the third row's noise is five times what it was promised, as in a sea way. Expected: the two
    others open the gate."""
    assert (
        after(lambda r, p, dice: p + dice.gauss(0.0, 1.5 if r == 2 else 0.1), spread=(0.01, 0.01, 2.25)) > 0.9
    )


def test_promises_of_nothing_open_nothing():
    proof = Proof()
    for _ in range(100):
        proof.weigh(0, 0.3, 0.0, 0.01, H)
    assert proof.gate == 0.0

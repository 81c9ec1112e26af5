"""Laws of adaptation: each finds what is planted, and none is led astray by lies."""

from math import sin

import numpy as np
import pytest

from bench import adaptation_laws as laws
from bench.adaptation import LIES
from twin.live.adapt import A_MAX, SIZES, Adaptation
from twin.live.learned import scale_of
from twin.physics.ship import load

ALL = (laws.Gradient, laws.EModified, laws.DeadZone, laws.Recursive, laws.Kalman, Adaptation)
STEPS, DT = 1200, 1.25


@pytest.fixture(scope="module")
def ship():
    return load("kvlcc2")


def stream(planted, seed=1, noise=0.02):
    """What a law is told: each row's first known force is off by `planted`."""
    rng, out = np.random.default_rng(seed), []
    for k in range(STEPS):
        t = k * DT
        q = [sin(t / 40.0), sin(t / 27.0 + 1.0), *(0.5 * sin(t / (35.0 + 7 * i) + i) for i in range(3 * SIZES))]
        out.append((tuple(planted * q[2 + SIZES * r] + noise * rng.standard_normal() for r in range(3)), q, DT, ""))
    return out


def taught(law, ship, told):
    made = law(ship, scale_of(ship), 2)
    for step in told:
        made.learn(*step)
        assert made.norm() <= A_MAX + 1e-9
    return made


@pytest.mark.parametrize("law", ALL)
def test_every_law_comes_nearer_to_what_is_planted(law, ship):
    """Expected: with what was learned, what it is told later is explained better than by nothing."""
    made, later = taught(law, ship, stream(0.2)), stream(0.2, seed=2)[-400:]
    left = [np.subtract(wanted, made.correction(q)) for wanted, q, _, _ in later]
    assert np.square(left).mean() < 0.9 * np.square([wanted for wanted, *_ in later]).mean()


@pytest.mark.parametrize("lie", LIES)
@pytest.mark.parametrize("law", ALL)
def test_no_lie_makes_a_law_diverge(law, lie, ship):
    """Test: noise, outliers, drop-outs, an adversary, stuck readings. Expected: finite, inside the ball at every step."""
    made = taught(law, ship, LIES[lie]([stream(0.1)])[0])
    assert np.isfinite(made.numbers()).all()


def test_drop_outs_freeze_and_the_rest_still_teaches(ship):
    told = LIES["drop-outs"]([stream(0.2)])[0]
    made = taught(Adaptation, ship, told)
    assert 0 < made.updates < STEPS and made.numbers()[1][2] == pytest.approx(0.2, abs=0.05)

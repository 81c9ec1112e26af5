"""A channel's noise beside its own usual."""

import math
import random
from itertools import pairwise

import pytest

from twin.live.gates.noise import Noise

STEP_S = 0.1


def heard(values, floor=0.5):
    """The watch after these values, and at which of them it was loud."""
    noise, loud = Noise(floor), []
    for k, (before, value) in enumerate(pairwise(values)):
        noise.feed(value - before, STEP_S)
        loud += [k] * noise.loud
    return noise, loud


def noisy(seed, seconds, sigma, motion=lambda t: 0.0):
    chance = random.Random(seed)
    return [motion(k * STEP_S) + chance.gauss(0.0, sigma(k * STEP_S)) for k in range(round(seconds / STEP_S))]


@pytest.mark.parametrize("seed", range(5))
def test_ten_times_the_noise_is_heard_within_five_seconds_and_forgotten_when_it_is_gone(seed):
    values = noisy(seed, 200.0, lambda t: 0.5 if 100.0 <= t < 130.0 else 0.05)
    noise, loud = heard(values)
    assert 1000 <= loud[0] <= 1050 and loud[-1] < 1300 + 100 and not noise.loud
    assert len(loud) > 250


@pytest.mark.parametrize("seed", range(5))
def test_an_hour_of_the_same_noise_is_never_loud(seed):
    assert not heard(noisy(seed, 3600.0, lambda t: 0.05))[1]


@pytest.mark.parametrize("grow", (1.0, 10.0))
def test_waves_that_grow_are_no_noise(grow):
    """A boat leaves the lee of the harbour: what it does is ten times as much, and smooth."""

    def motion(t):
        return (grow if t > 100.0 else 0.1) * math.sin(3.0 * t)

    assert not heard(noisy(1, 300.0, lambda t: 0.01, motion), floor=0.2)[1]


def test_a_spike_alone_is_no_noise():
    values = noisy(1, 200.0, lambda t: 0.05)
    values[1500] += 5.0
    assert not heard(values)[1]


def test_the_steps_of_a_coarse_instrument_are_no_noise():
    """A compass in whole tenths: still for minutes, then turning."""
    values = [round(max(0.0, k - 1500) * 0.037, 1) for k in range(3000)]
    assert not heard(values, floor=3.0)[1]


def test_what_is_loud_weighs_as_its_variance():
    noise, _ = heard(noisy(3, 130.0, lambda t: 0.5 if t >= 100.0 else 0.05))
    assert noise.loud and 0.003 < noise.weight < 0.05


def test_a_hole_in_the_record_is_no_noise():
    noise = Noise(0.5)
    for k in range(500):
        noise.feed(0.01 * (-1) ** k, STEP_S)
        if k % 50 == 49:
            noise.feed(80.0, 20.0)
    assert not noise.loud


@pytest.mark.parametrize("receiver", (0.02, 0.3))
def test_a_motion_that_another_instrument_sees_too_is_no_noise_and_noise_beside_it_is(receiver):
    """Test: a log's noise of 0.05 m/s; from 200 s on the ship moves to and fro between its samples by 0.25 m/s, and from
    400 s on the log has a noise of 1.5 m/s besides. The receiver has its own noise. Expected: loud from then on only,
    and within 25 s; without the receiver from the motion on."""
    chance, alone, beside, heard_alone, heard_beside, last = (
        random.Random(2),
        Noise(0.5),
        Noise(0.5),
        [],
        [],
        None,
    )
    for k in range(1400):
        t = 0.5 * k
        motion = 0.25 * math.sin(2.6 * k) * (t >= 200.0)
        value = motion + chance.gauss(0.0, 1.5 if t >= 400.0 else 0.05)
        if last is not None:
            alone.feed(value - last, 0.5)
            beside.feed(value - last, 0.5, motion + chance.gauss(0.0, receiver))
        last = value
        heard_alone += [t] * alone.loud
        heard_beside += [t] * beside.loud
    assert heard_alone[0] < 210.0
    assert 400.0 <= heard_beside[0] < 425.0 and len(heard_beside) > 60


def test_the_part_of_the_sea_is_the_covariance_with_what_sees_it_too_and_is_never_added():
    """By hand: changes 1, -1, 1, -1 at even steps make d = 1, -1, 1; those beside it half of that: b = 0.5, -0.5, 0.5.
    Then -d d' = 1 and -(d b' + b d')/2 = 0.5 at each; the other way round -0.5, which takes nothing off."""
    for sign, own in ((1.0, 0.5), (-1.0, 1.0)):
        noise, beside = Noise(0.5), 0.0
        for k in range(8):
            change = (-1.0) ** k
            beside += 0.5 * sign * change
            noise.feed(change, 1.0, beside)
        assert noise._now == pytest.approx(1.0) and noise._sea == pytest.approx(0.5 * sign)
        assert noise._own() == pytest.approx(own)

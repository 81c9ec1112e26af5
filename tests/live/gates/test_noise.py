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

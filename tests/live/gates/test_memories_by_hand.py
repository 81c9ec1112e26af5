"""What a gate remembers of frozen and noisy instruments, against a second writing of both."""

import random
from math import inf, isclose
from types import SimpleNamespace

import pytest

from twin.live.gates.frozen import Frozen
from twin.live.gates.noise import Noise, NoiseWatch


class FrozenAgain:
    """The memory of frozen.py once more."""

    def __init__(self, least):
        self.least, self.last, self.t = least, None, 0.0
        self.grain, self.change, self.repeating = inf, 0.0, 0.0
        self.run, self.since, self.moved, self.noisy = 0, 0.0, 0.0, False

    def stuck(self, value, t, rate):
        change = 0.0 if self.last is None else abs(value - self.last)
        dt = min(5.0, t - self.t)
        self.last, self.t = value, t
        if change or not self.change:
            self.repeating = 0.99 * self.repeating + 0.01 * bool(self.run)
            self.run, self.moved = 0, 0.0
            if change:
                self.grain = min(self.grain, change)
            self.change = 0.8 * self.change + 0.2 * change
            return False
        if not self.run:
            self.since, self.noisy = t - dt, self.change > 20.0 * self.grain and self.repeating < 0.05
        self.run, self.moved = self.run + 1, self.moved + rate * dt
        long = self.run >= 4 and t - self.since >= 4.0
        return long and (self.noisy or abs(self.moved) > max(5.0 * self.grain, self.least))


@pytest.mark.parametrize("least", (inf, 0.3, 5.0))
@pytest.mark.parametrize("grain", (1e-6, 0.1))
def test_a_frozen_instrument_by_the_second_writing(least, grain):
    """Test: noise in grains with runs of repeats, slow and fast ships, holes in time. Expected: the same verdict
    at each of 3000 samples, both kinds of them."""
    dice, t, value, verdicts = random.Random(5), 100.0, 0.0, set()
    one, other = Frozen(least=least), FrozenAgain(least)
    left = 0
    for k in range(3000):
        t += dice.choice((0.1, 0.5, 1.0, 7.0)) if k % 3 == 0 else 0.5
        left = left - 1 if left else (dice.randrange(2, 30) if dice.random() < 0.02 else 0)
        if not left:
            value = round(dice.gauss(0.0, 1.0) / grain) * grain
        rate = dice.choice((0.0, 0.01, -1.0))
        verdict = one.stuck(value, t, rate)
        assert verdict is bool(other.stuck(value, t, rate)), k
        verdicts.add(verdict)
    assert verdicts == ({True, False} if grain < 0.01 or least < 1.0 else verdicts)
    assert Frozen().least == inf and Frozen().patience_s == 4.0


def test_a_heading_that_goes_through_north_is_no_leap():
    """Test: a compass of 0.1 deg turns slowly through north and then stands on its course for 12 s. Expected: the
    same verdicts as on any other course, and none of them frozen."""
    turned = [round(0.11 * k, 1) for k in range(120)]
    way = [*turned, *[turned[-1]] * 60]
    for start in (90.0, 350.0, -5.0):
        compass = Frozen(least=1.5, wraps=360.0)
        stuck = [compass.stuck(round((start + w) % 360.0, 1), 0.2 * k, 0.0) for k, w in enumerate(way)]
        assert not any(stuck), start


class NoiseAgain:
    """The memory of noise.py once more."""

    def __init__(self, allowance):
        self.least, self.grain, self.last, self.d = 0.01 * allowance, allowance, None, 0.0
        self.now = self.usual = 0.0
        self.n, self.loud, self.restless = 0, False, False

    @property
    def floor(self):
        return max(self.usual, max(self.least, self.grain) ** 2)

    def feed(self, change, dt):
        if change:
            self.grain = min(self.grain, abs(change))
        last, self.last = self.last, (change, dt)
        if last is None or not 0.2 < dt / last[1] < 5.0:
            self.d = 0.0
            return
        d = (last[0] * dt - change * last[1]) / (last[1] + dt)
        both, self.d = -d * self.d, d
        if not both:
            return
        self.n += 1
        known = self.n > 50
        seen = max(min(both, 64.0 * self.floor), -64.0 * self.floor) if known else both
        self.now += (seen - self.now) / min(self.n, 16)
        self.restless = known and self.now > 6.0 * self.floor
        self.loud = self.restless and (self.loud or self.now > 16.0 * self.floor)
        size = abs(seen) / 1.18
        self.usual += (0.1 if self.restless else 1.0) * (size - self.usual) / min(self.n, 600)


@pytest.mark.parametrize("allowance", (1.0, 30.0))
def test_the_noise_of_an_instrument_by_the_second_writing(allowance):
    """Expected: the same verdict and worth at each of 1500 samples; loud for a while, and quiet again."""
    dice, one, other, fates, value = random.Random(2), Noise(allowance), NoiseAgain(allowance), [], 0.0
    for k in range(1500):
        before, value = value, dice.gauss(0.0, 3.0 if 600 <= k < 800 else 0.4)
        change, dt = value - before, dice.choice((0.1, 0.1, 0.2, 0.5, 0.51, 0.02))
        change = 0.0 if k % 9 == 0 else 40.0 if k == 400 else change
        one.feed(change, dt)
        other.feed(change, dt)
        assert (one.loud, one.restless) == (other.loud, other.restless), k
        worth = min(other.floor / other.now, 1.0) if other.loud else 1.0
        assert isclose(one.weight, worth, rel_tol=1e-9), k
        fates.append(one.loud)
    assert not any(fates[:600]) and (any(fates[600:800]) or allowance > 1.0) and not fates[-1]


def test_a_loud_channel_is_believed_to_be_so_only_while_no_other_instrument_is_restless():
    watch = NoiseWatch(dict.fromkeys(
        ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps", "heading_true_north_deg", "yaw_rate_degps",
         "roll_deg", "surge_velocity_through_water_mps", "sway_velocity_through_water_mps"), 1.0))  # fmt: skip

    def fed(name, loud, restless):
        stand_in = SimpleNamespace(
            loud=loud, restless=restless, weight=0.25, feed=lambda change, dt, too: None
        )
        watch._of[name] = stand_in, watch._of[name][1]
        watch.feed(name, 0.0, 0.1)

    fed("north_m", True, True)
    assert watch.loud == {"north_m": 0.25}
    fed("heading_true_north_deg", False, True)
    fed("north_m", True, True)
    assert watch.loud == {}
    fed("heading_true_north_deg", False, False)
    fed("east_m", False, True)  # the same instrument
    fed("north_m", True, True)
    assert watch.loud == {"north_m": 0.25}
    fed("roll_deg", True, True)
    fed("north_m", True, True)
    assert watch.loud == {}  # the sea is restless, and roll itself is never called loud
    watch.lose("roll_deg")
    fed("north_m", True, True)
    assert watch.loud == {"north_m": 0.25}
    watch.lose("north_m")
    assert watch.loud == {} and "north_m" not in watch._restless
    watch.feed("water_depth_m", 1.0, 0.1)

"""Page's sequential test, block by block, against a second writing of its docstring."""

import random
from math import copysign, inf

import pytest

from twin.live.gates.cusum import Cusum


class Page:
    """Page's test once more, from its docstring."""

    def __init__(self, least, most):
        self.least, self.most, self.mean, self.size, self.n = least, most, 0.0, least / 1.25, 0
        self.up = self.down = 0.0
        self.alarm = False

    def feed(self, x, allowed):
        scale = max(1.25 * self.size, self.least)
        z = copysign(max(abs(x - self.mean) - allowed, 0.0), x - self.mean) / scale
        if self.n >= 12 and abs(z) > 25.0:
            self.up, self.down = (10.0, 0.0) if z > 0 else (0.0, 10.0)
            self.alarm = True
        elif self.n >= 12:
            step = max(min(z, 5.0), -5.0)
            self.up = min(max(0.0, self.up + step - 0.75), 10.0)
            self.down = min(max(0.0, self.down - step - 0.75), 10.0)
            self.alarm = max(self.up, self.down) >= (4.0 if self.alarm else 10.0)
        odd = self.n >= 12 and 0.0 < allowed < abs(x - self.mean)
        self.n += 1
        slow = odd or self.alarm or max(self.up, self.down) > 4.0
        share = 0.1 / 80.0 if slow else 1.0 / min(self.n, 80)
        off = max(min(x - self.mean, 3.0 * scale), -3.0 * scale)
        self.mean = max(min(self.mean + share * off, self.most), -self.most)
        self.size += share * (abs(off) - self.size)


@pytest.mark.parametrize(
    "least, most, allowed", ((0.1, inf, 0.0), (0.5, 0.2, 0.0), (0.1, inf, 0.3), (1e-3, 5.0, inf))
)
def test_the_sequential_test_is_pages_block_by_block(least, most, allowed):
    """Test: noise, a shift up and back, one down, single wild blocks, one beyond any noise. Expected: the same
    sums, mean, scale and alarm as the second writing, at each of 600 blocks; alarms come and go."""
    dice, one, other, alarms = random.Random(7), Cusum(least, most), Page(least, most), 0
    for k in range(600):
        x = dice.gauss(0.0, 0.2) + (0.9 if 150 <= k < 190 else 0.0) - (0.7 if 300 <= k < 330 else 0.0)
        x += {5: 3.0, 250: 4.0, 260: -4.0, 400: 90.0, 450: -90.0}.get(k, 0.0)
        free = allowed if k % 5 else 0.0
        before = one.alarm
        assert one.feed(x, free) is one.alarm
        other.feed(x, free)
        assert (one._up, one._down, one.mean) == pytest.approx((other.up, other.down, other.mean)), k
        assert one.scale == pytest.approx(max(1.25 * other.size, least)) and one.alarm is other.alarm, k
        assert one.calm is (other.up == other.down == 0.0)
        alarms += one.alarm and not before
    assert alarms >= 2
    assert one.usual(100.0) == pytest.approx(3.0 * one.scale) == -one.usual(-100.0) and one.usual(0.0) == 0.0


def test_a_seaway_in_which_the_loop_begins_is_learned_and_not_taken_for_a_shift():
    """Test: from the first block on a swell a hundred times the least scale, then a shift beyond any noise. Expected:
    no alarm in the swell, at once in the shift (found on a container ship in waves, whose fast blocks were in alarm
    from the sixth second, so that nothing more was learned)."""
    test, dice = Cusum(0.03), random.Random(3)
    assert not any(test.feed((-1.0) ** k * 3.0 + dice.gauss(0.0, 0.1)) for k in range(200))
    assert test.feed(30.0 * test.scale)

"""How fast a current changes, learned from its blocks, and what that does to the test of the speed log."""

import random

import pytest

from twin.live.gates.crosscheck import STREAM_S, Stream
from twin.live.gates.current_rate import BLOCKS_APART, CurrentRate
from twin.live.gates.cusum import ENOUGH
from twin.live.signals.measured import Measured

U_0, NOISE_MPS = 8.0, 0.02
SPREAD_MPS, LASTS_S = 0.12, 600.0  # of the eddies of TS-03


def eddies(seed, blocks, spread=SPREAD_MPS):
    """A current that wanders about its mean within ten minutes, block by block."""
    dice, keep = random.Random(seed), 1.0 - STREAM_S / LASTS_S
    kick, x = spread * (1.0 - keep * keep) ** 0.5, dice.gauss(0.0, spread)
    for _ in range(blocks):
        x = keep * x + dice.gauss(0.0, kick)
        yield x


def alarms(stream, currents, off=0.0):
    """Numbers of the blocks in which the test is in alarm; the log is off by `off`."""
    dice, told = random.Random(5), []
    for k, current in enumerate(currents):
        si = {"u": 7.0 + current, "v": 0.0, "u_r": 7.0 + dice.gauss(off, NOISE_MPS), "v_r": 0.0, "psi": 0.5}
        stream.feed(Measured(STREAM_S * k, si), STREAM_S)
        told += [k] * stream.alarm
    return told


def test_a_random_walk_is_told_from_noise_and_its_gain_is_that_of_the_local_level():
    """Test: 4000 blocks of white noise, then a walk of 0.05 m/s a block and component in the same noise. Expected:
    none and that variance; by hand for q = 0.0025, R = 0.0196: P = (q + sqrt(q^2 + 4 q R))/2 = 0.00836, g = 0.299."""
    for step in (0.0, 0.05):
        rate, dice, at, seen = CurrentRate(), random.Random(1), [0.0, 0.0], []
        for _ in range(4000):
            at = [x + dice.gauss(0.0, step) for x in at]
            rate.feed(*(x + dice.gauss(0.0, 0.02) for x in at), 0.14, False)
            seen.append(rate.variance)
        assert sum(seen[200:]) / 3800 == pytest.approx(step * step, rel=0.15, abs=1e-5)
    rate._near, rate._far = 0.004, 0.004 + 0.0025 * 2.0 * (BLOCKS_APART - 1)
    assert rate.gain(0.14) == pytest.approx(0.299, abs=0.001)


def test_until_enough_is_known_the_current_has_no_gain_and_a_lie_teaches_little():
    rate = CurrentRate()
    for k in range(ENOUGH - 1):
        rate.feed(0.1 * k, 0.0, 0.14, False)
        assert rate.gain(0.14) == 0.0
    calm = CurrentRate()
    for k in range(200):
        calm.feed(0.5 * (k > 190), 0.0, 0.14, k > 190)
    assert calm.variance < 1e-4


@pytest.mark.parametrize("seed", range(4))
def test_five_hours_in_eddies_are_no_fault_and_half_a_metre_a_second_of_the_log_is(seed):
    """Test: a current whose eddies are 0.12 m/s and last 600 s; then the log is 0.5 m/s off. Expected: nothing is
    said in five hours; then within 80 s."""
    stream, currents = Stream(U_0), list(eddies(seed, 1812))
    assert not alarms(stream, currents[:1800])
    assert alarms(stream, currents[1800:], 0.5)[0] <= 8


def test_a_voyage_that_begins_in_strong_eddies_is_no_fault_and_a_log_that_is_off_then_is():
    """Test: sixty times ten minutes that begin in eddies of 0.25 m/s, as in a rough sea; then, in eddies of 0.06 m/s,
    a log that is 0.5 m/s off from the twelfth block on, the first that is judged. Expected: nothing is said; said
    within 70 s."""
    for seed in range(60):
        assert not alarms(Stream(U_0), eddies(seed, 60, 0.25)), seed
    for seed in range(5):
        stream, currents = Stream(U_0), list(eddies(seed, 40, 0.06))
        assert not alarms(stream, currents[:ENOUGH])
        assert alarms(stream, currents[ENOUGH:], 0.5)[0] < 7


def test_in_a_current_that_hardly_changes_a_small_shift_is_still_found():
    """Test: eddies of 0.02 m/s, then 0.3 m/s of the log. Expected: said within two minutes."""
    stream, currents = Stream(U_0), list(eddies(9, 312, 0.02))
    assert not alarms(stream, currents[:300])
    assert alarms(stream, currents[300:], 0.3)

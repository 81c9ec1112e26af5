"""A speed log that speaks twice a second or less, in waves, on the loop that the service builds: a boat that sailed
with the sea ahead comes beam on to it."""

import random
from itertools import pairwise

import pytest

from bench.instrument_lies import rows_of
from bench.promise_returns import heard, loop_for
from bench.reference import SeaCase, Weather, simulate
from bench.reference.hulls import HULLS
from bench.reference.trial_legs import COURSE, Leg
from tests.thorough import one_of, thorough

SEA_HZ, TURNS_S, SECONDS, LIES_S = 10, 300.0, 480.0, 400.0
LOUD = "far noisier than it was"
LOG = "surge_velocity_through_water_mps", "sway_velocity_through_water_mps"


def length_s(boat):
    """How long a leg of one length lasts; a boat's are twice as many."""
    return 2.0 * boat.L / boat.U0


@pytest.fixture(scope="module")
def rows():
    one = length_s(HULLS["usv"])
    plan = Leg(COURSE, TURNS_S / one), Leg(COURSE, (SECONDS - TURNS_S) / one + 1.0, 90.0)
    sea = Weather(1.0, 0.0, 0.12, 0.06, 1.3, 0.0, 0.02, 0.0)
    (recording,) = simulate([SeaCase("usv", plan, sea, seed=2, duration_s=SECONDS)], 1.0 / SEA_HZ)
    return list(rows_of(recording))


def loud_ticks(rows, hz, alter=lambda row, t: None):
    """Seconds of the ticks in which a channel is called noisy, and which; log and loop at this rate."""
    loop, every, told = loop_for("usv", float(hz)), SEA_HZ // hz, []
    for k in range(0, len(rows), every):
        row = dict(rows[k])
        alter(row, k / SEA_HZ)
        tick = heard(loop, row, k / SEA_HZ, k // every)
        told += [
            (k / SEA_HZ, text.removeprefix("certificate: ").partition(":")[0])
            for text in tick.reasons
            if LOUD in text
        ]
    return told


@thorough
@pytest.mark.parametrize("hz", one_of((5, 10)))
def test_the_sway_of_beam_seas_is_no_noise_of_the_log(rows, hz):
    """Expected: nothing is called noisy, though the log's scatter has grown to many times what it was in the sea
    ahead: the receiver sees the same sway."""
    sway = [
        [r[LOG[1]] for r in rows if a < r["time_s"] < b and r[LOG[1]] == r[LOG[1]]]
        for a, b in ((60, 300), (320, 480))
    ]
    ahead, beam = (sum((y - x) ** 2 for x, y in pairwise(s)) / len(s) for s in sway)
    assert beam > 10.0 * ahead
    assert loud_ticks(rows, hz) == []


@thorough
@pytest.mark.parametrize("hz", one_of((5, 10)))
def test_a_log_that_becomes_noisy_in_beam_seas_is_called_so_soon(rows, hz):
    """Test: 0.5 m/s of noise on both axes of the log, the boat beam on. Expected: said within 20 s, of the log alone,
    and in most of the time from then on."""
    chance = random.Random(4)

    def noisy(row, t):
        for name in LOG:
            row[name] += chance.gauss(0.0, 0.5) if t >= LIES_S else 0.0

    told = loud_ticks(rows, hz, noisy)
    assert told and LIES_S < told[0][0] < LIES_S + 20.0 and {name for _, name in told} <= set(LOG)
    since = [t for t, _ in told]
    assert len(set(since)) > 0.8 * (SECONDS - since[0]) * hz

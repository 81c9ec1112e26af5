"""A hundred thousand messages, true, mutated and made up, through decoder, gates and tick: no crash,
nothing that is not finite, no bound broken."""

import itertools
import random
from math import hypot, isfinite

import pytest

from tests.thorough import one_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.keelson.decode import Decoder
from twin.live.keelson.messages import encode_fix, encode_float, wrap
from twin.live.keelson.topics import INPUTS, key
from twin.live.learning.adapt import A_MAX
from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.residual import bundled, load
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.channels import CHANNELS
from twin.physics.effects import BUILT_IN
from twin.physics.ship import load as load_ship

MESSAGES, EACH_TICK = 100_000, 60
WALL = 1.7e9


def made_up(dice: random.Random, now_s: float) -> tuple[str, bytes]:
    """One message: plausible, at the edge, or mutilated."""
    topic = dice.choice(INPUTS)
    stamp_ns = round((WALL + now_s + dice.choice((0.0, 0.0, 0.0, -0.3, -5.0, 4000.0, -1e9))) * 1e9)
    channel = next(c for c in CHANNELS if c.name == topic.channels[0])
    value = dice.choice(
        (
            dice.uniform(channel.low, channel.high),
            dice.uniform(-1.0, 1.0),
            channel.high,
            channel.low,
            1e30,
            float("nan"),
            0.0,
        )
    )
    if topic.subject == "location_fix":
        data = encode_fix(
            dice.choice((57.6, 57.6001, 91.0, -57.0)), dice.choice((11.6, 11.6001, 181.0)), stamp_ns
        )
    else:
        data = encode_float(value, stamp_ns)
    data = wrap(data, stamp_ns)
    if dice.random() < 0.2:
        data = mutated(dice, data)
    return key(
        "twin", "ship", dice.choice((topic.subject,) * 9 + ("unknown",)), dice.choice(("a", "a", "a", "b"))
    ), data


def mutated(dice: random.Random, data: bytes) -> bytes:
    how = dice.randrange(4)
    if how == 0:
        return data[: dice.randrange(len(data))]
    if how == 1:
        return dice.randbytes(dice.randrange(200))
    degraded = bytearray(data)
    for _ in range(dice.randrange(1, 4)):
        degraded[dice.randrange(len(degraded))] ^= 1 << dice.randrange(8)
    return bytes(degraded)


def sailed(ship, learned, count, numbers):
    """The loop under `count` messages; every tick is looked through."""
    dice, modes = random.Random(11), set()
    ears, decoder = Played([]), Decoder()
    loop = Loop(ship, ears, Outbox(Publisher(), "twin", "ship"), learned)
    for k in range(count // EACH_TICK):
        now_s = 100.0 + 0.1 * k
        ears.next = [r for _ in range(EACH_TICK) for r in decoder.decode(*made_up(dice, now_s), now_s)]
        tick = loop.tick(Instant(k, now_s, WALL + now_s))
        modes.add(tick.mode)
        assert all(isfinite(x) for _, x in numbers(tick))
        assert hypot(tick.learned.X_N, tick.learned.Y_N) <= 2.0 * tick.learned.bound_N + 1e-6
        assert abs(tick.learned.N_Nm) <= tick.learned.bound_Nm + 1e-6
        assert hypot(tick.estimate.current_north_mps, tick.estimate.current_east_mps) <= 5.0 + 1e-9
    assert loop.sensors.rejected > count / 10 and len(modes) > 1
    return loop


def test_I27_a_hundred_thousand_messages_do_no_harm(kvlcc2, numbers):
    learned = LearnedForce(kvlcc2, load(bundled(kvlcc2), kvlcc2))
    sailed(kvlcc2, learned, MESSAGES, numbers)
    assert learned.adaptation.norm() <= A_MAX + 1e-9


def test_nor_do_they_on_a_small_boat_with_every_effect_of_the_catalogue(numbers):
    boat = load_ship("usv")
    effects = [e.plausible(boat) for e in BUILT_IN if not e.lacking(boat)]
    assert len(effects) > 15
    boat = boat.with_effects(*effects)
    sailed(boat, LearnedForce(boat, None, "none in this test"), MESSAGES // 5, numbers)


@pytest.mark.parametrize("seed", one_of(range(3)))
def test_pauses_uneven_ticks_and_clock_steps_do_no_harm_to_the_loop_that_the_service_builds(
    make_service, numbers, seed
):
    """Test: certificate, residual and adaptation on; a ship that sails, ticks of 0.1 to 1 s, pauses to 90 s,
    the wall clock set by up to two hours either way, channels that fall silent, made-up messages between.
    Expected: no crash, only finite numbers, no bound broken, and the promise given and taken back many
    times."""
    dice, bridge, decoder = random.Random(seed), make_service(), Decoder()
    loop, inside, restarts, now_s = bridge.loop, [], 0, bridge.now_s
    silent_until, own = {}, (*bridge.sailing.true(), "")
    for k in range(4000):
        readings = [r for r in bridge.sailing.readings(now_s) if silent_until.get(r.channel, 0.0) < now_s]
        wall_s = now_s + bridge.wall_less_mono
        bridge.ears.next = [r._replace(time_s=wall_s) for r in readings]
        if dice.random() < 0.01:
            topic, data = made_up(dice, now_s)
            bridge.ears.next += [r for r in decoder.decode(topic, data, now_s) if r.channel in own]
        tick = loop.tick(Instant(k, now_s, wall_s))
        assert all(isfinite(x) for _, x in numbers(tick)) and tick.certificate.bound >= 0.0
        assert hypot(tick.learned.X_N, tick.learned.Y_N) <= 2.0 * tick.learned.bound_N + 1e-6
        assert all(p.horizon_s > 0.0 for p in tick.predictions)
        if tick.certificate.inside:
            e = loop.observer.estimate
            true = bridge.sailing.state[3:]
            assert hypot(e.u - true[0], e.v - true[1]) < tick.certificate.bound
        inside.append(tick.certificate.inside)
        if dice.random() < 0.004:
            silent_until[dice.choice(list(bridge.sailing.true()))] = now_s + dice.uniform(0.5, 30.0)
        if dice.random() < 0.004:
            bridge.wall_less_mono += dice.choice((-7200.0, -30.0, -2.5, -0.4, 0.4, 2.5, 3600.0))
        steps = dice.choice((1,) * 400 + (2, 3, 5, 10, 15, 29, 31, 40, 100, 900))
        for _ in range(steps):
            bridge.sailing.advance()
        now_s += 0.1 * steps
        restarts = loop.observer.restarts
    changes = sum(a != b for a, b in itertools.pairwise(inside))
    assert restarts > 5 and changes > 4 and sum(inside) > 400, (restarts, changes, sum(inside))

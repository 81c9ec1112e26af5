"""100 000 random and mutated messages: no crash, and no number that is none passes (I27)."""

import random
from math import isfinite

from twin.live.keelson import messages, topics
from twin.live.keelson.decode import EARLIEST_S, LATEST_S, Decoder
from twin.live.signals.channels import BY_NAME
from twin.live.signals.chart import Chart
from twin.live.signals.geodesy import MAX_DISTANCE_M, datum
from twin.live.signals.readings import Reading

NS = 1_750_000_000_000_000_000
CASES = 100_000


def seeds() -> list[tuple[str, bytes]]:
    """One good message for each topic."""
    made = []
    for topic in topics.INPUTS:
        is_fix = topic.type_name == topics.FIX
        payload = messages.encode_fix(57.7, 11.9, NS) if is_fix else messages.encode_float(1.5, NS)
        made.append((topics.key("twin", "ship", topic.subject, "x"), payload))
    return made


def mutated(rng: random.Random, data: bytes) -> bytes:
    """Bits flipped, cut short, bytes put in or repeated, or nothing but noise."""
    kind = rng.randrange(6)
    raw = bytearray(data)
    if kind == 0:
        for _ in range(rng.randrange(1, 4)):
            raw[rng.randrange(len(raw))] ^= 1 << rng.randrange(8)
    elif kind == 1:
        del raw[rng.randrange(len(raw)) :]
    elif kind == 2:
        at = rng.randrange(len(raw))
        raw[at:at] = rng.randbytes(rng.randrange(1, 9))
    elif kind == 3:
        raw += raw[rng.randrange(len(raw)) :]
    elif kind == 4:
        raw = bytearray(rng.randbytes(rng.randrange(60)))
    else:
        at = rng.randrange(len(raw))
        raw[at : at + 8] = rng.choice((b"\x00" * 8, b"\xff" * 8, b"\x7f\xf0" * 4))
    return bytes(raw)


def test_no_message_however_mangled_crashes_or_passes_what_is_no_measurement() -> None:
    rng = random.Random(20260917)
    good = seeds()
    decoder = Decoder(Chart(datum(57.7, 11.9)))
    passed = 0
    for _ in range(CASES):
        key, payload = good[rng.randrange(len(good))]
        data = messages.wrap(payload, NS)
        data = mutated(rng, data) if rng.random() < 0.5 else messages.wrap(mutated(rng, payload), NS)
        for result in decoder.decode(key, data, 1.0):
            if not isinstance(result, Reading):
                assert result.why
                continue
            passed += 1
            limits = BY_NAME[result.channel]
            assert isfinite(result.value) and limits.low <= result.value <= limits.high
            assert EARLIEST_S <= result.time_s <= LATEST_S + 1.0
            if result.channel in topics.POSITION:
                assert abs(result.value) <= MAX_DISTANCE_M
    assert 0 < passed < CASES

"""How the record of a ship's actuators may be wired otherwise than its ship file says: each way by itself.

Sides exchanged, one of them or all in reverse, the angle of those that turn counted from elsewhere or the
other way round.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import pi

import numpy as np

from twin.num import as_given
from twin.physics.actuators import Actuator
from twin.physics.actuators.actuator_channels import DRIVES
from twin.physics.actuators.kinds import KINDS, SPAN_US, STOP_US

OrderArrays = Mapping[str, np.ndarray]
Undo = Callable[[OrderArrays], OrderArrays]
RIGHT = "as recorded"
AngleCount = tuple[str, Callable[[np.ndarray], np.ndarray], str]
# what an angle may be counted as: (words, true angle of the recorded one, what the map needs); of what stands
# to either side of amidships, as a rudder and a nozzle do
MIRRORED: tuple[AngleCount, ...] = (("is positive to port", lambda x: -x, "sign = -1"),)
# and beside it of what turns all round
FROM_ELSEWHERE: tuple[AngleCount, ...] = (
    ("is 180 deg off", lambda x: x + pi, "offset = 180"),
    ("is 90 deg too small", lambda x: x + pi / 2, "offset = 90"),
    ("is 90 deg too large", lambda x: x - pi / 2, "offset = -90"),
    ("counts anticlockwise from starboard", lambda x: pi / 2 - x, "sign = -1 and offset = 90"),
    ("counts anticlockwise from port", lambda x: -pi / 2 - x, "sign = -1 and offset = -90"),
    ("counts anticlockwise from astern", lambda x: pi - x, "sign = -1 and offset = 180"),
)


@dataclass(frozen=True)
class Wiring:
    """`undo(told)`: what is told of all actuators (`name.attribute`, SI), had it been recorded right; `fix`:
    what the map needs; `mistakes`: how many it takes."""

    text: str
    undo: Undo
    fix: str
    mistakes: int = 1


def wirings(actuators: Sequence[Actuator]) -> list[Wiring]:
    """As recorded, every single mistake, and an exchange with one beside it."""
    exchanges = list(_exchanged(actuators))
    reverses = list(_reversed(actuators))
    singles = [*exchanges, *reverses, *_turned(actuators)]
    return [
        Wiring(RIGHT, dict, "", 0),
        *singles,
        *(_both(a, b) for a in exchanges for b in reverses),
    ]


def _both(a: Wiring, b: Wiring) -> Wiring:
    return Wiring(f"{b.text}, and {a.text}", lambda told: a.undo(b.undo(told)), f"{b.fix}; {a.fix}", 2)


def _exchanged(actuators: Sequence[Actuator]) -> Iterator[Wiring]:
    for a, b in combinations(actuators, 2):
        if a.kind == b.kind and a.channels == b.channels and (a.x, a.y) != (b.x, b.y):
            pairs = [(f"{a.name}.{n}", f"{b.name}.{n}") for n in a.attributes]
            other = dict(pairs) | {q: p for p, q in pairs}
            columns = ", ".join(f"{p} with {q}" for p, q in zip(a.columns(), b.columns(), strict=True))

            def undo(told: OrderArrays, other: dict[str, str] = other) -> OrderArrays:
                return {name: told[other.get(name, name)] for name in told}

            yield Wiring(f"{a.name} and {b.name} are exchanged", undo, f"exchange the columns of {columns}")


def _reversed(actuators: Sequence[Actuator]) -> Iterator[Wiring]:
    for a in actuators:
        yield _reverse((a,), f"{a.name} is reversed")
    if len(actuators) > 1:
        yield _reverse(tuple(actuators), "all actuators are reversed")


def _reverse(parts: tuple[Actuator, ...], text: str) -> Wiring:
    drives = [(a, n, c) for a in parts for n, c in zip(a.attributes, a.channels, strict=True) if n in DRIVES]

    def undo(told: OrderArrays) -> OrderArrays:
        return dict(told) | {f"{a.name}.{n}": 2.0 * stop(a, n) - told[f"{a.name}.{n}"] for a, n, _ in drives}

    fixes = []
    for a, n, channel in drives:
        twice = 2.0 * stop(a, n)
        offset = f" and offset = {as_given(twice, 6)}" if twice else ""
        fixes.append(f"sign = -1{offset} for {a.name}.{channel}")
    return Wiring(text, undo, ", ".join(fixes))


def stop(a: Actuator, attribute: str) -> float:
    """What is told to it when it stands still."""
    zero = float(a.zero)
    return STOP_US + SPAN_US * zero if attribute == "pwm" else zero if attribute == "command" else 0.0


def _turned(actuators: Sequence[Actuator]) -> Iterator[Wiring]:
    turning = [a for a in actuators if "angle" in a.attributes]
    all_round = [a for a in turning if KINDS[a.kind].all_round]
    yield from _counted(turning, "the angle of each that turns", MIRRORED)
    each = "the angle of each that turns" + " all round" * (len(all_round) < len(turning))
    yield from _counted(all_round, each, FROM_ELSEWHERE)


def _counted(turning: Sequence[Actuator], each: str, counts: Sequence[AngleCount]) -> Iterator[Wiring]:
    """Each by itself and all together, their angles counted in each of these ways."""
    groups = [(a,) for a in turning] + ([tuple(turning)] if len(turning) > 1 else [])
    for parts in groups:
        who = f"the angle of {parts[0].name}" if len(parts) == 1 else each
        columns = ", ".join(c for a in parts for c in a.columns() if "angle" in c)
        for words, turn, fix in counts:

            def undo(
                told: OrderArrays,
                parts: tuple[Actuator, ...] = parts,
                turn: Callable[[np.ndarray], np.ndarray] = turn,
            ) -> OrderArrays:
                return dict(told) | {f"{a.name}.angle": turn(told[f"{a.name}.angle"]) for a in parts}

            yield Wiring(f"{who} {words}", undo, f"{fix} for {columns}")

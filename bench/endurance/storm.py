"""A storm of messages into the loop that the service builds, certificate, network and adaptation on, over
pauses, set clocks and silent instruments. In every second voyage instruments lie besides, and messages are
made up."""

import random
from collections.abc import Callable
from copy import deepcopy
from typing import NamedTuple

from bench import bench_output
from bench.fuzz import aboard
from bench.fuzz.take import Take

VOYAGE_TICKS, SEED = 2000, 33
SHARE_PAUSED, SHARE_CLOCK, SHARE_SILENT, SHARE_HEALED = 0.01, 0.005, 0.01, 0.03  # of the ticks
SHARE_HOSTILE = 0.2  # of the ticks of every second voyage
LONGEST = 6000  # steps of 0.1 s of a pause


class Storm(NamedTuple):
    """What was blown into the loop; `honest`: in voyages in which no instrument lies, and with a promise."""

    messages: int
    ticks: int
    voyages: int
    pauses: int
    clocks: int
    honest_ticks: int
    honest_inside: int


def storm(messages: int) -> Storm:
    """Voyages until so many messages were heard. Watched (bench.fuzz.aboard): the loop broke a promise."""
    target, total = aboard.LoopTarget(), Storm(0, 0, 0, 0, 0, 0, 0)
    while total.messages < messages:
        one = voyage(target, random.Random(SEED + total.voyages), total.voyages % 2 == 1)
        total = Storm(*(a + b for a, b in zip(total, one, strict=True)))
        if total.voyages % 20 == 0:
            bench_output.tell(str(total))
    return total


def voyage(target: aboard.LoopTarget, dice: random.Random, hostile: bool, ticks: int = VOYAGE_TICKS) -> Storm:
    """One voyage of so many ticks, each looked through (`FuzzedVoyage.tick`)."""
    loop = deepcopy(target.loop, {id(thing): thing for thing in target.shared})
    sailing, heard, pauses, clocks = aboard.FuzzedVoyage(target, loop, aboard.WARM), 0, 0, 0
    for _ in range(ticks):
        if dice.random() < SHARE_PAUSED:
            sailing.k += round(LONGEST ** dice.random())
            pauses += 1
        if dice.random() < SHARE_CLOCK:
            _decided(dice, sailing, dice.choice((aboard._set_clock, aboard._sources_clock)))
            clocks += 1
        if dice.random() < SHARE_SILENT:
            _decided(dice, sailing, dice.choice((aboard._silence, aboard._all_silent)))
        if hostile and dice.random() < SHARE_HOSTILE:
            _decided(dice, sailing, dice.choice((aboard._lie, *(aboard._message,) * 9)))
        if dice.random() < SHARE_HEALED:  # all is as it should be again
            sailing.silent, sailing.off, sailing.behind = set(), {}, 0.0
        heard += len(aboard.CHANNELS) - len(sailing.silent) + len(sailing.made)
        sailing.tick()
    return Storm(heard, ticks, 1, pauses, clocks, ticks * (not hostile), sailing.inside * (not hostile))


def _decided(
    dice: random.Random, sailing: aboard.FuzzedVoyage, decision: Callable[[aboard.FuzzedVoyage, Take], None]
) -> None:
    decision(sailing, Take(dice.randbytes(300)))

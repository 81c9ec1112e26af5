"""Many ships asked for months: what of it is more than chance.

Each voyage has one number, the score s of reference/healthy.py. In time order, beside the n scores that the
ship's calibration left and those of the voyages before, it has a rank r from the top among N = n + t. Were
the ship in health, so that all of them could have come in any order, each rank would be as likely, alone of
those before, and

    E_t = sqrt(N) (sqrt(r) - sqrt(r - 1))      mean over r = 1 ... N: 1
    M_t = E_1 E_2 ... E_t

is a test martingale: the chance that M ever reaches 1/a is at most a, whenever one looks (Ville 1939; Vovk,
Gammerman & Shafer 2022, Algorithmic Learning in a Random World, ch. 8, with 1/2 p^(-1/2) averaged over
random ties, which gives E_t). Of G ships, the k with the greatest M are an alarm where the k-th reaches
G/(k a): at most the share a of such ships is in health, in the mean (e-BH; Wang & Ramdas 2022, J. R. Stat.
Soc. B 84).

Scores that calibration left are leave-one-out scores and keep that nearly, not exactly. Another season,
loading or route breaks the order of days as a fault does.
"""

from collections.abc import Mapping, Sequence
from math import exp, fsum, log, prod, sqrt
from typing import NamedTuple

LEVEL = 0.05  # share of ships in an alarm that may be in health


class Martingale(NamedTuple):
    """What a ship's voyages say together against "all as on its reference voyages"."""

    references: int
    voyages: int
    value: float  # M after the last voyage
    highest: float  # the greatest M so far
    at_most: float  # no M of so many references and voyages is greater


def evidence(references: Sequence[float], scores: Sequence[float]) -> Martingale:
    """Of voyages' scores in the order in which they were sailed."""
    known, value, highest, n = list(references), 1.0, 1.0, len(references)
    for s in scores:
        known.append(s)
        r = sum(x >= s for x in known)  # equal scores count against the voyage
        value *= sqrt(len(known)) * (sqrt(r) - sqrt(r - 1))
        highest = max(highest, value)
    return Martingale(n, len(scores), value, highest, prod(sqrt(n + t) for t in range(1, len(scores) + 1)))


def alarms(fleet: Mapping[str, Martingale], level: float = LEVEL) -> list[str]:
    """The ships of which at most the share `level` is in health, by their M now."""
    order = sorted(fleet, key=lambda name: -fleet[name].value)
    reached = (k for k, name in enumerate(order, 1) if fleet[name].value * k * level >= len(fleet))
    return order[: max(reached, default=0)]


def of_a_lasting_fault(references: int, voyages: int) -> float:
    """What M typically reaches (by the mean of its logarithm) on so many voyages that all score above every
    reference and are alike among themselves: a fault that stays as it is.

    The voyages become each other's references, so that it ends at about twice as many voyages as there are
    references: what M is then, more voyages never show.
    """
    highest = total = 0.0
    for t in range(1, min(voyages, 3 * references + 3) + 1):
        each = (log(sqrt(references + t) * (sqrt(r) - sqrt(r - 1))) for r in range(1, t + 1))
        total += fsum(each) / t
        highest = max(highest, total)
    return exp(highest)

"""What is left when the best explanation holds: as little as on the reference voyages, or more, so that something else is at work.

Of all hypotheses one is the best, also when none is true: two effects that nobody sailed with explain almost any third. When it is
the truth, what remains is what remained on the reference voyages. When it only looks like it, the ship stays restless, or does not
go where it leads her.
"""

from dataclasses import replace

import numpy as np

from .case import WORLDS, Case
from .evidence import posterior
from .refine import Found, standing

ASTRAY = 2.0  # times the floor that the best explanation may end away from where she went
BETTER = 0.05  # share by which a force must bring her nearer to where she went
RESTLESS = 4  # times the fast part of the floor
FACTORS = np.array([1, 2, 4, 8, 16, 32])
CLEAR = 3.0  # log evidence by which the voyages must be restless
SEA = 0.003  # wave height in ship lengths from which a measured sea may be the reason


def explains(case: Case, found: Found) -> bool:
    """Whether no more is left under this hypothesis than a true one would leave. A sea that was measured may be the reason for more,
    and a stream that changes for restlessness."""
    world = WORLDS[found.hypothesis.world]
    if _at_sea(case):
        return True
    return world.plain and not found.off_m > ASTRAY * found.floor_m and (world.flow > 1.0 or quiet(case, found))


def _at_sea(case: Case) -> bool:
    return any(np.nanmedian(t.weather["H_s"]) > SEA * case.model.ship.L_pp for t in case.tracks if "H_s" in t.weather)


def helps(case: Case, found: Found, nothing: Found) -> bool:
    """Whether she is led better with the effects of this hypothesis than without, as `twin add` will ask; one that only changes what
    the instruments read need not."""
    moves = any(case.catalogue[name].kind != "SensorFault" for name in found.hypothesis.effects)
    return not moves or not found.off_m > (1.0 - BETTER) * nothing.off_m


def quiet(case: Case, found: Found) -> bool:
    """Whether the voyages are, under this hypothesis, as quiet as the reference voyages."""
    lines, at = standing(case, found)
    floors = [replace(case.floor, white=float(k) * case.white, doubt=found.doubt) for k in FACTORS]
    says = np.array([posterior(r, found.hypothesis.effects).log_evidence for r in case.reduced(lines, floors, at)])
    return bool(says[FACTORS >= RESTLESS].max() < says[FACTORS < RESTLESS].max() + CLEAR)

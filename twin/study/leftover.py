"""What is left when the best explanation holds: as quiet as the reference voyages, or restless, so that something else is at work.

Two effects that nobody sailed with explain almost any third: they have six or more numbers between them. When they are the truth,
what remains is what remained on the reference voyages; when they only look like it, the ship stays restless. Asked of pairs alone:
a single effect whose form is only roughly right leaves something over too, and its name is still the one that helps.
"""

from dataclasses import replace

import numpy as np

from .case import WORLDS, Case
from .evidence import posterior
from .refine import Found, standing

RESTLESS = 4  # times the fast part of the floor
FACTORS = np.array([1, 2, 4, 8, 16, 32])
CLEAR = 3.0  # log evidence by which the voyages must be restless
SEA = 0.003  # wave height in ship lengths from which a measured sea may be the reason


def quiet(case: Case, found: Found) -> bool:
    """Whether the voyages are, under this hypothesis, as quiet as the reference voyages; a stream that changes or a sea that was
    measured may make them restless."""
    chosen, world = found.hypothesis.effects, WORLDS[found.hypothesis.world]
    if world.share > 1.0:
        return False
    if world.flow > 1.0 or any(np.nanmedian(t.weather["H_s"]) > SEA * case.model.ship.L_pp for t in case.tracks if "H_s" in t.weather):
        return True
    lines, at = standing(case, found)
    floors = [replace(case.floor, white=float(k) * case.white, doubt=found.doubt) for k in FACTORS]
    says = np.array([posterior(r, chosen).log_evidence for r in case.reduced(lines, floors, at)])
    return bool(says[FACTORS >= RESTLESS].max() < says[FACTORS < RESTLESS].max() + CLEAR)

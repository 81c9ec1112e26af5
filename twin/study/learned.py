"""A trained residual in the study: the learned force as the loop adds it (its adaptation left out), for arrays of situations."""

from collections.abc import Callable
from dataclasses import fields

import numpy as np

from twin.live.learned import LearnedForce
from twin.live.residual import load
from twin.physics.ship import Ship
from twin.physics.state import Force, Situation


def learned_force(path: str, ship: Ship) -> Callable[[Situation], Force]:
    """Situation (floats or arrays, s.u_r and s.v_r set) -> the residual's force; SettingsError when it must not be used."""
    learned = LearnedForce(ship, load(path, ship), adapt=False)

    def force(s: Situation) -> Force:
        there = {f.name: np.atleast_1d(np.asarray(x, float)) for f in fields(Situation) if (x := getattr(s, f.name)) is not None}
        width = max(x.size for x in there.values())
        rows = zip(*(np.broadcast_to(x, width).tolist() for x in there.values()), strict=True)
        found = [learned.at(Situation(**dict(zip(there, row, strict=True))), ()).force for row in rows]
        return Force(*np.array(found).T)

    return force

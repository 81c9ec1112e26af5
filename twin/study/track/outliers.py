"""Readings that no force could have made: a receiver that jumped and came back.

The smooth motion under the readings asks for a force, M (its acceleration - the model's), averaged over half
a ship length of sailing. Where in one axis it is greater than all of the model's forces together ever are
there, and than LIMIT times what is usual about that moment, the readings of that motion do not count: they
are a hole, through which the ship is predicted. A push that was real is still there behind the hole, in where
the ship is and how it moves. What is usual is a median over the time about each moment, so that waves, which
swing the ship all the time, are none.
"""

import numpy as np

from twin.physics import core
from twin.physics.model import Model
from twin.physics.state import Situation

ABOUT = 16.0  # L/U_0 on each side of a moment, whose median is usual there: longer than a receiver is lost
HALF_LENGTH = 0.5  # of L/U_0 over which the force is averaged
LIMIT = 6.0  # standard deviations, as in the smooth motion
OF_AXIS = ((0, 1, 3, 4), (0, 1, 3, 4), (2, 5))  # readings that tell of surge, of sway and of yaw
Jump = tuple[float, float, tuple[str, ...]]
GREATEST = 0.99  # quantile of the forces that acts as their greatest


def outliers(s: Situation, model: Model, h: float, whole: np.ndarray) -> np.ndarray:
    """(N, 8) bool: the readings, in the order of READINGS, that no force could have made. `s`: the smooth
    motion, on a grid with steps of h [s]; `whole` (N,): where it is known."""
    time = float(model.ship.scale("time"))
    width = max(2, round(HALF_LENGTH * time / h))
    out = np.zeros((whole.size, 8), bool)
    if whole.size <= 2 * width:
        return out
    asked = _missing(s, model, h, width)
    forces = [np.column_stack(np.broadcast_arrays(*f, s.u)[:3]) for f in model.known(s).values()]
    acting = np.sum(np.abs(forces), axis=0)
    greatest = np.quantile(acting[whole], GREATEST, axis=0)
    usual = 1.4826 * _lately(np.abs(asked), round(2.0 * ABOUT * time / h))
    known = np.asarray(np.lib.stride_tricks.sliding_window_view(whole, width + 1).all(1))
    off = (np.abs(asked) > np.maximum(greatest, LIMIT * usual)) & known[:, None]
    for axis, readings in enumerate(OF_AXIS):
        for k in np.flatnonzero(off[:, axis]):
            out[k : k + width + 1, readings] = True
    return out


def stretches_of(off: np.ndarray, t: np.ndarray) -> tuple[Jump, ...]:
    """Begin and end [s] of every stretch in which readings (N, 8) do not count, at the times `t` (N,), and
    what they are."""
    edges = np.flatnonzero(np.diff(off.any(1).astype(int), prepend=0, append=0))
    return tuple((float(t[a]), float(t[b - 1]), _names(off[a:b])) for a, b in edges.reshape(-1, 2))


def _names(off: np.ndarray) -> tuple[str, ...]:
    place, heading = off[:, 0].any(), off[:, 2].any()
    return ("place",) * bool(place) + ("heading",) * bool(heading)


def _missing(s: Situation, model: Model, h: float, width: int) -> np.ndarray:
    """(N - width, 3): the force X, Y [N], N [N m] that the motion asks for beyond the model's, a mean over
    `width` steps."""
    nu = np.column_stack(np.broadcast_arrays(s.u, s.v, s.r))
    rates = np.column_stack(np.broadcast_arrays(*model.nu_dot(s), s.u)[:3])
    steps = np.concatenate([np.zeros((1, 3)), np.cumsum(0.5 * (rates[1:] + rates[:-1]), axis=0)])
    rate = (nu[width:] - nu[:-width]) / (width * h) - (steps[width:] - steps[:-width]) / width
    grown = float(np.mean(s.grown[0])), float(np.mean(s.grown[1]))
    surge, sway, yaw = rate.T
    return np.column_stack(core.force_for(surge, sway, yaw, model.c, grown))


def _lately(sizes: np.ndarray, steps: int) -> np.ndarray:
    """Median of each column over so many rows about each row."""
    from scipy.ndimage import median_filter

    return np.column_stack([median_filter(x, min(steps, x.size), mode="reflect") for x in sizes.T])

"""Holes in what was recorded: how much of a hole a grid keeps, and over how long a one nobody can say how the
ship moved.

A logger that stood still for an hour or for months has told of the ship before and behind it, and of nothing
between. A grid keeps no more than HOLE_S of such a hole, and the smooth motion is sought on each side of it
alone."""

from collections.abc import Sequence

import numpy as np

# of a hole without any row that a grid keeps [s]; no reading of the motion is believed for so long
HOLE_S = 600.0
LENGTHS = 4.0  # L/U_0 without a reading, over which a ship may turn by more than its smooth motion can say
WAITS = 3.0  # and so many usual waits for the next reading, where it is read more slowly than that
LEAST_READINGS = 4  # readings that tell of a motion: one more than a path of no jerk has freedoms


def steps_on(time_s: np.ndarray, step_s: float, hole_s: float) -> np.ndarray:
    """(N,) int: the multiples of `step_s` from time_s[0] to the last sample; of a hole longer than `hole_s`
    the middle is left out."""
    t = time_s - time_s[0]
    last = int(np.floor(t[-1] / step_s + 1e-6))
    breaks = np.flatnonzero(np.diff(t) > hole_s)
    begin = np.ceil((t[breaks + 1] - 0.5 * hole_s) / step_s).astype(np.int64)
    end = np.floor((t[breaks] + 0.5 * hole_s) / step_s).astype(np.int64)
    begin = np.maximum(begin, end + 1)
    return np.concatenate(
        [np.arange(a, b + 1) for a, b in zip([0, *begin], [*np.minimum(end, last), last], strict=True)]
    )


def sailed_s(time_s: np.ndarray, hole_s: float = HOLE_S) -> float:
    """From the first sample to the last [s], a hole counted as no more than `hole_s`. `time_s` (N,)."""
    return float(np.minimum(np.diff(time_s), hole_s).sum())


def longest(there: np.ndarray, h: float, time: float) -> int:
    """Over how many steps of h [s] a hole may be bridged, where there are readings at `there` (N,) bool;
    `time`: L/U_0 [s]."""
    waits = np.diff(np.flatnonzero(there))
    return round(max(LENGTHS * time / h, WAITS * float(np.median(waits)) if waits.size else 0.0))


def pieces(there: np.ndarray, most: int) -> list[tuple[int, int]]:
    """(first, last) of the stretches with readings at `there` (N,) bool between holes of more than `most`
    steps, the first and last reading of each included; to the ends of the array where these are as near. A
    stretch of too few readings is none."""
    at = np.flatnonzero(there)
    groups = np.split(at, np.flatnonzero(np.diff(at) > most) + 1)
    found = [(int(g[0]), int(g[-1]) + 1) for g in groups if g.size >= LEAST_READINGS]
    if not found:
        return [(0, there.size)]
    (first, _), (_, last) = found[0], found[-1]
    begin = 0 if first <= most else first
    end = there.size if there.size - last <= most else last
    return [(begin if k == 0 else a, end if k == len(found) - 1 else b) for k, (a, b) in enumerate(found)]


def inside(found: Sequence[tuple[int, int]], size: int) -> np.ndarray:
    """(N,) bool, N the size: (size,) bool: the steps that lie in a piece, without the last one before a
    hole: what it leads to was not seen."""
    out = np.zeros(size, bool)
    for a, b in found:
        out[a : b if b == size else b - 1] = True
    return out


def lined(values: np.ndarray, found: Sequence[tuple[int, int]]) -> np.ndarray:
    """The same with straight lines from piece to piece, and level ends, in place of what stands outside of
    them. (N,), in its own unit."""
    at = np.concatenate([np.arange(a, b) for a, b in found])
    return values if at.size == values.size else np.interp(np.arange(values.size), at, values[at])


def slopes(values: np.ndarray, found: Sequence[tuple[int, int]], h: float) -> np.ndarray:
    """d(values)/dt of each piece by itself, and lines between them. (N,), in the unit of `values` (N,)
    over that of the step `h`."""
    out = np.zeros(values.size)
    for a, b in found:
        out[a:b] = np.gradient(values[a:b], h)
    return lined(out, found)

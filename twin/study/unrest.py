"""Readings that scatter more at some times than at others: short waves that shake an instrument but do not move the ship.

A gyro shows ripples that swing her by a tenth of a degree and leave no trace in where she goes; on another course they are gone. A filter
that trusts it alike at all times takes them for forces. So each reading's scatter is also looked for from moment to moment, in what is
faster than a ship manoeuvres; whether that is likelier than an even one, the voyages say (`case.settle`): a sharp turn looks alike.
"""

from dataclasses import replace

import numpy as np

from .track import Track, running_mean

SWIFT = 0.5  # L/U_0: what swings about the mean over so long a time no ship does by her rudder
LATELY = 8.0  # L/U_0: on another course waves are met otherwise


def shaken(track: Track, time: float) -> Track:
    """The track with its readings' scatter as it was at each moment, and nowhere less than its usual one (`time`: L/U_0)."""
    beside = track.measured - track.state[:, [0, 1, 2, 3, 4, 5, 3, 4]]
    swift, lately = (max(3, round(k * time / track.h)) for k in (SWIFT, LATELY))
    fast = np.column_stack([np.where(np.isfinite(e), e - running_mean(e, swift), np.nan) for e in beside.T])
    size = np.sqrt(np.column_stack([running_mean(e**2, lately) for e in fast.T]))
    return replace(track, unrest=np.maximum(size / track.sd, 1.0))

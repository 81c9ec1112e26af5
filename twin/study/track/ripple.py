"""Readings that scatter more at some times than at others: short waves that shake an instrument but do not
move the ship.

A gyro shows ripples that swing it by a tenth of a degree and leave no trace in where it goes; on another
course they are gone. A filter that trusts it alike at all times takes them for forces. So each reading's
scatter is also looked for from moment to moment, in what is faster than a ship manoeuvres; whether that is
likelier than an even one, the voyages say (`case.settle`): a sharp turn looks alike."""

from dataclasses import replace

import numpy as np

from twin.study.track.smooth_motion import running_mean
from twin.study.track.track import Track

SWIFT = 0.5  # L/U_0: what swings about the mean over so long a time no ship does by its rudder
LATELY = 8.0  # L/U_0: on another course waves are met otherwise
RESTLESS_RATIO = 1.5  # times its usual scatter, from which a reading scatters more
NORMAL = 1.4826  # standard deviations in a median of sizes; one wild reading is none


def shaken(track: Track, time: float) -> Track:
    """The track with its readings' scatter as it was at each moment, where that was clearly more than its
    usual one; else the track as it is
    (`time`: L/U_0)."""
    beside = track.measured - track.state[:, [0, 1, 2, 3, 4, 5, 3, 4]]
    swift, lately = (max(3, round(k * time / track.h)) for k in (SWIFT, LATELY))
    size = np.column_stack([_lately(np.abs(e - running_mean(e, swift)), lately) for e in beside.T])
    more = NORMAL * size / track.sd
    return (
        replace(track, ripple=np.where(more > RESTLESS_RATIO, more, 1.0))
        if (more > RESTLESS_RATIO).any()
        else track
    )


def _lately(values: np.ndarray, steps: int) -> np.ndarray:
    """Median over the readings within so many steps of each; none where there are none."""
    from scipy.ndimage import median_filter  # heavy, and not every verb asks how readings scatter

    there = np.flatnonzero(np.isfinite(values))
    if not there.size:
        return np.zeros(values.size)
    width = max(3, round(steps * there.size / values.size))
    return np.interp(np.arange(values.size), there, median_filter(values[there], width, mode="reflect"))

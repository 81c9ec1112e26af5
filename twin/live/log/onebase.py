"""Samples of many instruments, each with its own stamps, put on one time base without inventing any.

Between two samples of a fast channel the value is on the line between them (an angle goes the short way); in
a gap longer than the channel may be old, and outside, it is NaN. A slow channel (sea state, depth, draught)
keeps its last value for as long as that may be old.
"""

from math import nan

import numpy as np

from twin.live.signals.channels import BY_NAME, Channel

Columns = dict[str, np.ndarray]
Samples = dict[str, tuple[np.ndarray, np.ndarray]]  # channel: (stamps [s], values)
LEADERS = ("north_m", "heading_true_north_deg", "rudder_angle_deg", "propeller_rate_rpm")
SLOW_S = 60.0  # a channel that may be this old is a state of the sea or of the loading
SAME_S = 1e-4  # stamps nearer than this are one sample


def on_one_base(samples: Samples) -> tuple[np.ndarray, Columns]:
    """(time_s, columns) on the stamps of the most frequent channel among position, heading and controls.
    All (N,), the time in [s], columns in the unit in their name."""
    leaders = [name for name in LEADERS if name in samples] or list(samples)
    base = np.unique(samples[max(leaders, key=lambda name: samples[name][0].size)][0])
    return base, {name: along(base, BY_NAME[name], *pair) for name, pair in samples.items()}


def without_repeats(time_s: np.ndarray, columns: Columns, ages: Columns) -> Columns:
    """Columns of held values as what was sampled: each sample at its own stamp (time - age). All (N,),
    times and ages in [s], columns in the unit in their name."""
    result = dict(columns)
    for name in columns.keys() & ages.keys():
        stamps = time_s - ages[name]
        seen = np.flatnonzero(np.isfinite(stamps) & np.isfinite(columns[name]))
        new = seen[np.diff(stamps[seen], prepend=-np.inf) > SAME_S]
        result[name] = along(time_s, BY_NAME[name], stamps[new], columns[name][new])
    return result


def along(base: np.ndarray, channel: Channel, stamps: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(N,) values of a channel at the times `base` from samples in any order. `base` (N,) [s], `stamps`
    and `values` (M,)."""
    stamps, first = np.unique(stamps, return_index=True)
    values = values[first]
    if not stamps.size:
        return np.full(base.shape, nan)
    if channel.stale_s >= SLOW_S:
        return _held(base, channel, stamps, values)
    if channel.period:
        values = np.unwrap(values, period=channel.period)
    line = np.interp(base, stamps, values, left=nan, right=nan)
    line[_in_gap(base, stamps, channel.stale_s)] = nan
    return np.mod(line, channel.wraps) if channel.wraps else line


def _held(base: np.ndarray, channel: Channel, stamps: np.ndarray, values: np.ndarray) -> np.ndarray:
    before = np.searchsorted(stamps, base, side="right") - 1
    age = base - stamps[np.maximum(before, 0)]
    return np.where((before >= 0) & (age <= channel.stale_s), values[np.maximum(before, 0)], nan)


def _in_gap(base: np.ndarray, stamps: np.ndarray, longest_s: float) -> np.ndarray:
    """Which times lie between two stamps that are too far apart (and on neither)."""
    after = np.searchsorted(stamps, base)
    inside = (after > 0) & (after < stamps.size)
    at = np.clip(after, 1, max(stamps.size - 1, 1))
    if stamps.size < 2:
        return np.zeros(base.shape, bool)
    return np.asarray(inside & (stamps[at] - stamps[at - 1] > longest_s) & (stamps[at] != base))

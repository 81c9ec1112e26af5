"""Series as columns of one table: a row for each instant at which any of them was read, empty cells
between."""

from collections.abc import Iterable

import numpy as np

from twin.recording.formats.signals import Signals

SAME_S = 1e-6  # stamps nearer than this are one instant


def as_columns(signals: Signals, names: Iterable[str]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """(time_s (N,), {name: (N,)}) of the named series, NaN where one was not read. The time is in [s], the
    rest in the unit of each."""
    picked = {name: signals.series[name].arrays() for name in dict.fromkeys(names)}
    if not picked:
        return np.zeros(0), {}
    base = instants([t for t, _ in picked.values()])
    out: dict[str, np.ndarray] = {}
    for name, (t, x) in picked.items():
        out[name] = np.full(base.shape, np.nan)
        out[name][np.searchsorted(base, t + SAME_S, side="right") - 1] = x
    return base, out


def instants(stamps: list[np.ndarray]) -> np.ndarray:
    """All stamps (N,) [s] once, in order; those that are nearer than SAME_S are one."""
    base = np.unique(np.concatenate(stamps))
    return base[np.r_[True, np.diff(base) > SAME_S]] if base.size else base

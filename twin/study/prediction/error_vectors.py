"""The errors of open-loop predictions as vectors: place along and across the heading at the start, the rest
as it is read."""

import numpy as np

from twin.study.prediction.openloop import MODEL, Windows


def vectors(windows: Windows, run: int = MODEL) -> np.ndarray:
    """(K, W, 8) promise minus reading in the order of path_error.CHANNELS [m, m, rad, m/s, m/s, rad/s, m/s,
    m/s]; NaN where nothing was read."""
    return in_axes(windows, windows.off(run))


def in_axes(windows: Windows, off: np.ndarray) -> np.ndarray:
    """(..., W, 8) differences of readings, with north and east turned into along and across the heading at
    the start. In SI."""
    psi = windows.track.state[windows.start, 2]
    c, s = np.cos(psi), np.sin(psi)
    out = np.array(off, float)
    out[..., 0], out[..., 1] = off[..., 0] * c + off[..., 1] * s, off[..., 1] * c - off[..., 0] * s
    return out

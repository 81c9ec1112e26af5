"""What was sailed, as ranges of speed, rudder, turning and wind; and how much wider an error may be outside
them.

    w = 1 + sum over the quantities of (how far a window's mean lies outside the range) / (half the width of
        the range)

A window at 1.5 times the reference voyages' greatest rudder angle may thus be half as wrong again. That
errors grow in proportion to how far a model is used beyond its data is an assumption, no measurement: nothing
was sailed there."""

from collections.abc import Mapping, Sequence

import numpy as np

from twin.study.prediction.openloop import Windows
from twin.study.prediction.regimes import means

# as regimes.py means them: m/s, deg, deg/s, m/s
QUANTITIES = ("speed", "rudder_size", "turning_size", "wind")
ENDS = (0.02, 0.98)  # quantiles of the windows that are the ends of a range
FROM_NOTHING = ("rudder_size", "turning_size", "wind")  # less of these is no less known
WIDEST = 4.0


def sailed(windows: Sequence[Windows], horizon_s: float) -> dict[str, tuple[float, float]]:
    """Range of each quantity over all windows; none for what was not measured."""
    found = means(windows, horizon_s).values
    out = {}
    for name in QUANTITIES:
        values = found.get(name, np.empty(0))
        values = values[np.isfinite(values)]
        if values.size:
            low, high = np.quantile(values, ENDS)
            out[name] = (0.0 if name in FROM_NOTHING else float(low), float(high))
    return out


def widening(windows: Windows, horizon_s: float, ranges: Mapping[str, tuple[float, float]]) -> np.ndarray:
    """(W,) w of every window, 1 inside all ranges and WIDEST at most. It is dimensionless."""
    found = means([windows], horizon_s).values
    out = np.ones(windows.start.size)
    for name, (low, high) in ranges.items():
        if name in found:
            half = max(0.5 * (high - low), 0.05 * high, 1e-9)
            out += np.nan_to_num(np.maximum(0.0, np.maximum(low - found[name], found[name] - high)) / half)
    return np.minimum(out, WIDEST)

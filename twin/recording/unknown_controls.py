"""Gaps in which a control changed: what rudder or shaft did there, and when, nobody knows, so that nothing
there tells of the ship."""

import numpy as np

from twin.physics.ship import Ship
from twin.recording.voyage import Voyage

CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm")
WAITS = 3.0  # usual times from one sample to the next, from which a wait is a gap
CHANGED = 0.05  # of the span that a control used on the voyage, from which it is another one behind a gap
# and usual steps from sample to sample: no noise, and not the deadband of a logger that speaks when something
# changes
STEPS = 5.0


def gaps(voyage: Voyage, name: str) -> list[tuple[float, float]]:
    """(last sample before, first sample behind) [s] of every gap of a control in which its value changed."""
    there = np.isfinite(voyage[name])
    t, x = voyage.time_s[there], voyage[name][there]
    if t.size < 3:
        return []
    waits, steps = np.diff(t), np.abs(np.diff(x))
    low, high = np.quantile(x, [0.02, 0.98])
    changed = steps > max(CHANGED * float(high - low), STEPS * float(np.median(steps)))
    at = np.flatnonzero((waits > (WAITS + 1e-6) * np.median(waits)) & changed)
    return [(float(t[i]), float(t[i + 1])) for i in at]


def of_ship(ship: Ship | None) -> tuple[str, ...]:
    """The channels that say what drives and steers a ship."""
    parts = ship.actuators if ship is not None else ()
    return tuple(c for a in parts for c in a.columns()) or CONTROLS


def known(voyage: Voyage, time_s: np.ndarray, controls: tuple[str, ...] = CONTROLS) -> np.ndarray:
    """(N,) bool: whether a time lies in no such gap of any control."""
    out = np.ones(time_s.size, bool)
    for name in controls:
        for last, first in gaps(voyage, name):
            a, b = np.searchsorted(time_s, [last, first], side="left")
            out[a + (a < time_s.size and time_s[a] <= last) : b] = False
    return out

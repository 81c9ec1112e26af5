"""Whether a voyage holds a manoeuvre at all: a ship that only holds its course and speed tells one cause from
no other.

Asked of what helm and engine did, never of how much the noise would let one see: a long straight run shows an
autopilot's corrections to any precision, and what they seem to say is the model's own error."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from twin.physics.ship import Ship
from twin.study.track.track import Track

# a change of heading within STRETCH ship lengths that no autopilot makes to hold its course
TURN = np.radians(10.0)
STRETCH = 5.0
SHAFT = 0.1  # a change of the shaft's speed, as a share of its usual one


def manoeuvred(track: Track, ship: Ship) -> bool:
    """Whether the ship turned, or changed its shaft's speed, by more than it takes to hold course and
    speed."""
    return bool(_turned(track, ship) >= TURN or _throttled(track) >= SHAFT)


def _turned(track: Track, ship: Ship) -> float:
    """The greatest change of heading within STRETCH lengths [rad]."""
    steps = max(1, int(STRETCH * float(ship.scale("time")) / track.h))
    low, high = (
        sliding_window_view(np.where(track.whole, track.state[:, 2], left_out), min(steps + 1, len(track)))
        for left_out in (np.inf, -np.inf)
    )
    return float((high.max(1) - low.min(1)).max(initial=0.0))


def _throttled(track: Track) -> float:
    """How far the shaft's speed moved, as a share of its median."""
    drives = [x for k, x in (track.orders or {"n": track.n}).items() if not k.endswith((".angle", ".pitch"))]
    return max((_moved(x[track.whole]) for x in drives), default=0.0)


def _moved(n: np.ndarray) -> float:
    if not n.size:
        return 0.0
    low, high = np.quantile(n, [0.02, 0.98])
    return float((high - low) / max(abs(float(np.median(n))), 1e-9))

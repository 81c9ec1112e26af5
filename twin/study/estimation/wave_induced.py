"""What one wave does at once, in columns: a helmsman who answers it, and sway and surge that swing with the
yaw. No part of any model.

The filter carries waves in a band of each axis (`waves.py`) that knows nothing of the others, nor of the
rudder. But the helm follows each wave and a wave passes the rudder, so that what it does in time with the
waves is read as its answer to the helm, stronger or later than it is: a slow gear (identification in closed
loop, Ljung 1999, sec. 13.4). And one wave swings it in sway and surge as it does in yaw, a quarter of a
period apart or not at all: as if it were watched from elsewhere on board. How strong, and when, is left open
here for what is in time with the waves; what it does more slowly is not touched."""

from dataclasses import replace

import numpy as np

from twin.physics.model import Model
from twin.study.estimation.respond import accelerations as pushed
from twin.study.estimation.start import steadied, wave_period_s
from twin.study.track.smooth_motion import running_mean
from twin.study.track.track import READINGS, Track

EARLIER = "_earlier"  # a quarter of a period before
# prior width, as a share of what the rudder does in time with the waves
HELM = {"helm": 0.5, "helm" + EARLIER: 0.5}
# swing in it over the swing in yaw [L]
SWING = {"sway": 0.1, "sway" + EARLIER: 0.1, "surge": 0.1, "surge" + EARLIER: 0.1}
TERMS = HELM | SWING


def columns(track: Track, model: Model) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """(N, 3) accelerations [m/s2, m/s2, rad/s2] and (N, 8) readings of one unit of each term; nothing where
    no waves swing it."""
    still, unread = np.zeros((len(track), 3)), np.zeros((len(track), len(READINGS)))
    if track.swell is None:
        return dict.fromkeys(TERMS, (still, unread))
    period_s = wave_period_s(track)
    swift = _swift(track, model, period_s)
    swing = (track.state - steadied(track).state)[:, [2, 5]] * float(model.ship.L_pp)
    earlier = {False: swing, True: _earlier(swing, track, period_s)}
    helm = {False: swift, True: _earlier(swift, track, period_s)}
    return {name: (helm[name.endswith(EARLIER)], unread) for name in HELM} | {
        name: (still, _swung(track, name.removesuffix(EARLIER), earlier[name.endswith(EARLIER)]))
        for name in SWING
    }


def _swift(track: Track, model: Model, period_s: float) -> np.ndarray:
    """(N, 3) accelerations by what the helm does within a wave's period."""
    width = max(1, round(period_s / track.h))
    orders = None if track.orders is None else {k: running_mean(x, width) for k, x in track.orders.items()}
    mean = replace(track, delta=running_mean(track.delta, width), orders=orders)
    return pushed(track, model) - pushed(mean, model)


def _swung(track: Track, axis: str, swing: np.ndarray) -> np.ndarray:
    """(N, 8) readings of a ship that swings aside or ahead by so much (N, 2): how far, and how fast."""
    (by, rate), out = swing.T, np.zeros((len(track), len(READINGS)))
    c, s = np.cos(track.state[:, 2]), np.sin(track.state[:, 2])
    moved = {
        "sway": {"x": -s * by, "y": c * by, "v": rate},
        "surge": {"x": c * by, "y": s * by, "u": rate},
    }[axis]
    for reading, value in moved.items():
        out[:, READINGS.index(reading)] = value
    return out


def _earlier(values: np.ndarray, track: Track, period_s: float) -> np.ndarray:
    """A quarter of a period before, as slopes tell it of what swings."""
    return np.gradient(values, track.h, axis=0) * period_s / (2.0 * np.pi)

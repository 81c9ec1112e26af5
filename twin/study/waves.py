"""Waves as states of the filter: of surge, sway and yaw each an acceleration in a narrow band, beside what is slow.

    w'' + 2 zeta omega w' + omega^2 w = noise'

Its spectrum is zero at omega = 0, as no wave pushes for long. Beside w goes its carrier, in units in which both scatter alike, so that
frequency and size (`Track.swell`, seen in `seaway.py`) may change from step to step.
Source: Fossen (2021) Handbook of Marine Craft, sec. 10.2 and 13.2.
"""

import numpy as np

from .filters import AT_SEA, CARRIER, SLOW, STATES, WAVE
from .track import Track

DAMPING = 0.1  # zeta: how broad a band waves swing her in


def carried(track: Track) -> np.ndarray:
    """(N, 3, 2, 2) what takes each wave and its carrier one step on."""
    x = track.h * (np.zeros((len(track), 3)) if track.swell is None else track.swell[:, :3])
    swings = np.sqrt(1.0 - DAMPING**2)
    c, s = np.cos(swings * x), np.sin(swings * x) / swings
    on = np.array([[c - DAMPING * s, -s], [s, c + DAMPING * s]])
    return np.exp(-DAMPING * x)[:, :, None, None] * np.moveaxis(on, (0, 1), (2, 3))


def fresh(carried: np.ndarray) -> np.ndarray:
    """(N, 3, 2, 2) the share of their covariance that is new after a step, so that they stay as strong as they are."""
    return np.eye(2) - carried @ carried.transpose(0, 1, 3, 2)


def variance(track: Track) -> np.ndarray:
    """(N, 3) of the accelerations that waves give her [m2/s4, m2/s4, rad2/s4]."""
    return np.zeros((len(track), 3)) if track.swell is None else np.square(track.swell[:, 3:])


def in_system(F: np.ndarray, carried: np.ndarray) -> np.ndarray:
    """(N, 17, 17) what takes the ship (N, 11, 11) and the waves one step on: they push her as what is slow does."""
    out = np.zeros((len(F), AT_SEA, AT_SEA))
    out[:, :STATES, :STATES], out[:, :STATES, WAVE] = F, F[:, :, SLOW]
    out[:, SLOW, WAVE] = 0.0
    for i, a in enumerate((WAVE, CARRIER)):
        for j, b in enumerate((WAVE, CARRIER)):
            out[:, a, b] = np.eye(3) * carried[:, :, i, j, None]
    return out


def in_reader(H: np.ndarray) -> np.ndarray:
    """(N, 8, 17) the same readings: no instrument shows a wave by itself."""
    return np.pad(H, ((0, 0), (0, 0), (0, AT_SEA - STATES)))

"""Waves as states of the filter: of surge, sway and yaw each an acceleration in a narrow band, beside what is
slow.

    p' = -2 zeta omega_1 p - omega_1 q + noise,   q' = omega_1 p
    w' = -2 zeta omega_2 w - omega_2 o + omega p, o' = omega_2 w
    omega_1, omega_2 = omega (1 -+ RESONANCE_OFFSET)

Two resonances, one behind the other: the spectrum of w falls off with frequency to the fourth towards omega =
0, as no wave pushes for long, and what it does slower than the waves is seen as well as in calm water. (w,
o, p, q) are in units in which w has variance one and omega, so that frequency and size (`Track.swell`, seen
in `seaway.py`) may change from step to step.
Source: Fossen (2021) Handbook of Marine Craft, sec. 10.2 and 13.2.
"""

from dataclasses import replace

import numpy as np
from scipy.linalg import solve_continuous_lyapunov

from twin.study.track.track import Track

DAMPING = 0.1  # zeta: how broad a band waves swing it in
RESONANCE_OFFSET = 0.1  # of the resonances from the middle of the band, as a share of its frequency


def _band() -> tuple[np.ndarray, np.ndarray]:
    """(4, 4) rate of (w, o, p, q) per omega, and (4, 4) its covariance as long as waves last, w having
    variance one."""
    first, second = 1.0 - RESONANCE_OFFSET, 1.0 + RESONANCE_OFFSET
    rate = np.zeros((4, 4))
    rate[0], rate[1, 0] = (-2.0 * DAMPING * second, -second, 1.0, 0.0), second
    rate[2, 2:], rate[3, 2] = (-2.0 * DAMPING * first, -first), first
    lasting = solve_continuous_lyapunov(rate, -np.diag([0.0, 0.0, 1.0, 0.0]))
    return rate, lasting / lasting[0, 0]


RATE, LASTING = _band()
TONES, SHAPES = np.linalg.eig(RATE)


def as_shown(track: Track, shown: np.ndarray) -> Track:
    """The track with waves as strong as a log must have met them that shows so much more of everything,
    `shown` (N, 8, 8), dimensionless: how strong a sea is was only seen, and taken for more (seaway.py); a
    log that shows less is not likelier because it shows less of that."""
    if track.swell is None:
        return track
    return replace(
        track,
        swell=track.swell
        / np.column_stack([np.ones((len(track), 3)), shown[:, 6, 6], shown[:, 7, 7], np.ones(len(track))]),
    )


def carried(track: Track) -> np.ndarray:
    """(N, 3, 4, 4) what takes the waves of each axis one step on."""
    x = track.h * (np.zeros((len(track), 3)) if track.swell is None else track.swell[:, :3])
    return ((SHAPES * np.exp(x[:, :, None, None] * TONES)) @ np.linalg.inv(SHAPES)).real


def swinging(track: Track) -> np.ndarray:
    """(N, 12, 12) the same of all axes together."""
    return _together(carried(track))


def renewed(track: Track) -> np.ndarray:
    """(N, 12, 12) what of the waves' covariance is new after a step, so that they stay as strong as they
    are."""
    by = carried(track)
    return _together((LASTING - by @ LASTING @ np.swapaxes(by, -1, -2)) * variance(track)[:, :, None, None])


def lasting(track: Track) -> np.ndarray:
    """(N, 12, 12) their covariance."""
    return _together(LASTING * variance(track)[:, :, None, None])


def variance(track: Track) -> np.ndarray:
    """(N, 3) of the accelerations that waves give it [m2/s4, m2/s4, rad2/s4]."""
    return np.zeros((len(track), 3)) if track.swell is None else np.square(track.swell[:, 3:])


def _together(by_axis: np.ndarray) -> np.ndarray:
    """(N, 3, 4, 4) of each axis as (N, 12, 12): w of all axes, o of all axes, p, q."""
    out = np.zeros((len(by_axis), 4, 3, 4, 3))
    for axis in range(3):
        out[:, :, axis, :, axis] = by_axis[:, axis]
    return out.reshape(-1, 12, 12)

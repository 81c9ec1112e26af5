"""Whether a recorded velocity was measured, or is a slope of the recorded position, as a model basin's
cameras write it: then it holds the same scatter, and is no second reading.

A slope that software takes of positions is one filter, the same for both axes and at every time,

    V_k = sum_j w_j x_{k+j},   sum_j w_j = 0,   sum_j w_j j h = 1

and what least squares leave of it is only what rounding makes. Positions whose own scatter is sd_x, each for
itself, tell of a velocity that was measured by something else no better than to sd_x sqrt(sum w^2), whatever
the weights. So the share of its scatter that is the position's,

    1 - (variance that is left) / (sd_x^2 sum w^2),

is near one for a slope and not above zero for a reading.
"""

from collections.abc import Mapping
from math import comb

import numpy as np

from twin.recording.frames import earth_from_body
from twin.recording.mapping import FRAMED

WIDEST = 64  # samples to either side that a slope may be taken of
ROWS = 2000  # of each axis that are asked; more say nothing more
OF_THE_POSITION = 0.5  # of its scatter: more is the position's than its own
ORDER = 8  # of the differences that show the positions' own scatter, comb(2 k, k) times its variance
EXACT = 0.1  # by which the weights may make more or less than a slope; knots would make twice as much
SCATTER = 1.4826  # standard deviation over median absolute deviation, of a normal distribution


def no_second_reading(
    time_s: np.ndarray, columns: Mapping[str, np.ndarray], derived: Mapping[str, str]
) -> dict[str, str]:
    """The recorded velocities that are slopes of the recorded position, and in words what they are; empty
    where they were measured, or where that cannot be told. `time_s` and columns (N,), each in the unit in
    its name; `derived`: what was derived when the file was read."""
    named = ("north_m", "east_m", *FRAMED, "heading_true_north_deg")
    if not set(named) <= set(columns) or not set(named[:4]).isdisjoint(derived):
        return {}
    north, east, ahead, aside, psi = (columns[name] for name in named)
    table = np.column_stack([north, east, *earth_from_body(ahead, aside, np.radians(psi))])
    there = np.isfinite(table).all(axis=1)
    place, velocity = table[there, :2], table[there, 2:]
    half = min(WIDEST, len(place) // 8)
    if half < 2:
        return {}
    step_s = float(np.median(np.diff(time_s[there])))
    if position_share(place, velocity, half, step_s) < OF_THE_POSITION or is_a_sum(place, velocity):
        return {}
    return dict.fromkeys(FRAMED, "as recorded, a slope of the recorded position: no second reading")


def is_a_sum(place: np.ndarray, velocity: np.ndarray) -> bool:
    """Whether the position (N, 2) [m] goes from sample to sample as the velocity (N, 2) [m/s] at these two
    says, nearer than its own scatter lets it: then it may be the sum of what the velocity measured."""
    ways = np.concatenate(np.diff(place, axis=0).T)
    at_both = np.column_stack([np.concatenate(velocity[:-1].T), np.concatenate(velocity[1:].T)])
    left = np.mean((ways - at_both @ np.linalg.lstsq(at_both, ways, rcond=None)[0]) ** 2)
    return bool(left < OF_THE_POSITION * 2.0 * own_variance(place))


def own_variance(place: np.ndarray) -> float:
    """That of the scatter of each position (N, 2) [m] for itself [m2]: of a smooth path no difference of so
    high an order is left."""
    rough = np.diff(place, ORDER, axis=0)
    return float((SCATTER * np.median(np.abs(rough))) ** 2 / comb(2 * ORDER, ORDER))


def position_share(place: np.ndarray, velocity: np.ndarray, half: int, step_s: float) -> float:
    """Of the scatter of a velocity (N, 2) [m/s] the share that is that of the positions (N, 2) [m], a step
    [s] apart, within `half` samples to either side; none where it is no slope, but so many times one."""
    at = np.unique(np.linspace(half, len(place) - half - 1, ROWS).astype(int))
    beside = np.r_[-half:0, 1 : half + 1]
    apart = np.concatenate([x[at[:, None] + beside] - x[at, None] for x in place.T])
    shown = np.concatenate([v[at] for v in velocity.T])
    weights = np.linalg.lstsq(apart, shown, rcond=None)[0]
    if abs(float(weights @ beside) * step_s - 1.0) > EXACT:
        return 0.0
    left = np.sum((shown - apart @ weights) ** 2) / (shown.size - weights.size)
    passed = own_variance(place) * (weights @ weights + weights.sum() ** 2)
    return float(1.0 - left / passed) if passed > 0.0 else 0.0

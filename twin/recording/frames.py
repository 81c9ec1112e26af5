"""Positions and velocities of a file brought to the chart and to the ship's own axes; what is missing is
derived.

north' = u cos psi - v sin psi        east' = u sin psi + v cos psi
"""

import numpy as np

from twin.live.signals.chart import Chart, RecentPlaces
from twin.live.signals.geodesy import datum
from twin.live.signals.sentinels import is_no_position

SMOOTH_S = 2.0  # a derivative is the slope of the line through this much time


def chart(
    latitude_deg: np.ndarray, longitude_deg: np.ndarray
) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """(north_m, east_m, datum) on a chart that begins at the first position that there is on the earth, and
    goes along with the ship; NaN without a position. All (N,): [deg] in, [m] out."""
    places = list(zip(latitude_deg.tolist(), longitude_deg.tolist(), strict=True))
    good = [abs(a) <= 90.0 and -180.0 <= b <= 360.0 and not is_no_position(a, b) for a, b in places]
    if not any(good):
        nothing = np.full(latitude_deg.shape, np.nan)
        return nothing, nothing.copy(), {}
    first = places[good.index(True)]
    plane, recent, points = Chart(datum(*first)), RecentPlaces(), []
    for place, ok in zip(places, good, strict=True):
        point = plane.place(*place) if ok else None
        points.append(point or (np.nan, np.nan))
        if point:
            plane = recent.carry(plane, point)
    north, east = np.array(points).T
    return north, east, {"latitude_deg": first[0], "longitude_deg": first[1]}


def from_ddmm(values: np.ndarray) -> np.ndarray:
    """Degrees from NMEA's ddmm.mmm. (N,) [deg]."""
    degrees = np.trunc(values / 100.0)
    return degrees + (values - 100.0 * degrees) / 60.0


def body_from_earth(north: np.ndarray, east: np.ndarray, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(ahead, to starboard) of an earth-fixed velocity; psi in radians. All (N,), velocities in one unit."""
    c, s = np.cos(psi), np.sin(psi)
    return north * c + east * s, east * c - north * s


def earth_from_body(u: np.ndarray, v: np.ndarray, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(north, east) of a velocity in the ship's axes; psi in radians. All (N,), velocities in one unit."""
    c, s = np.cos(psi), np.sin(psi)
    return u * c - v * s, u * s + v * c


def integral(time_s: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """From the first sample, by trapezes; over missing samples by a line, and NaN at them. (N,) in the
    unit of `rate` (N,) times s."""
    there = np.isfinite(rate)
    if not there.any():
        return np.full(rate.shape, np.nan)
    full = np.interp(time_s, time_s[there], rate[there])
    steps = np.diff(time_s) * (full[1:] + full[:-1]) / 2.0
    return np.where(there, np.r_[0.0, np.cumsum(steps)], np.nan)


def slope(time_s: np.ndarray, values: np.ndarray, width_s: float = SMOOTH_S) -> np.ndarray:
    """d(values)/dt: mean of the half `width_s` [s] ahead less that of the half behind, by their distance.
    All (N,)."""
    there = np.isfinite(values)
    out = np.full(values.shape, np.nan)
    if np.count_nonzero(there) < 2:
        return out
    t, x = time_s[there] - time_s[there][0], values[there] - values[there][0]
    k = np.arange(t.size)
    low = np.minimum(np.searchsorted(t, t - width_s / 2.0), np.maximum(k - 1, 0))
    high = np.maximum(np.searchsorted(t, t + width_s / 2.0, side="right"), np.minimum(k + 2, t.size))

    def halves_apart(y: np.ndarray) -> np.ndarray:
        sums = np.r_[0.0, np.cumsum(y)]
        return (sums[high] - sums[k]) / (high - k) - (sums[k + 1] - sums[low]) / (k + 1 - low)

    with np.errstate(invalid="ignore", divide="ignore"):
        out[there] = halves_apart(x) / halves_apart(t)
    out[~np.isfinite(out)] = np.nan
    return out

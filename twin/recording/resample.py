"""Honest resampling: a mean where samples are many, a line where they are few, NaN where there are none."""

import numpy as np

USUAL_WAITS = 1.5  # usual times between two samples, up to which the wait of a slow log is no hole


def continuous(values: np.ndarray, period: float) -> np.ndarray:
    """An angle without its jumps (period > 0): each sample on the turn nearest to the last one measured.
    (N,), in the unit of the period."""
    if period <= 0.0:
        return values
    out = np.array(values, dtype=float)
    there = np.isfinite(out)
    out[there] = np.unwrap(out[there], period=period)
    return out


def wrapped(values: np.ndarray, period: float) -> np.ndarray:
    """Back to [0, period); numbers on the line (period 0) as they are. (N,), in the unit of the period."""
    return np.mod(values, period) if period > 0.0 else values


def resampled(
    time_s: np.ndarray, values: np.ndarray, grid: np.ndarray, step_s: float, max_gap_s: float, hold_s: float
) -> np.ndarray:
    """`values` at `time_s` brought to the times `grid` (a multiple of `step_s` from grid[0]).

    Samples within half a step are averaged, and the mean stands at the mean of their times, so that a
    moving quantity is not shifted; the first and the last sample stand for themselves. Between two of
    these points a line, unless they are more than `max_gap_s` apart. Outside: the end's value for
    `hold_s`, then NaN. `time_s` and `values` (N,), `grid` and the result (M,); values in their own unit."""
    there = np.isfinite(values)
    if not there.any():
        return np.full(grid.shape, np.nan)
    t, x = nodes(time_s[there], values[there], grid[0], step_s)
    out = np.interp(grid, t, x)
    return np.where(reachable(grid, t, max_gap_s, hold_s, 1e-6 * step_s), out, np.nan)


def beside(
    time_s: np.ndarray, values: np.ndarray, rows: np.ndarray, max_gap_s: float, period: float = 0.0
) -> np.ndarray:
    """`values` with a number in these `rows` (bool) too, from a line between its own neighbours no more than
    `max_gap_s` apart (or USUAL_WAITS, if that is longer).

    For two quantities that belong together and were logged in rows of their own; where both stand in one
    row nothing is made up. All (N,), in the values' own unit."""
    there = np.isfinite(values) & np.isfinite(time_s)
    fill = rows & ~there & np.isfinite(time_s)
    if not there.any() or not fill.any():
        return values
    order = np.argsort(time_s[there], kind="stable")
    t, x = time_s[there][order], continuous(values[there][order], period)
    out = np.array(values, dtype=float)
    usual_s = float(np.median(np.diff(t))) if t.size > 1 else 0.0
    near = reachable(time_s[fill], t, max(max_gap_s, USUAL_WAITS * usual_s), 0.0, 0.0)
    out[fill] = np.where(near, np.interp(time_s[fill], t, x), np.nan)
    return out


def nodes(t: np.ndarray, x: np.ndarray, start: float, step_s: float) -> tuple[np.ndarray, np.ndarray]:
    """(times, values): each step's mean at the mean of its times, and both ends as they are. `t` and `x`
    (N,) in, (M,) out; values in their own unit."""
    cell = np.floor((t - start) / step_s + 0.5).astype(np.int64)
    first = np.flatnonzero(np.r_[True, np.diff(cell) != 0])
    count = np.diff(np.r_[first, t.size])
    mean_t, mean_x = np.add.reduceat(t, first) / count, np.add.reduceat(x, first) / count
    inner = (mean_t > t[0]) & (mean_t < t[-1])
    last = t.size if t[-1] == t[0] else t.size - 1  # a single sample is both ends at once
    return np.r_[t[0], mean_t[inner], t[last:]], np.r_[x[0], mean_x[inner], x[last:]]


def reachable(grid: np.ndarray, t: np.ndarray, max_gap_s: float, hold_s: float, near_s: float) -> np.ndarray:
    """True where a grid time lies on a point, in a short gap, or beside an end that may be held. `grid`
    and the mask (M,), `t` (N,) [s]."""
    right = np.searchsorted(t, grid, side="left").clip(0, t.size - 1)
    left = (np.searchsorted(t, grid, side="right") - 1).clip(0, t.size - 1)
    outside = np.maximum(t[0] - grid, grid - t[-1])
    on_a_point = np.minimum(np.abs(grid - t[left]), np.abs(grid - t[right])) <= near_s
    return on_a_point | np.where(outside > 0.0, outside <= hold_s, t[right] - t[left] <= max_gap_s)

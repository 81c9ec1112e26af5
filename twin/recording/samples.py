"""Single samples that are not measurements: blanked, counted, and said with their line; never repaired."""

import numpy as np

from twin.live.signals.channels import BY_NAME
from twin.live.signals.sentinels import CODES, GENERIC, IN_RANGE_TOO
from twin.num import as_given
from twin.recording.out_of_range import where_most_lie
from twin.recording.resample import continuous

LEAST_SAMPLES = 20  # samples, to know what is usual
USUAL_STEPS_SHARE = 0.97  # share of the steps from sample to sample that count as usual
FAR_M = 1e5  # positions farther from zero than this count from another origin (UTM)


def plausible(
    name: str, values: np.ndarray, lines: np.ndarray
) -> tuple[np.ndarray, list[str], tuple[float, float] | None]:
    """The samples a ship can measure (others NaN), a sentence for each kind that was blanked, and where most
    samples lie, if outside what a ship can have. All (N,), in the channel's unit."""
    ch, samples = BY_NAME[name], values
    not_available = sentinel(name, values)
    values = np.where(not_available, np.nan, values)
    with np.errstate(invalid="ignore"):
        if ch.wraps > 0.0:
            values = np.where(np.isfinite(values), np.mod(values, ch.wraps), np.nan)
        outside = ~np.isnan(values) & ~((values >= ch.low) & (values <= ch.high))
    notes = [f"{name}: {count(not_available, lines)} for 'not available'"] if not_available.any() else []
    if outside.any():
        i = int(np.flatnonzero(outside)[0])
        notes.append(
            f"{name}: {count(outside, lines)} outside [{as_given(ch.low)}, {as_given(ch.high)}], the first "
            f"{as_given(values[i])}: wrong unit?"
        )
    return np.where(outside, np.nan, values), notes, where_most_lie(samples, outside)


def sentinel(name: str, values: np.ndarray) -> np.ndarray:
    """True where a value is a known code for "not available"; the generic ones count only out of range,
    and none where the ship was about to read it anyway. Both (N,)."""
    ch = BY_NAME[name]
    with np.errstate(invalid="ignore"):
        out = ~((values >= ch.low) & (values <= ch.high)) & np.isin(values, GENERIC)
        for code in CODES.get(name, ()):
            out |= np.abs(values - code) <= abs(code) * IN_RANGE_TOO
    return np.asarray(out) & ~_on_the_way(values, np.asarray(out))


def _on_the_way(values: np.ndarray, codes: np.ndarray) -> np.ndarray:
    """True where a value lies no more than three usual steps from the last or the next that is no code."""
    at = np.flatnonzero(np.isfinite(values) & ~codes)
    if at.size < LEAST_SAMPLES or not codes.any():
        return np.zeros(values.shape, bool)
    usual = 3.0 * float(np.quantile(np.abs(np.diff(values[at])), USUAL_STEPS_SHARE))
    after = np.searchsorted(at, np.arange(values.size))
    sides = (values[at[np.maximum(after - 1, 0)]], values[at[np.minimum(after, at.size - 1)]])
    with np.errstate(invalid="ignore"):
        return np.asarray(np.minimum(*(np.abs(values - side) for side in sides)) <= usual)


def count(bad: np.ndarray, lines: np.ndarray) -> str:
    """'12 samples blanked (first in line 240)'. Both (N,): `bad` a mask, `lines` the numbers of the file's
    lines."""
    n = int(np.count_nonzero(bad))
    return f"{n} sample{'s' * (n > 1)} blanked (first in line {lines[int(np.flatnonzero(bad)[0])]})"


def from_zero(name: str, values: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Positions of a far grid (UTM) counted from their first sample instead. (N,) [m]."""
    there = values[np.isfinite(values)]
    if not there.size or abs(there[0]) < FAR_M:
        return values, []
    return values - there[0], [
        f"{name}: counted from its first sample, {there[0]:.3f} m (a map grid's numbers)"
    ]


def spikes(values: np.ndarray, period: float = 0.0) -> np.ndarray:
    """Places where one or two samples leave the line and come back, as a sensor does and a ship does not.

    Away from the median of five by more than 10 sigma, by more than 6 usual steps from sample to sample
    (97 of 100 are smaller; a wave that is sampled coarsely has large ones), and by more than five steps of
    the sensor's resolution. Of (N,) samples in their own unit, an index (K,)."""
    at = np.flatnonzero(np.isfinite(values))
    if at.size < LEAST_SAMPLES:
        return at[:0]
    x = continuous(values[at], period)
    middle = np.median(np.lib.stride_tricks.sliding_window_view(np.pad(x, 2, mode="edge"), 5), axis=1)
    away = np.abs(x - middle)
    limit = max(
        10.0 * 1.4826 * np.median(away), 6.0 * np.quantile(np.abs(np.diff(x)), 0.97), 5.0 * resolution(x)
    )
    return at[away > limit] if limit > 0.0 else at[:0]


def resolution(x: np.ndarray) -> float:
    """The smallest step between two different samples (N,), in the unit of the samples; 0 when there is
    only one value."""
    steps = np.diff(np.unique(x))
    steps = steps[steps > 1e-9 * max(float(np.abs(x).max()), 1e-12)]
    return float(steps.min()) if steps.size else 0.0

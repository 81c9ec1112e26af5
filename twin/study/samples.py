"""Single samples that are not measurements: blanked, counted, and said with their line; never repaired."""

import numpy as np

from twin.live.channels import BY_NAME
from twin.live.sentinels import CODES, GENERIC, IN_RANGE_TOO

FAR_M = 1e5  # positions farther from zero than this count from another origin (UTM)


def plausible(name: str, values: np.ndarray, lines: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """The samples a ship can measure (others NaN), and a sentence for each kind that was blanked."""
    ch = BY_NAME[name]
    not_available = sentinel(name, values)
    values = np.where(not_available, np.nan, values)
    if ch.wraps > 0.0:
        values = np.where(np.isfinite(values), np.mod(values, ch.wraps), np.nan)
    with np.errstate(invalid="ignore"):
        outside = ~np.isnan(values) & ~((values >= ch.low) & (values <= ch.high))
    notes = [f"{name}: {count(not_available, lines)} for 'not available'"] if not_available.any() else []
    if outside.any():
        i = int(np.flatnonzero(outside)[0])
        notes.append(
            f"{name}: {count(outside, lines)} outside [{ch.low:g}, {ch.high:g}], the first {values[i]:g}: wrong unit?"
        )
    return np.where(outside, np.nan, values), notes


def sentinel(name: str, values: np.ndarray) -> np.ndarray:
    """True where a value is a known code for "not available"; the generic ones count only out of range."""
    ch = BY_NAME[name]
    with np.errstate(invalid="ignore"):
        out = ~((values >= ch.low) & (values <= ch.high)) & np.isin(values, GENERIC)
        for code in CODES[name]:
            out |= np.abs(values - code) <= abs(code) * IN_RANGE_TOO
    return np.asarray(out)


def count(bad: np.ndarray, lines: np.ndarray) -> str:
    """'12 samples blanked (first in line 240)'."""
    n = int(np.count_nonzero(bad))
    return f"{n} sample{'s' * (n > 1)} blanked (first in line {lines[int(np.flatnonzero(bad)[0])]})"


def from_zero(name: str, values: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Positions of a far grid (UTM) counted from their first sample instead."""
    there = values[np.isfinite(values)]
    if not there.size or abs(there[0]) < FAR_M:
        return values, []
    return values - there[0], [f"{name}: counted from its first sample, {there[0]:.3f} m (a map grid's numbers)"]


def spikes(values: np.ndarray, period: float = 0.0) -> np.ndarray:
    """Places where one or two samples leave the line and come back: more than 10 sigma and 1/5 of the usual range."""
    from twin.study.resample import continuous

    at = np.flatnonzero(np.isfinite(values))
    if at.size < 7:
        return at[:0]
    x = continuous(values[at], period)
    padded = np.pad(x, 2, mode="edge")
    middle = np.median(np.lib.stride_tricks.sliding_window_view(padded, 5), axis=1)
    away = np.abs(x - middle)
    sigma = 1.4826 * np.median(away)
    usual = np.subtract(*np.percentile(x, (95, 5)))
    quantum = np.diff(np.unique(x)).min(initial=np.inf)
    limit = max(10.0 * sigma, 0.2 * usual, 5.0 * quantum if np.isfinite(quantum) else 0.0)
    return at[away > limit] if limit > 0.0 else at[:0]

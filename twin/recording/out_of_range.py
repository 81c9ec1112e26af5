"""A channel of which most samples are none that a ship can have: where they lie, and what the map needs."""

import numpy as np

from twin.live.signals.channels import BY_NAME
from twin.num import as_given
from twin.recording.units import UNITS, unit_of

MOST_SHARE = 0.5  # share of a channel's samples, above which they are no mistakes of single samples
OF_FULL_PITCH = " and factor = pitch over diameter at full pitch, if it is per cent of full pitch"


def where_most_lie(samples: np.ndarray, outside: np.ndarray) -> tuple[float, float] | None:
    """The lowest and the highest of the samples that are `outside`, if these are most; None if not. All
    (N,), the samples in the channel's unit, NaN where there is none."""
    if np.count_nonzero(outside) <= MOST_SHARE * np.count_nonzero(~np.isnan(samples)):
        return None
    return float(np.min(samples[outside])), float(np.max(samples[outside]))


def out_of_range_in_words(name: str, lie: tuple[float, float], unit: str | None) -> str:
    """The sentence of such a channel: where its samples `lie`, in its own unit, and what the map needs
    instead of the `unit` that it gives (None: none)."""
    ch, (low, high) = BY_NAME[name], lie
    can = f"{as_given(ch.low)} to {as_given(ch.high)}"
    return (
        f"{name}: {as_given(low, 3)} to {as_given(high, 3)} in most rows, where only {can} can be. "
        f"In the map: {_entry(name, low, high, unit)}."
    )


def _entry(name: str, low: float, high: float, unit: str | None) -> str:
    """The unit that brings all into what can be, and changes them least; else what to look for."""
    ch, units = BY_NAME[name], UNITS[unit_of(name)]
    given = units.get(unit or "", 1.0)
    fits = [u for u, k in units.items() if ch.low <= low * k / given and high * k / given <= ch.high]
    if not fits:
        return "another unit or factor, or the right column"
    return f'unit = "{max(fits, key=units.__getitem__)}"{OF_FULL_PITCH * name.endswith(".pitch_ratio")}'

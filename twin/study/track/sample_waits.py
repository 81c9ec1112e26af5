"""How long a voyage waits between two samples of a channel. Rows tell that of a table only: where
instruments with clocks of their own were merged, rows stand closer than the samples of any of them."""

from collections.abc import Iterator, Sequence

import numpy as np

from twin.recording.voyage import Voyage

LONGEST_HOLD_S = 5.0  # a control that is missing for longer breaks the track


def shortest_wait_s(voyage: Voyage, names: Sequence[str]) -> float:
    """The usual wait (median) for the next sample of that of these channels which is read most often [s];
    that for the next row where none of them has two samples."""
    return min(_usual_waits_s(voyage, names), default=voyage.step_s)


def hold_s_of(voyage: Voyage, name: str) -> float:
    """How long a control's last value is held [s]: through short holes, or for the usual wait for the next
    sample."""
    return max([LONGEST_HOLD_S, *(1.5 * wait for wait in _usual_waits_s(voyage, (name,)))])


def _usual_waits_s(voyage: Voyage, names: Sequence[str]) -> Iterator[float]:
    """Of each channel that has two samples."""
    for name in names:
        at = voyage.time_s[np.isfinite(voyage[name])]
        if at.size > 1:
            yield float(np.median(np.diff(at)))

"""Predictions against what the instruments measured, at the instruments' own time: never against the twin's
own estimate, which shares the receiver's lag.

A place or heading of the moment that a prediction named lies on the line between the two samples around it.
"""

from collections import deque
from math import atan2, cos, sin
from typing import NamedTuple

from twin.live.observer.predict import Region
from twin.live.prediction.circumstances import Regressors
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured

APART_S = 2.5  # samples farther apart show no moment between them
PATIENCE_S = 4.0  # a sample that comes later than that is not waited for


class Foretold(NamedTuple):
    """A prediction that waits for its time: eta and nu said at `said_s` for `due_s`, from the helm as it was
    at `start_s`; what was known then, and the region said with it (None: none was)."""

    start_s: float
    said_s: float
    due_s: float
    state: tuple[float, ...]
    known: Regressors
    region: Region | None = None


class VerifiedPrediction(NamedTuple):
    """One that came due: its error along and across the predicted track [m] and in heading [rad], and whether
    helm and engine were held."""

    foretold: Foretold
    along: float
    across: float
    heading: float
    held: bool


class Samples:
    """The last few samples of one instrument, by its own time."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, tuple[float, ...]]] = deque(maxlen=32)

    def add(self, time_s: float, values: tuple[float, ...]) -> None:
        """A sample at `time_s` [s]; one that is not newer than the last is left out."""
        if not self._seen or time_s > self._seen[-1][0]:
            self._seen.append((time_s, values))

    def covers(self, time_s: float) -> bool:
        """Whether a sample of this time or later has come."""
        return bool(self._seen) and self._seen[-1][0] >= time_s

    def at(self, time_s: float, angle: bool = False) -> tuple[float, ...] | None:
        """The value on the line between the samples around it; None where they are too far apart or gone."""
        after = None
        for sample in reversed(self._seen):
            if sample[0] <= time_s:
                if after is None or after[0] - sample[0] > APART_S:
                    return sample[1] if sample[0] == time_s else None
                share = (time_s - sample[0]) / (after[0] - sample[0])
                gaps = [b - a for a, b in zip(sample[1], after[1], strict=True)]
                gaps = [turn(gap) for gap in gaps] if angle else gaps
                return tuple([a + share * gap for a, gap in zip(sample[1], gaps, strict=True)])
            after = sample
        return None


class Judge:
    """`hear` each tick, `ask` of each prediction that waits."""

    def __init__(self) -> None:
        self._place, self._heading = Samples(), Samples()

    def hear(self, measured: Measured) -> None:
        """Note what was measured, at its own time."""
        fresh, si = measured.fresh, measured.si
        if "x" in fresh and "x" in si and "y" in si:
            self._place.add(measured.time["x"], (si["x"], si["y"]))
        if "psi" in fresh and "psi" in si and "psi" not in measured.derived:
            self._heading.add(measured.time["psi"], (si["psi"],))

    def ask(self, f: Foretold, now_s: float, moved_s: float) -> VerifiedPrediction | bool | None:
        """The judgement; False while it has to wait, None where no instrument showed that moment. `moved_s`:
        when helm or engine last moved."""
        if now_s < f.due_s:
            return False
        if not (self._place.covers(f.due_s) and self._heading.covers(f.due_s)):
            return None if now_s > f.due_s + PATIENCE_S else False
        place, heading = self._place.at(f.due_s), self._heading.at(f.due_s, angle=True)
        if place is None or heading is None:
            return None
        along, across = along_and_across(f.state, place)
        return VerifiedPrediction(f, along, across, turn(f.state[2] - heading[0]), moved_s <= f.start_s)


def course(state: tuple[float, ...]) -> float:
    """Of a predicted eta and nu: where the ship then goes over ground [rad]."""
    return state[2] + atan2(state[4], state[3])


def along_and_across(state: tuple[float, ...], place: tuple[float, ...]) -> tuple[float, float]:
    """How far a predicted place is ahead and to starboard of the true one, along the predicted course [m]."""
    c, s = cos(course(state)), sin(course(state))
    north, east = state[0] - place[0], state[1] - place[1]
    return north * c + east * s, east * c - north * s

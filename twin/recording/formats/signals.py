"""What a log holds: one series for each quantity of each source, with its own stamps, not yet chosen from.

A series' `quantity` is a channel of the twin, one of EXTRA (which a channel follows from), or "" for a number
whose meaning the format does not state. Values come in the unit that the quantity's name ends with.
"""

from array import array
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from twin.errors import DataError
from twin.live.signals.channels import BY_NAME
from twin.num import as_given

PLACE = ("latitude_deg", "longitude_deg")
COURSE = ("speed_over_ground_mps", "course_over_ground_deg")
EARTH = ("velocity_north_mps", "velocity_east_mps")
BODY = ("surge_velocity_mps", "sway_velocity_mps")
EXTRA = (
    *PLACE,
    *COURSE,
    *EARTH,
    "heading_magnetic_deg",
    "magnetic_variation_deg",
    "engine_rate_rpm",
    "propeller_pitch_pct",
    "true_wind_angle_deg",
)
QUANTITIES = frozenset((*BY_NAME, *EXTRA))
BACK_S = 5.0  # stamps may step back by this much: messages overtake each other on the way to the recorder


@dataclass
class Series:
    """Samples of one quantity from one source: `times` [s], `values` in the quantity's unit."""

    name: str
    source: str
    quantity: str
    rank: int = 0  # among series of one quantity and source: the lower, the sooner it is taken
    times: array = field(default_factory=lambda: array("d"))
    values: array = field(default_factory=lambda: array("d"))

    def __len__(self) -> int:
        return len(self.times)

    def add(self, time_s: float, value: float) -> None:
        """One more sample."""
        self.times.append(time_s)
        self.values.append(value)

    def arrays(self) -> tuple[np.ndarray, np.ndarray]:
        """(stamps (N,) [s] in order, values (N,)): a stamp that comes twice keeps its last sample."""
        t, x = np.frombuffer(self.times), np.frombuffer(self.values)
        good = np.isfinite(t) & np.isfinite(x)
        t, x = t[good], x[good]
        if t.size > 1 and not (np.diff(t) > 0.0).all():
            order = np.argsort(t, kind="stable")
            t, x = t[order], x[order]
            last = np.r_[np.diff(t) > 0.0, True]
            t, x = t[last], x[last]
        return t, x


class Signals:
    """All series of one log; `says` is what the format calls it, `skipped` counts what was not used and
    why."""

    def __init__(self, path: Path, says: str):
        self.path, self.says = path, says
        self.series: dict[str, Series] = {}
        self.skipped: Counter[str] = Counter()
        self.notes: list[str] = []
        self.settings: dict[str, dict[str, float]] = {}  # by series: what the vessel's settings say of it
        self._latest = -np.inf

    def of(self, name: str, source: str, quantity: str = "", rank: int = 0) -> Series:
        """The series of that name, begun when it is new."""
        found = self.series.get(name)
        if found is None:
            found = self.series[name] = Series(name, source, quantity, rank)
        return found

    def put(self, name: str, source: str, quantity: str, time_s: float, value: float, rank: int = 0) -> None:
        """One sample; the series is begun when it is new."""
        found = self.series.get(name)
        if found is None:
            found = self.series[name] = Series(name, source, quantity, rank)
        found.times.append(time_s)
        found.values.append(value)

    def clock(self, time_s: float, line: int) -> None:
        """Tells the clock's reading in file order; DataError when it steps back by more than messages
        overtake."""
        if time_s < self._latest - BACK_S:
            back = self._latest - time_s
            raise DataError(
                f"{self.path}: line {line}: the clock steps back by {as_given(back, 6)} s{step_known(back)}. "
                "Two logs pasted together, or a clock that was set? Split the file there and import the "
                "parts."
            )
        self._latest = max(self._latest, time_s)

    def without_strays(self, farthest_s: float = 3.2e7, share: float = 0.01) -> None:
        """Leaves out the few samples whose stamps lie more than a year from the middle of all: what a
        damaged log was read as there. `farthest_s` [s]."""
        stamps = [np.frombuffer(s.times) for s in self.series.values() if len(s)]
        middle = float(np.median(np.concatenate(stamps))) if stamps else 0.0
        away = sum(int(np.count_nonzero(~(np.abs(t - middle) <= farthest_s))) for t in stamps)
        total = sum(t.size for t in stamps)
        del stamps  # a view keeps an array from being replaced
        if not 0 < away <= share * total:
            return
        for s in self.series.values():
            t, x = np.array(s.times), np.array(s.values)
            near = np.abs(t - middle) <= farthest_s
            s.times, s.values = array("d", t[near].tobytes()), array("d", x[near].tobytes())
        self.skipped["samples of another year"] += away

    def finish(self) -> "Signals":
        """The same, without empty series; DataError when nothing was found."""
        self.series = {name: s for name, s in self.series.items() if len(s)}
        if not self.series:
            why = "; ".join(f"{n} {what}" for what, n in self.skipped.most_common(3))
            raise DataError(
                f"{self.path}: this is {self.says}, and nothing in it can be used{': ' * bool(why)}{why}."
            )
        return self


STEPS_S = (
    (3600.0, "an hour"),
    (7200.0, "two hours"),
    (86400.0, "a day"),
    (604800.0, "a week"),
    (1024 * 604800.0, "1024 weeks, the GPS week counter"),
)


def step_known(seconds: float) -> str:
    """', an hour' when a step of the clock is one that clocks make, within a few seconds."""
    return next((f", {said}" for step, said in STEPS_S if abs(seconds - step) <= 5.0), "")

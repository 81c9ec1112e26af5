"""A voyage: what was measured on one stretch of sea, by the names and units of the table of channels.

A missing sample is NaN and stays NaN: nothing here invents a measurement.
"""

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from twin.errors import DataError, TwinError, did_you_mean
from twin.live.signals.channels import BY_NAME, CHANNELS, Channel, of_actuators
from twin.num import as_given, num
from twin.recording.finish import CONTROLS, finished
from twin.recording.headers import TIMES
from twin.recording.holes import HOLE_S, WAITS, sailed_s, steps_on
from twin.recording.raw import Raw
from twin.recording.resample import continuous, resampled, wrapped
from twin.recording.samples_of import raw_of

MOST_STEPS = 3e6  # of a grid
if TYPE_CHECKING:
    import pandas

SLOW_S = 60.0  # a channel that may be this old is a state of the sea or of the loading: its ends are held


@dataclass(frozen=True, repr=False, eq=False)
class Voyage:
    """Samples at `time_s` (N,) [s, increasing]; `columns`: (N,) float64 in the unit of the channel's name.

    `meta` says where it came from: `source`, `map`, `ship`, `datum` {latitude_deg, longitude_deg},
    `start_time_utc`, `derived` {column: how}, `out_of_range` {column: (lowest, highest)} where most samples
    were blanked. What is not known is not there.
    """

    name: str
    time_s: np.ndarray
    columns: Mapping[str, np.ndarray]
    meta: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, values in self.columns.items():
            if name not in BY_NAME:
                raise DataError(f"{self.name}: no channel is called {name!r}.{did_you_mean(name, BY_NAME)}")
            if values.shape != self.time_s.shape:
                raise DataError(
                    f"{self.name}: {name} has {values.size} samples, time_s has {self.time_s.size}."
                )

    @classmethod
    def of(cls, raw: Raw, controls: bool = True) -> "Voyage":
        """The voyage of a file's samples: what no ship can do is blanked, what is absent is derived.
        DataError when too little is there (`controls`: rudder and shaft must be)."""
        return cls(*finished(raw, controls))

    @classmethod
    def from_dataframe(cls, df: "pandas.DataFrame", name: str = "dataframe") -> "Voyage":
        """A voyage of a table whose columns are channels by name (`time_s` or `time_utc` among them,
        or `time_s` as its index).

        The same reading as of a file: what is absent is derived or said to be absent, what cannot be is
        blanked. DataError names a column that is no channel, and the nearest.
        """
        table = df if {*TIMES} & {*df.columns} else df.rename_axis("time_s").reset_index()
        for column in table.columns:
            if column not in TIMES:
                channel(str(column))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "dataframe.csv"
            table.to_csv(path, index=False, float_format="%.17g")
            try:
                made = cls.of(raw_of(path, None, {}))
            except TwinError as error:
                raise type(error)(str(error).replace(str(path), name)) from None
        return replace(made, name=name, meta={**made.meta, "source": name})

    def to_dataframe(self) -> "pandas.DataFrame":
        """Its samples as a table: the index is `time_s` [s], a column a channel in the unit of its name."""
        import pandas

        index = pandas.Index(self.time_s, name="time_s")
        return pandas.DataFrame({name: self.columns[name] for name in self.columns}, index=index)

    def __repr__(self) -> str:
        there = sum(self.has(name) for name in self.columns)
        return f"<Voyage {self.name!r}: {self.duration_s:.0f} s, {len(self)} samples of {there} channels>"

    def __len__(self) -> int:
        return int(self.time_s.size)

    def __getitem__(self, name: str) -> np.ndarray:
        """(N,) samples in the unit the name ends with; all NaN when the channel is absent."""
        channel(name)
        return self.columns[name] if name in self.columns else np.full(self.time_s.shape, np.nan)

    def has(self, *names: str) -> bool:
        """True when every named channel holds at least one sample."""
        return all(bool(np.isfinite(self[name]).any()) for name in names)

    def absent(self) -> tuple[str, ...]:
        """Channels of the table without a single sample, in the table's order; of a vessel with actuators not
        the one rudder and shaft."""
        others = CONTROLS if of_actuators(self.columns) else ()
        return tuple(c.name for c in CHANNELS if not self.has(c.name) and c.name not in others)

    @property
    def duration_s(self) -> float:
        """From first to last sample [s]."""
        return float(self.time_s[-1] - self.time_s[0]) if len(self) else 0.0

    @property
    def sailed_s(self) -> float:
        """The same, a hole without any row counted as no more than `hole_s` [s]."""
        return sailed_s(self.time_s, self.hole_s) if len(self) else 0.0

    @property
    def hole_s(self) -> float:
        """From how long without any row there is a hole [s]: never what is usual between two rows."""
        return max(HOLE_S, WAITS * self.step_s) if len(self) > 1 else HOLE_S

    @property
    def step_s(self) -> float:
        """The usual time between two samples (median) [s]; NaN with fewer than two."""
        return float(np.median(np.diff(self.time_s))) if len(self) > 1 else float("nan")

    def between(self, start_s: float, end_s: float) -> "Voyage":
        """The samples with start_s <= time < end_s; the clock is kept."""
        keep = (self.time_s >= start_s) & (self.time_s < end_s)
        return self.with_rows(self.time_s[keep], {name: x[keep] for name, x in self.columns.items()})

    def on_grid(self, step_s: float, max_gap_s: float | None = None, hole_s: float | None = None) -> "Voyage":
        """The same voyage every `step_s` [s]: means where samples are denser, lines where they are sparser.

        No line is drawn over a gap longer than `max_gap_s` (default: the channel's `stale_s`, or 1.5 steps
        if that is longer): there it stays NaN. Angles are averaged along the circle. Slow channels
        (`stale_s` of SLOW_S or more) keep their first and last value at the ends, for as long as they may
        be old. Of a hole without any row for longer than `hole_s` (default: its own) the grid keeps so
        much, and jumps over its middle. DataError: the step is not positive, there are no samples, or the
        grid would be too long."""
        if not step_s > 0 or not len(self):
            raise DataError(
                f"{self.name}: cannot be put on a grid of {as_given(step_s)} s with {len(self)} samples."
            )
        hole_s = self.hole_s if hole_s is None else hole_s
        if sailed_s(self.time_s, hole_s) / step_s > MOST_STEPS:
            raise DataError(
                f"{self.name}: {as_given(self.sailed_s, 4)} s are more than {MOST_STEPS:.0e} steps of "
                f"{num(step_s, 3)} s, in which this ship must be looked at; there are {len(self)} samples. "
                "Cut it into shorter voyages."
            )
        grid = self.time_s[0] + step_s * steps_on(self.time_s, step_s, hole_s)
        return self.with_rows(
            grid, {name: self._on(grid, step_s, BY_NAME[name], max_gap_s) for name in self.columns}
        )

    def _on(self, grid: np.ndarray, step_s: float, ch: Channel, max_gap_s: float | None) -> np.ndarray:
        limit = max(ch.stale_s if max_gap_s is None else max_gap_s, 1.5 * step_s)
        hold = ch.stale_s if ch.stale_s >= SLOW_S else 0.0
        values = continuous(self.columns[ch.name], ch.period)
        return wrapped(resampled(self.time_s, values, grid, step_s, limit, hold), ch.wraps)

    def si(self, name: str) -> np.ndarray:
        """(N,) in the units of physics (m, rad, m/s, rad/s, 1/s); angles that wrap come without jumps."""
        ch = channel(name)
        return continuous(self[name], ch.period) * ch.to_si

    def with_rows(self, time_s: np.ndarray, columns: Mapping[str, np.ndarray]) -> "Voyage":
        """The same voyage (name, meta) with other samples. All (N,), in the unit in its name."""
        return replace(self, time_s=time_s, columns=dict(columns))

    def with_meta(self, **facts: Any) -> "Voyage":
        """The same voyage that knows more of itself."""
        return replace(self, meta={**self.meta, **facts})


def channel(name: str) -> Channel:
    """The channel of that name, or a DataError that names the nearest."""
    if name not in BY_NAME:
        raise DataError(f"no channel is called {name!r}.{did_you_mean(name, BY_NAME)}")
    return BY_NAME[name]

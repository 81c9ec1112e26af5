"""A log as columns, for replay and for the study ashore: one array for each channel on one time base.

Wide records (`shiptwin.Row`, or what each `shiptwin.Tick` measured) are read as they are, by the schema the
log itself carries. A foreign log of Keelson scalars is put on the stamps of its most frequent channel of
position, heading or controls; between two samples of a channel the value is on the line between them, across
a gap it is NaN.
"""

from collections import Counter
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
from google.protobuf.message import DecodeError

from twin.errors import DataError
from twin.live.channels import BY_NAME
from twin.live.decode import Decoder, Result
from twin.live.mcap_read import McapReader
from twin.live.readings import WORDS, Reading
from twin.live.schema import classes_from_set
from twin.live.wire import double_columns

ROW, TICK = "shiptwin.Row", "shiptwin.Tick"
Columns = dict[str, np.ndarray]
Samples = dict[str, tuple[list[float], list[float]]]  # channel: (stamps [s], values)
LEADERS = (
    "north_m",
    "heading_true_north_deg",
    "rudder_angle_deg",
    "propeller_rate_rpm",
    "surge_velocity_mps",
)


def read_rows(path: str | Path, notes: list[str] | None = None) -> tuple[np.ndarray, Columns]:
    """(time_s (N,) [s], {channel: (N,) in border units}), NaN where nothing was measured.

    The time is the records' own: the voyage's clock for rows, UTC since 1970 for ticks (the monotonic clock
    put on the first wall time, so that a step of the wall clock does not show) and for scalars. What was
    damaged, refused or absent is said in `notes`.
    """
    reader = McapReader(path)
    found = Found(reader)
    for topic, type_name, data, _, _ in reader.messages():
        found.take(topic, type_name, data)
    time_s, columns = found.columns()
    if notes is not None:
        notes += reader.problems
        notes += [f"{count} left out: {why}" for why, count in found.refused.items()]
    return time_s, columns


class Found:
    """What a log holds: wide rows as bytes, their times, scalars by channel, and what was refused."""

    def __init__(self, reader: McapReader):
        self.refused: Counter[str] = Counter()
        self._reader = reader
        self._decoder = Decoder()
        self._wide: dict[str, list[bytes]] = {ROW: [], TICK: []}
        self._tick_times: list[float] = []
        self._samples: Samples = {}
        self._tick_class: Any = None
        self._wall_minus_time = 0.0

    def take(self, topic: str, type_name: str, data: bytes) -> None:
        if type_name == ROW:
            self._wide[ROW].append(data)
        elif type_name == TICK:
            self._tick(data)
        elif not (self._wide[ROW] or self._wide[TICK]):
            for result in self._decoder.decode_stripped(topic, data, 0.0):
                self._sample(result)

    def columns(self) -> tuple[np.ndarray, Columns]:
        """Rows if there are any, else what the ticks measured, else the scalars."""
        if self._wide[ROW]:
            columns, good = self._named(ROW)
            return columns.pop("time_s", np.zeros(int(good.sum()))), columns
        if self._wide[TICK]:
            columns, good = self._named(TICK)
            columns.pop("time_s", None)
            return np.array(self._tick_times)[good], columns
        if self._samples:
            return _on_one_base(self._samples)
        raise DataError(
            f"{self._reader.path}: no measurements in it: no {ROW}, no {TICK}, no Keelson subject we know."
        )

    def _named(self, type_name: str) -> tuple[Columns, np.ndarray]:
        """The wide records as columns, named by the log's own schema, and which records were good."""
        row_class = classes_from_set(self._reader.schemas[type_name], [ROW])[0]
        numbers, odd = double_columns(self._wide[type_name])
        if odd.any():
            self.refused[f"{type_name} that cannot be decoded"] += int(odd.sum())
        names = {field.number: field.name for field in row_class.DESCRIPTOR.fields}
        columns = {names[number]: values[~odd] for number, values in numbers.items() if number in names}
        if "time_s" in columns:  # protobuf leaves out a zero
            columns["time_s"] = np.nan_to_num(columns["time_s"])
        return columns, ~odd

    def _tick(self, data: bytes) -> None:
        if self._tick_class is None:
            self._tick_class = classes_from_set(self._reader.schemas[TICK], [TICK])[0]
        try:
            tick = self._tick_class.FromString(data)
        except DecodeError:
            self.refused[f"{TICK} that cannot be decoded"] += 1
            return
        if not self._tick_times:
            self._wall_minus_time = tick.wall_s - tick.time_s
        self._tick_times.append(tick.time_s + self._wall_minus_time)
        self._wide[TICK].append(tick.measured.SerializeToString())

    def _sample(self, result: Result) -> None:
        if isinstance(result, Reading):
            stamps, values = self._samples.setdefault(result.channel, ([], []))
            stamps.append(result.time_s)
            values.append(result.value)
        elif result.channel:
            self.refused[f"{result.channel}, {WORDS[result.quality]}"] += 1


def _on_one_base(samples: Samples) -> tuple[np.ndarray, Columns]:
    leaders = [name for name in LEADERS if name in samples] or list(samples)
    base = np.unique(samples[max(leaders, key=lambda name: len(samples[name][0]))][0])
    return base, {name: _along(base, name, *map(np.array, lists)) for name, lists in samples.items()}


def _along(base: np.ndarray, name: str, stamps: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values on the line between their neighbours; NaN outside and in gaps longer than `stale_s`."""
    channel = BY_NAME[name]
    stamps, first = np.unique(stamps, return_index=True)
    values = values[first]
    if channel.wraps:
        values = np.unwrap(values, period=channel.wraps)
    line = np.interp(base, stamps, values, left=nan, right=nan)
    after = np.clip(np.searchsorted(stamps, base), 1, max(stamps.size - 1, 1))
    if stamps.size > 1:
        line[(stamps[after] - stamps[after - 1] > channel.stale_s) & ~np.isin(base, stamps)] = nan
    return np.mod(line, channel.wraps) if channel.wraps else line

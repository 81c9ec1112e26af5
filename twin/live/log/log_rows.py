"""A log as columns, for replay and for the study ashore: one array for each channel on one time base.

Wide records (`shiptwin.Row`, or what each `shiptwin.Tick` measured) are read by the schema that the log
itself carries; a foreign log of Keelson scalars is put on one base (see `onebase`).
"""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from google.protobuf.message import DecodeError

from twin.errors import DataError
from twin.live.keelson.decode import Decoder, Result
from twin.live.keelson.messages import channel_name
from twin.live.keelson.schema import classes_from_set
from twin.live.keelson.topics import POSITION
from twin.live.keelson.wire import double_columns
from twin.live.log.mcap_read import McapReader
from twin.live.log.onebase import Columns, on_one_base, without_repeats
from twin.live.signals.channels import BY_NAME
from twin.live.signals.chart import RecentPlaces
from twin.live.signals.readings import WORDS, Reading

UNREADABLE = "that cannot be decoded"
OF_TICK = {"time_s": False, "wall_s": False, "measured": True, "age_s": True}  # is it a message?
ROW, TICK, AGES = "shiptwin.Row", "shiptwin.Tick", "shiptwin.Ages"


def read_rows(
    path: str | Path, notes: list[str] | None = None, lost: list[str] | None = None
) -> tuple[np.ndarray, Columns]:
    """(time_s (N,) [s], {channel: (N,) in border units}), NaN where nothing was measured.

    The time is the records' own: the voyage's clock for rows, UTC since 1970 for ticks (the monotonic clock
    put on the first wall time, so that a step of the wall clock does not show) and for scalars. What was
    refused or absent is said in `notes`, what was damaged in `lost` (in `notes`, too, when that is not
    given)."""
    reader = McapReader(path)
    found = LogRows(reader)
    for topic, type_name, data, _, _ in reader.messages():
        found.take(topic, type_name, data)
    time_s, columns = found.columns()
    said = [f"{count} left out: {why}" for why, count in found.refused.items()]
    damaged = [*reader.problems, *(text for text in said if text.endswith(UNREADABLE))]
    lost = notes if lost is None else lost
    if lost is not None:
        lost += damaged
    if notes is not None:
        notes += [text for text in said if text not in damaged]
    return time_s, columns


class LogRows:
    """What a log holds: wide records as bytes, scalars by channel, and what was refused."""

    def __init__(self, reader: McapReader):
        self.refused: Counter[str] = Counter()
        self._reader = reader
        self._decoder, self._recent = Decoder(), RecentPlaces()
        self._rows: list[bytes] = []
        self._ticks: list[bytes] = []
        self._samples: dict[str, tuple[list[float], list[float]]] = {}
        # the source first heard for each channel: no other is merged with it
        self._speaker: dict[str, str] = {}

    def take(self, topic: str, type_name: str, data: bytes) -> None:
        """One message: a row or a tick is kept; scalars only while there are neither."""
        if type_name == ROW:
            self._rows.append(data)
        elif type_name == TICK:
            self._ticks.append(data)
        elif not (self._rows or self._ticks):
            results = self._decoder.decode_stripped(topic, data, 0.0)
            for result in results:
                self._sample(result)
            self._carry_chart(results)

    def columns(self) -> tuple[np.ndarray, Columns]:
        """Rows if there are any, else what the ticks measured, else the scalars. All (N,), the time in
        [s], columns in the unit in their name. DataError: there is nothing of all this."""
        if self._rows:
            columns, good = self._doubles(ROW, ROW, self._rows)
            time_s = columns.pop("time_s", np.zeros(len(self._rows)))
            time_s = np.nan_to_num(time_s)[good]  # protobuf leaves out a zero
            return time_s, {name: values[good] for name, values in columns.items()}
        if self._ticks:
            return self._of_ticks()
        if self._samples:
            return on_one_base({k: (np.array(t), np.array(x)) for k, (t, x) in self._samples.items()})
        raise DataError(
            f"{self._reader.path}: no measurements in it: no {ROW}, no {TICK}, no Keelson subject we know."
        )

    def _of_ticks(self) -> tuple[np.ndarray, Columns]:
        parts = list(self._parts_of_ticks())
        if not parts:
            raise DataError(f"{self._reader.path}: none of its {len(self._ticks)} {TICK} can be decoded.")
        times, walls, measured, ages, actuators = zip(*parts, strict=True)
        time_s = np.array(times) + (walls[0] - times[0])
        columns, _ = self._doubles(TICK, ROW, list(measured))
        columns.pop("time_s", None)
        old = self._doubles(TICK, AGES, list(ages))[0]
        for row, channels in enumerate(actuators):
            for c in channels:
                if c.HasField("value") and c.name in BY_NAME:
                    _cell(columns, c.name, row, c.value, len(parts))
                    _cell(old, c.name, row, c.age_s, len(parts))
        return time_s, without_repeats(time_s, columns, old)

    def _parts_of_ticks(self) -> Iterator[tuple[float, float, bytes, bytes, list[Any]]]:
        tick_class = self._class(TICK, TICK)
        for data in self._ticks:
            try:
                tick = tick_class.FromString(data)
            except DecodeError:
                self.refused[f"{TICK} {UNREADABLE}"] += 1
                continue
            measured, ages = tick.measured.SerializeToString(), tick.age_s.SerializeToString()
            yield tick.time_s, tick.wall_s, measured, ages, list(getattr(tick, "actuators", ()))

    def _class(self, type_name: str, wanted: str) -> Any:
        """A message class as the log's own schema defines it."""
        try:
            made = classes_from_set(self._reader.schemas[type_name], [wanted])[0]
        except (KeyError, TypeError, ValueError, DecodeError):
            made = None
        if made is None or not _fits(made, OF_TICK if wanted == TICK else {}):
            raise DataError(f"{self._reader.path}: its schema of {type_name} cannot be read.")
        return made

    def _doubles(self, type_name: str, wanted: str, messages: list[bytes]) -> tuple[Columns, np.ndarray]:
        """Messages of numbers as columns, named by the log's own schema, and which could be decoded."""
        numbers, odd = double_columns(messages)
        if odd.any():
            self.refused[f"{wanted} {UNREADABLE}"] += int(odd.sum())
        names = {
            field.number: channel_name(field.name)
            for field in self._class(type_name, wanted).DESCRIPTOR.fields
        }
        return {names[number]: values for number, values in numbers.items() if number in names}, ~odd

    def _carry_chart(self, results: list[Result]) -> None:
        """The chart goes along with the receiver that is used."""
        places = [r for r in results if isinstance(r, Reading) and r.channel in POSITION]
        if self._decoder.chart and len(places) == len(POSITION):
            north, east = places
            if north.source == self._speaker[north.channel]:
                self._decoder.chart = self._recent.carry(self._decoder.chart, (north.value, east.value))

    def _sample(self, result: Result) -> None:
        if isinstance(result, Reading):
            first = self._speaker.setdefault(result.channel, result.source)
            if result.source != first:
                self.refused[f"{result.channel} of {result.source} ({first} is used)"] += 1
                return
            stamps, values = self._samples.setdefault(result.channel, ([], []))
            stamps.append(result.time_s)
            values.append(result.value)
        elif result.channel:
            self.refused[f"{result.channel}, {WORDS[result.quality]}"] += 1


def _fits(made: Any, needed: dict[str, bool]) -> bool:
    """Whether a class of the log's own has the fields that are asked for: one message where True, else one
    number."""
    empty = made()
    return all(
        hasattr(getattr(empty, name, None), "SerializeToString")
        if is_message
        else isinstance(getattr(empty, name, None), float)
        for name, is_message in needed.items()
    )


def _cell(columns: Columns, name: str, row: int, value: float, rows: int) -> None:
    if name not in columns:
        columns[name] = np.full(rows, np.nan)
    columns[name][row] = value

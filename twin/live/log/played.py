"""A log as the loop met it: the instants of its ticks, and what came in before each.

A log of the twin itself holds each sample in front of the tick that used it, so file order alone gives back
every batch. An imported voyage (rows) or a foreign log of Keelson scalars has no ticks: there the ticks stand
on a grid.
"""

from collections import Counter
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from google.protobuf.message import DecodeError

from twin.errors import DataError
from twin.live.keelson import messages
from twin.live.keelson.decode import Decoder, Result, from_row
from twin.live.keelson.stamps import LATEST_S, YEAR_S
from twin.live.keelson.topics import address, is_own, topic_of
from twin.live.log.mcap_read import McapReader, Message
from twin.live.log.own_row import ROW, own_row
from twin.num import as_given

TICK = "shiptwin.Tick"
PEEK = 5000  # messages within which a log of the twin shows its first tick
MAX_GAP_S = 60.0  # a longer hole in a foreign log is jumped over
T = TypeVar("T", bound=tuple[Any, ...])


class Batch(NamedTuple):
    """One tick: its time, what came in before it, decoded and raw."""

    time_s: float
    wall_s: float
    results: list[Result]
    raw: list[Message]


class PlayedLog:
    """A log opened for one pass; `notes` says what was damaged."""

    def __init__(self, path: str | Path, rate_hz: float):
        self._reader = McapReader(path)
        self.path, self.period_s = Path(path), 1.0 / rate_hz
        self.decoder = Decoder()
        self.kind = ""
        self.classes: dict[str, Any] = {}  # types that are not the usual ones: a row with actuators
        self._refused: Counter[str] = Counter()

    @property
    def notes(self) -> list[str]:
        """What is wrong with the log, and what in it was left out."""
        unread = [f"{count} {name} left out: they cannot be decoded" for name, count in self._refused.items()]
        return [*self._reader.problems, *unread]

    def batches(self) -> Iterator[Batch]:
        """The ticks in order; DataError when there is nothing the twin can use."""
        source = self._reader.messages()
        first = list(islice(source, PEEK))
        types = {message.type_name for message in first}
        whole = chain(first, source)
        if TICK in types:
            self.kind = "a log of the twin"
            return self._in_order(self._as_ticked(whole))
        if ROW in types:
            self.kind = "an imported voyage"
            self.classes |= own_row(self._reader)
            return self._on_grid(self._in_order(self._rows(whole)))
        if any(self._topic_type(message.topic) for message in first):
            self.kind = "a log of Keelson scalars"
            return self._on_grid(self._in_order(self._scalars(whole)))
        raise DataError(
            f"{self.path}: no measurements in it: no {TICK}, no {ROW}, no Keelson subject the twin knows."
        )

    def _in_order(self, source: Iterator[T]) -> Iterator[T]:
        """The same; DataError where the first of their numbers, the time [s], is no date, or leaps by years
        or back by minutes."""
        last_s: float | None = None
        for item in source:
            time_s = item[0]
            if not abs(time_s) <= LATEST_S:
                raise DataError(
                    f"{self.path}: {as_given(time_s, 6)} s is no time of a log. Counts it milliseconds or "
                    "less? twin import reads such a voyage."
                )
            if last_s is not None and not last_s - MAX_GAP_S <= time_s <= last_s + YEAR_S:
                raise DataError(
                    f"{self.path}: time leaps from {as_given(last_s, 6)} s to {as_given(time_s, 6)} s. A "
                    "wrong stamp, or two logs in one? Split it there."
                )
            last_s = time_s
            yield item

    def _as_ticked(self, source: Iterator[Message]) -> Iterator[Batch]:
        raw: list[Message] = []
        for message in source:
            if message.type_name != TICK:
                if self._topic_type(message.topic):
                    raw.append(message)
                continue
            try:
                tick = messages.Tick.FromString(message.data)
            except DecodeError:
                self._refused[TICK] += 1
                continue
            results = [r for m in raw for r in self.decoder.decode_stripped(m.topic, m.data, tick.time_s)]
            wall_s = tick.wall_s if 0.0 <= tick.wall_s <= LATEST_S else max(tick.time_s, 0.0)
            yield Batch(tick.time_s, wall_s, results, raw)
            raw = []

    def _on_grid(self, source: Iterator[tuple[float, list[Result], Message]]) -> Iterator[Batch]:
        """Ticks each period from the first sample to the last; a tick has what was measured up to its
        time."""
        results: list[Result] = []
        raw: list[Message] = []
        start_s: float | None = None
        late_s, tick_s, number = 0.02 * self.period_s, 0.0, 0
        for time_s, found, message in source:
            if start_s is None or time_s - tick_s > MAX_GAP_S:
                start_s, tick_s, number = time_s, time_s, 0
            while time_s > tick_s + late_s:
                yield Batch(tick_s, tick_s, _received(results, tick_s), raw)
                results, raw = [], []
                number += 1
                tick_s = start_s + number * self.period_s
            results += found
            raw.append(message)
        if start_s is not None:
            yield Batch(tick_s, tick_s, _received(results, tick_s), raw)

    def _rows(self, source: Iterator[Message]) -> Iterator[tuple[float, list[Result], Message]]:
        row_class = self.classes.get(ROW, messages.Row)
        for message in source:
            if message.type_name == ROW:
                try:
                    row = row_class.FromString(message.data)
                except DecodeError:
                    self._refused[ROW] += 1
                    continue
                yield row.time_s, from_row(row, row.time_s, row.time_s, "voyage"), message

    def _scalars(self, source: Iterator[Message]) -> Iterator[tuple[float, list[Result], Message]]:
        for message in source:
            if self._topic_type(message.topic):
                time_s = message.log_ns * 1e-9
                yield time_s, self.decoder.decode_stripped(message.topic, message.data, time_s), message

    def _topic_type(self, topic: str) -> str:
        """The message type of a logged input of the twin, "" for anything else."""
        place = address(topic)
        known = topic_of(place, self.decoder.actuators) if place else None
        return known.type_name if known and place and not is_own(place.source) else ""


def _received(results: list[Result], time_s: float) -> list[Result]:
    """The tick is when they were received."""
    return [r._replace(received_s=time_s) for r in results]

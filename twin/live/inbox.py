"""Ears: what came in since the last tick, written to the log as it came, and decoded."""

from collections.abc import Callable, Collection, Iterable, Mapping

from twin.live.clock import Instant
from twin.live.keelson.bus import Bus
from twin.live.keelson.decode import Decoder, Result
from twin.live.keelson.seats import Seats
from twin.live.signals.chart import Chart
from twin.live.signals.readings import Quality, Rejected

Log = Callable[[str, str, bytes, int], None]  # topic, type name, payload, time [ns since 1970]


class Inbox:
    """The bus, seen by the loop; every sample of a known subject and of a source that has a seat is logged,
    also one that will be refused. `sources` {channel: source} always have one."""

    def __init__(
        self,
        bus: Bus,
        log: Log | None = None,
        chart: Chart | None = None,
        sources: Mapping[str, str] | None = None,
    ):
        self.bus, self.log, self.seats = bus, log, Seats(sources)
        self.decoder = Decoder(chart, ())

    def listen_to(self, actuators: Collection[str]) -> None:
        """Hear these channels of the ship's actuators, too."""
        self.decoder.actuators = self.seats.actuators = frozenset(actuators)

    def read(self, instant: Instant) -> list[Result]:
        """Never waits."""
        results: list[Result] = []
        wall_ns = round(instant.wall_s * 1e9)
        for key, envelope, received_s in self.bus.drain(instant.time_s):
            if not self.seats.taken(key, received_s):
                results.append(Rejected("", Quality.UNKNOWN_KEY, "too many sources", received_s, ""))
                continue
            taken = self.decoder.take(key, envelope, received_s)
            results += taken.results
            if self.log is not None and taken.type_name:
                self.log(key, taken.type_name, taken.payload, wall_ns)
        return results


class Played:
    """Ears for a replay or a test: results made beforehand, a list for each tick, or put into `next` one
    by one."""

    def __init__(self, ticks: Iterable[list[Result]], decoder: Decoder | None = None):
        """decoder: of the log that the results come from, whose chart the loop moves along."""
        self._ticks = iter(ticks)
        self.next: list[Result] | None = None
        self.decoder = decoder or Decoder()

    def read(self, instant: Instant) -> list[Result]:
        """What came in before this tick of the log."""
        taken, self.next = self.next, None
        return next(self._ticks, []) if taken is None else taken

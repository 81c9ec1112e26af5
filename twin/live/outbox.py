"""Voice: the wide record to the log and the bus, and the subjects whose time has come to the bus."""

from typing import Any

from twin.live.inbox import Log
from twin.live.keelson.bus import Bus
from twin.live.keelson.messages import wrap
from twin.live.keelson.topics import OUTPUTS, key
from twin.live.publish import Publisher
from twin.live.signals.chart import Chart

TICK = next(output for output in OUTPUTS if output.subject == "twin_tick")


class Outbox:
    """Says a tick; without a bus (replay) it is only logged, without a log only said."""

    def __init__(
        self, publisher: Publisher, base: str, entity: str, bus: Bus | None = None, log: Log | None = None
    ):
        self.publisher, self.bus, self.log = publisher, bus, log
        self._keys = {output: key(base, entity, output.subject, output.source) for output in OUTPUTS}

    def send(self, tick: Any, chart: Chart | None) -> None:
        """Never waits, never raises."""
        wall_ns = round(tick.wall_s * 1e9)
        if self.bus is None:
            data = tick.SerializeToString()
        else:
            data = b""
            for output, payload in self.publisher.due(tick, chart):
                self.bus.publish(self._keys[output], wrap(payload, wall_ns))
                data = payload if output is TICK else data
        if self.log is not None:
            self.log(self._keys[TICK], TICK.type_name, data, wall_ns)

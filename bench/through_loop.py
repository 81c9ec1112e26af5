"""A reference voyage through the loop that the service builds, tick by tick."""

from collections.abc import Iterator, Sequence
from typing import Any

from bench.reference.sea_voyage import Recording
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading

BEGIN_S, WALL = 1000.0, 1.7e9  # the loop's clock at the first tick, and the wall's at its zero


def through(
    ship: str, recording: Recording, step_s: float = 0.1, silent: Sequence[str] = (), **settings: Any
) -> Iterator[tuple[int, Any, Loop]]:
    """(number, message, loop) of each tick; `silent`: channels that say nothing."""
    ears = Played([])
    chosen = Settings({"ship.file": ship, "loop.rate_hz": 1.0 / step_s} | settings)
    loop = loop_of(chosen, ears, Outbox(Publisher(), "twin", "ship"), None)
    columns = {
        name: x for name, x in recording.columns.items() if name in loop.sensors.gates and name not in silent
    }
    for k in range(len(recording.columns["time_s"])):
        now_s = BEGIN_S + k * step_s
        values = ((name, float(x[k])) for name, x in columns.items())
        ears.next = [Reading(name, x, WALL + now_s, now_s, "ship") for name, x in values if x == x]
        yield k, loop.tick(Instant(k, now_s, WALL + now_s)), loop

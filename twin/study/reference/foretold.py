"""A voyage through the loop that the service builds, and how far its predictions were off."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.guard import INVALID
from twin.live.inbox import Played
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.prediction.due_predictions import Watch
from twin.live.prediction.judge import VerifiedPrediction
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.recording.voyage import Voyage

BEGIN_S, WALL = 1000.0, 1.7e9  # the loop's clock at the first tick, and the wall's at its zero
Errors = dict[float, list[VerifiedPrediction]]  # by horizon


def errors_of(voyage: Voyage, settings: Settings) -> Errors:
    """Every prediction of the voyage that came due with helm and engine held."""
    found: Errors = {h: [] for h in settings["prediction.horizons_s"]}
    watch: Watch | None = None
    for now_s, loop in sailed_through(voyage, settings):
        watch = watch or Watch(loop.ship, list(found))
        seen = loop.last
        assert seen is not None
        for h, judged in watch.look(
            now_s, seen.measured, seen.estimate, seen.ahead, seen.verdict.mode != INVALID
        ):
            if judged.held:
                found[h].append(judged)
    return found


def sailed_through(voyage: Voyage, settings: Settings) -> Iterator[tuple[float, Loop]]:
    """(time [s], loop) after each tick. DataError: nothing in the voyage is a channel of the loop."""
    ears, period_s = Played([]), 1.0 / settings["loop.rate_hz"]
    loop = loop_of(settings, ears, Outbox(Publisher(), "twin", "ship"), None)
    columns = {name: x for name, x in voyage.columns.items() if name in loop.sensors.gates}
    if not columns or not voyage.time_s.size:
        raise DataError(f"{voyage.name}: nothing in it that the loop listens to.")
    times = BEGIN_S + voyage.time_s - voyage.time_s[0]
    row = 0
    for k in range(int(np.ceil((times[-1] - BEGIN_S) / period_s)) + 1):
        now_s = BEGIN_S + k * period_s
        upto = int(np.searchsorted(times, now_s + 1e-9, side="right"))
        ears.next = [r for i in range(row, upto) for r in _readings(columns, i, float(times[i]), now_s)]
        row = upto
        loop.tick(Instant(k, now_s, WALL + now_s))
        yield now_s, loop


def _readings(columns: dict[str, Any], i: int, time_s: float, now_s: float) -> list[Reading]:
    values = [(name, float(x[i])) for name, x in columns.items()]
    return [Reading(name, x, WALL + time_s, now_s, "ship") for name, x in values if x == x]

"""Whether the prediction tube was kept on a voyage that is over: every prediction that was said with a
promise, against what the instruments measured when it came due."""

from twin.live.guard import INVALID
from twin.live.loop import Loop
from twin.live.prediction.coverage import Coverage, RegionError, coverage, entry
from twin.live.prediction.due_predictions import Watch


class TubeKept:
    """`look` after each tick, `judged` at the end; without a [tube] it does nothing."""

    def __init__(self, loop: Loop):
        self.loop = loop
        table = loop.tube.table
        horizons = [*table.horizons] if table else []
        self._watch = Watch(loop.ship, horizons)
        self._entries: dict[float, list[RegionError]] = {h: [] for h in horizons}

    def look(self, now_s: float) -> None:
        """Judge what came due."""
        seen = self.loop.last
        if not self._entries or seen is None:
            return
        good = seen.verdict.mode != INVALID
        for h, j in self._watch.look(now_s, seen.measured, seen.estimate, seen.ahead, good):
            region = j.foretold.region
            if j.held and region and region.level:
                self._entries[h].append(entry(j, region))

    def judged(self) -> list[Coverage]:
        """One row a horizon of which something came due."""
        return [coverage(h, found) for h, found in self._entries.items() if found]

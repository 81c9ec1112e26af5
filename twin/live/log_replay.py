"""`twin replay`: a recorded voyage through the same objects, under the log's own clock. Twice gives the
same bytes."""

import sys
from collections import Counter
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

from twin.errors import DataError
from twin.live import build
from twin.live.clock import Clock, ReplayClock
from twin.live.foresight import Foresight, Sight
from twin.live.inbox import Played
from twin.live.keelson.bus import Bus
from twin.live.log.mcap_index import PROVENANCE
from twin.live.log.played import Batch, PlayedLog
from twin.live.log.record import LogFile
from twin.live.loop import Loop
from twin.live.observer.controls import actuator_channels
from twin.live.outbox import Outbox
from twin.live.paced import PacedClock, Player
from twin.live.prediction.coverage import Coverage
from twin.live.provenance import REPLAY, identity, provenance
from twin.live.publish import Publisher
from twin.live.replay_record import ReplayRecord, without_numbers
from twin.live.signals.config import Settings
from twin.live.tube_kept import TubeKept
from twin.num import num
from twin.physics.maths import total

SCHEMA_VERSION = 1
PROGRESS = 20_000  # ticks between two words on standard error


class Summary(NamedTuple):
    """What a replay found."""

    log: str
    kind: str
    ship: str
    ticks: int
    duration_s: float
    modes: dict[str, int]
    reasons: dict[str, int]
    rejected: int
    withheld: int  # numbers that were not finite, and so were not said
    foresight: list[Sight]
    notes: list[str]
    tube: list[Coverage]  # of the predictions with a promise

    def as_json(self) -> dict[str, Any]:
        """The same as plain types."""
        sights = [f._asdict() for f in self.foresight]
        kept = [c._asdict() for c in self.tube]
        return {"schema_version": SCHEMA_VERSION, **self._asdict(), "foresight": sights, "tube": kept}


def replay(
    log: str | Path,
    settings: Settings,
    output: str | Path | None = None,
    realtime: bool = False,
    bus: Bus | None = None,
    player: Player | None = None,
    record: ReplayRecord | None = None,
) -> Summary:
    """The voyage through a new loop; `output` is written whole or not at all. On a `bus` the twin speaks as
    if it were live, at the `player`'s pace; of a voyage that is ended there, what was sailed is summed up.
    `record` takes what a page shows of it."""
    played = PlayedLog(log, settings["loop.rate_hz"])
    batches = played.batches()
    with ExitStack() as stack:
        file = stack.enter_context(LogFile(output, played.classes)) if output else None
        ears = Played([], played.decoder)
        voice = Outbox(
            Publisher(), settings["bus.base"], settings["bus.entity"], bus, file.add if file else None
        )
        loop = build.loop_of(settings, ears, voice, patience_s=None)
        played.decoder.actuators = actuator_channels(loop.ship)
        loop.publisher.identity = identity(loop.ship, REPLAY)
        if file:
            file.describe(PROVENANCE, provenance(settings, loop.ship))
        if record:
            record.provenance = provenance(settings, loop.ship)
        waiting: list[Batch] = []
        times = _instants(batches, waiting)
        clock = PacedClock(times, player) if player else ReplayClock(times, 1.0 if realtime else 0.0)
        return _sailed(loop, ears, played, clock, waiting, file, record)


def _sailed(
    loop: Loop,
    ears: Played,
    played: PlayedLog,
    clock: Clock,
    waiting: list[Batch],
    file: LogFile | None,
    record: ReplayRecord | None,
) -> Summary:
    modes: Counter[str] = Counter()
    reasons: Counter[str] = Counter()
    foresight, kept = Foresight(loop), TubeKept(loop)
    first_s = last_s = None
    while (instant := clock.wait()) is not None:
        batch = waiting.pop()
        if file:
            for message in batch.raw:
                file.add(message.topic, message.type_name, message.data, round(instant.wall_s * 1e9))
        ears.next = batch.results
        tick = loop.tick(instant)
        foresight.look(instant.time_s)
        kept.look(instant.time_s)
        if record:
            record.look(loop, tick)
        modes[tick.mode] += 1
        reasons.update(without_numbers(reason) for reason in tick.reasons)
        first_s, last_s = instant.time_s if first_s is None else first_s, instant.time_s
        if instant.number % PROGRESS == PROGRESS - 1:
            print(f"{played.path.name}: {instant.time_s - first_s:.0f} s of the voyage", file=sys.stderr)
    if first_s is None or last_s is None:
        raise DataError(f"{played.path}: not one tick could be made of it.")
    return Summary(
        str(played.path),
        played.kind,
        loop.ship.name,
        total(modes.values()),
        last_s - first_s,
        dict(modes),
        dict(reasons.most_common(12)),
        loop.sensors.rejected,
        loop.publisher.withheld,
        foresight.judged(),
        [*played.notes, *loop.notes, *loop.logged],
        kept.judged(),
    )


def _instants(batches: Any, waiting: list[Batch]) -> Any:
    """The batches' times for the clock; each batch waits to be taken."""
    for batch in batches:
        waiting.append(batch)
        yield batch.time_s, max(batch.wall_s, 0.0)


def summary_lines(s: Summary) -> list[str]:
    """The summary for people."""
    lines = [
        f"{s.log}: {s.kind}, {s.duration_s:.0f} s, {s.ticks} ticks with {s.ship}; {s.rejected} samples "
        "refused"
    ]
    lines.append("modes: " + ", ".join(f"{mode} {100 * n / s.ticks:.0f} %" for mode, n in s.modes.items()))
    lines += [f"  {n:6d} ticks: {reason}" for reason, n in s.reasons.items()]
    if s.foresight:
        lines.append(
            "ahead, open loop from the estimate, recorded helm, engine and weather (mean absolute error):"
        )
        lines += [
            f"  {f.horizon_s:4.0f} s: position {f.position_m:7.2f} m, heading {f.heading_deg:6.2f} deg "
            f"({f.windows} starts)"
            for f in s.foresight
        ]
    lines += _tube(s.tube)
    return lines + [f"note: {note}" for note in s.notes]


def _tube(rows: list[Coverage]) -> list[str]:
    """How the prediction tube was kept."""
    if not rows:
        return []
    return ["tube, helm and engine held, against what was measured:", *map(_kept, rows)]


def _kept(c: Coverage) -> str:
    return (
        f"  {c.horizon_s:4.0f} s: {100 * c.place_inside:.0f} % of places, {100 * c.heading_inside:.0f} % of "
        f"headings inside ({100 * c.level:.0f} % promised on {c.voyages} voyages), "
        f"{num(c.place_radius_m, 3)} m and {num(c.heading_deg, 2)} deg wide; interval score "
        f"{num(c.place_score_m, 3)} m, {num(c.heading_score_deg, 2)} deg ({c.judged} predictions)"
    )

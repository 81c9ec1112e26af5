"""`twin run`: the service. Opens bus and log, ticks on time until it is told to stop, and always ends the
process itself.

An interpreter that ends with an open Zenoh session may hang for ever; so the outermost thing here is
os._exit.
"""

import argparse
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter_ns
from typing import Any

from twin.errors import UsageError
from twin.live import build, realtime
from twin.live.clock import Clock, MonotonicClock
from twin.live.inbox import Inbox
from twin.live.keelson.alone import alone
from twin.live.keelson.bus import Bus
from twin.live.keelson.topics import actuator_subjects
from twin.live.keelson.zenoh_config import BusSettings
from twin.live.keep import Keeper
from twin.live.lagging import Lagging
from twin.live.log.quota import Quota
from twin.live.log.record import Recorder
from twin.live.loop import Loop
from twin.live.notify import Notifier
from twin.live.observer.controls import actuator_channels
from twin.live.outbox import Outbox
from twin.live.provenance import provenance
from twin.live.publish import Publisher
from twin.live.signals import config
from twin.live.signals.config import Settings
from twin.num import as_given

WATCHDOG_S = 0.25  # how often the service manager hears that a step was good
STATUS_S = 1.0


def _served(args: argparse.Namespace) -> int:
    if args.duration is not None and not args.duration > 0.0:
        raise UsageError(f"--duration {as_given(args.duration)}: more than 0 s.")
    settings = config.load(args.config)
    return serve(settings.but("ship.file", args.ship) if args.ship else settings, duration_s=args.duration)


class Stop:
    """SIGTERM and SIGINT end the loop after the tick under way; `code` is what the process then returns."""

    def __init__(self) -> None:
        self.asked = False
        self.code = 0
        signal.signal(signal.SIGTERM, self._asked)
        signal.signal(signal.SIGINT, self._asked)

    def _asked(self, number: int, frame: Any) -> None:
        self.asked = True
        self.code = 130 if number == signal.SIGINT else 0


def serve(
    settings: Settings, duration_s: float | None = None, on_tick: Callable[[Any], None] | None = None
) -> int:
    """Serve until told to stop; `on_tick` sees each tick (a test, a view)."""
    stop = Stop()
    with opened(settings) as service:
        service.run(stop, duration_s, on_tick)
    return stop.code


@contextmanager
def opened(settings: Settings, clock_of: Callable[[float], Clock] = MonotonicClock) -> Iterator["Service"]:
    """The service of these settings, ready to tick by the clock that `clock_of(rate_hz)` gives.

    The bus opens last: when peers greet it while the network is being loaded, the pages of both are resident
    at once, and their sum would be the peak.
    """
    realtime.save_memory()
    recorder, bus = recorder_of(settings), bus_of(settings)
    log = recorder.write if recorder else None
    inbox = Inbox(bus, log, sources=settings.sources)
    loop = build.loop_of(settings, inbox, _voice(settings, bus, log))
    if channels := actuator_channels(loop.ship):
        inbox.listen_to(channels)
        bus.listen_to(actuator_subjects(channels))
    with alone(settings["state.folder"]), bus:
        if recorder:
            recorder.about = provenance(settings, loop.ship)
            recorder.start()
            loop.notes += recorder.repaired
        service = Service(loop, inbox, recorder, settings, clock_of(loop.rate_hz))
        names = ("priority", "cpu", "lock_memory", "drop_pages")
        loop.notes += realtime.settle(*(settings[f"loop.{name}"] for name in names))
        try:
            yield service
        finally:
            if recorder:
                recorder.close(1.0)


class Service:
    """A loop with its clock, and those who want to hear of it."""

    def __init__(self, loop: Loop, inbox: Inbox, recorder: Recorder | None, settings: Settings, clock: Clock):
        self.loop, self.inbox, self.bus = loop, inbox, inbox.bus
        self.recorder, self.clock = recorder, clock
        self.notifier, self.lagging = Notifier(), Lagging(loop.rate_hz)
        path = build.learned_file(settings)
        self.keeper = Keeper(path) if path and loop.learned.adaptation else None
        self.mark = build.mark_of(loop.learned) if self.keeper else ""
        self.save_s = settings["adaptation.save_s"]
        self._alarms: list[str] = []
        self._dropped = 0
        self._next_save = self._next_watchdog = self._next_status = 0.0
        loop.watched, loop.dropped = lambda: self._alarms, lambda: self._dropped

    def run(self, stop: Stop, duration_s: float | None, on_tick: Callable[[Any], None] | None) -> None:
        """Tick until stopped."""
        print(self._greeting(), file=sys.stderr, flush=True)
        self.notifier.ready("started")
        end_s = None
        try:
            while not stop.asked and (instant := self.clock.wait()) is not None:
                began_ns = perf_counter_ns()
                tick = self.loop.tick(instant)
                self._after(tick, instant.time_s, (perf_counter_ns() - began_ns) / 1e3)
                if on_tick is not None:
                    on_tick(tick)
                end_s = end_s or (instant.time_s + duration_s if duration_s else float("inf"))
                if instant.time_s >= end_s:
                    break
        finally:
            self.notifier.stopping()
            if self.keeper:
                self._save()
                self.keeper.close(0.5)

    def _after(self, tick: Any, now_s: float, step_us: float) -> None:
        """Slack of this tick for the next one's record, and word to the watchdog."""
        slack_s = self.clock.slack_s()
        if slack_s is not None:
            self.loop.pace = self.loop.pace._replace(slack_us=1e6 * slack_s, step_us=step_us)
        if now_s >= self._next_watchdog:
            self.notifier.alive()
            self._next_watchdog = now_s + WATCHDOG_S
        if now_s >= self._next_status:
            self._look_round(tick, now_s)
            self._next_status = now_s + STATUS_S
        if self.keeper and now_s >= self._next_save:
            self._save()
            self._next_save = now_s + self.save_s

    def _look_round(self, tick: Any, now_s: float) -> None:
        """Alarms of clock, bus, log and keeper go into the next ticks' reasons."""
        alarms = [
            self.lagging.look(now_s, self.loop.overruns),
            self.bus.state.alarm,
            self.inbox.seats.alarm(now_s),
        ]
        if self.recorder:
            state = self.recorder.state
            self._dropped = state.dropped + state.lost
            alarms.append(state.alarm)
        if self.keeper:
            alarms.append(self.keeper.failed)
        self._alarms = [alarm for alarm in alarms if alarm]
        self.notifier.status("; ".join([tick.mode, *tick.reasons]))

    def _save(self) -> None:
        adaptation = self.loop.learned.adaptation
        if self.keeper and adaptation:
            self.keeper.put(adaptation.saved(self.mark))

    def _greeting(self) -> str:
        learned = "hybrid" if self.loop.learned.residual else f"physics only ({self.loop.learned.why_not})"
        notes = [*self.loop.notes, *self.loop.logged, *filter(None, [self.bus.state.alarm])]
        return f"{self.loop.ship.name}: {as_given(self.loop.rate_hz)} Hz, {learned}. " + " ".join(
            f"[{note}]" for note in notes
        )


def bus_of(settings: Settings) -> Bus:
    """The bus of these settings, not yet open."""
    from twin.live.keelson.zenoh_bus import ZenohBus

    return ZenohBus(BusSettings.of(settings))


def recorder_of(settings: Settings) -> Recorder | None:
    """The log of these settings; None where none is wanted."""
    if not settings["log.folder"]:
        return None
    quota = Quota(*(settings[f"log.{name}"] for name in Quota._fields))
    largest_mb = min(settings["log.segment_mb"], quota.max_mb / 4.0 or float("inf"))
    return Recorder(
        settings["log.folder"],
        max_bytes=int(largest_mb * 1e6),
        max_seconds=settings["log.segment_s"],
        quota=quota,
    )


def _voice(settings: Settings, bus: Bus, log: Any) -> Outbox:
    return Outbox(Publisher(), settings["bus.base"], settings["bus.entity"], bus, log)

"""`twin-bench growth`: does the memory of the service grow under way?

The service's loop (certificate, network and adaptation on), its log and its saved adaptation, with the
garbage collector off as on board, hear a ship that sails by its own equations and the network's force: every
instrument in every tick, as messages. The clock does not wait. A new log file is begun every 15 minutes as by
default, and every 10 s in a second process. Anonymous memory (RssAnon) is read 120 times after a warm-up of
an eighth of the time; its slope is one of least squares. Exit code 3 when the 95 % interval of a slope does
not lie below what is wanted. The bus itself (Zenoh) is not in it."""

import argparse
import json
import subprocess
import sys
import tempfile
from array import array
from collections.abc import Sequence
from itertools import pairwise
from math import sqrt
from pathlib import Path
from time import monotonic, sleep
from typing import Any, NamedTuple

from bench import bench_output
from bench.options import positive
from bench.steady_feed import UTC_LESS_MONOTONIC_S, SteadyFeed
from bench.tick.memory import memory
from twin.errors import ThresholdError, TwinError, UsageError
from twin.live import build, realtime
from twin.live.clock import Instant
from twin.live.inbox import Inbox
from twin.live.learning.learned_force import LearnedForce
from twin.live.log.record import Recorder
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.service import Service, Stop, recorder_of
from twin.live.signals.config import Settings

WANTED_MB_AN_HOUR = 0.2  # of 1e6 bytes
CHANGES_S = (900.0, 10.0)  # of sailing between two log files: the default of the settings, and many
LOOKS, WARM_UP = 120, 0.125  # readings of the memory; share of the hours that is sailed before them
LOG_MB = 160.0  # quota of the log's folder
BEGIN_S = 1000.0
AHEAD = 1000  # messages that the loop may be ahead of the log's thread, which works in real time
COLUMNS = (
    "a new log file every",
    "files",
    "ticks",
    "with the learned force",
    "with a promise",
    "messages logged",
    "not logged",
    "anonymous MB, first quarter",
    "last quarter",
    "least and most",
    "MB an hour",
)
CHILD = "import sys; from bench.memory_growth import child; child(*sys.argv[1:])"


class MemorySlope(NamedTuple):
    """One process: what it did, and its slope [1e6 bytes an hour of sailing] with half its 95 % interval."""

    change_s: float
    files: int  # begun
    ticks: int
    hybrid: float  # share of the ticks in which the learned force acted
    promised: float  # share of the ticks with a promise of the certificate
    logged: int  # messages
    not_logged: int
    first_mb: float  # means of the first and the last quarter of the readings
    last_mb: float
    lowest_mb: float
    highest_mb: float
    mb_an_hour: float
    within: float
    wall_s: float
    readings_mb: list[float]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--hours", type=float, default=2.0, help="of sailing that are measured (default: 2)")
    add("--rate-hz", type=positive, default=50, help="of the loop and of every instrument (default: 50)")
    add("--hull", default="kvlcc2", help="the ship (default: kvlcc2)")
    add("--most-mb", type=float, default=WANTED_MB_AN_HOUR, metavar="MB", help="an hour (default: 0.2)")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    if not args.hours * 3600.0 * args.rate_hz >= LOOKS:
        raise UsageError(f"--hours {args.hours:g}: a tick for each of {LOOKS} readings at least.")
    found = [measured(args.hours, args.rate_hz, args.hull, change_s) for change_s in CHANGES_S]
    bench_output.rows(args, found, page(found, args))
    worst = max(row.mb_an_hour + row.within for row in found)
    if not worst <= args.most_mb:
        raise ThresholdError(f"memory may grow by {worst:.2f} MB an hour, wanted: {args.most_mb:g} at most.")
    return 0


def measured(hours: float, rate_hz: float, hull: str, change_s: float) -> MemorySlope:
    """One voyage in a process of its own, which has nothing else in its memory."""
    words = [sys.executable, "-c", CHILD, *map(str, (hours, rate_hz, hull, change_s))]
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        raise TwinError(f"the service under way ended with exit code {done.returncode}: see above.")
    return MemorySlope(**json.loads(done.stdout.splitlines()[-1]))


def page(found: Sequence[MemorySlope], args: argparse.Namespace) -> str:
    lines = bench_output.begun("Growth of the service's memory", __doc__, *COLUMNS)
    for r in found:
        cells = (
            f"{r.change_s:g} s",
            r.files,
            r.ticks,
            f"{100.0 * r.hybrid:.1f} %",
            f"{100.0 * r.promised:.1f} %",
            r.logged,
            r.not_logged,
            f"{r.first_mb:.2f}",
            f"{r.last_mb:.2f}",
            f"{r.lowest_mb:.2f}, {r.highest_mb:.2f}",
            f"{r.mb_an_hour:+.3f} ± {r.within:.3f}",
        )
        lines.append(f"| {' | '.join(map(str, cells))} |")
    wanted = f"at most {args.most_mb:g} MB (of 10^6 bytes) an hour"
    return "\n".join([*lines, "", f"{args.hull}, {args.hours:g} h at {args.rate_hz:g} Hz. Wanted: {wanted}."])


def slope(hours: Sequence[float], mb: Sequence[float]) -> tuple[float, float]:
    """Slope by least squares [MB/h] and half its 95 % interval, which is the wider the more one residual
    resembles the next (factor sqrt((1 + r) / (1 - r)), r their correlation)."""
    n = len(hours)
    t0, m0 = sum(hours) / n, sum(mb) / n
    tt = sum((t - t0) ** 2 for t in hours)
    b = sum((t - t0) * (m - m0) for t, m in zip(hours, mb, strict=True)) / tt
    left = [m - m0 - b * (t - t0) for t, m in zip(hours, mb, strict=True)]
    ss = sum(x * x for x in left)
    alike = sum(x * y for x, y in pairwise(left)) / ss if ss else 0.0
    alike = min(max(alike, 0.0), 0.99)
    return b, 1.98 * sqrt(ss / (n - 2) / tt * (1.0 + alike) / (1.0 - alike))


class SailedClock:
    """Tick after tick without waiting, but for the log's thread; None when the voyage is over."""

    def __init__(self, period_s: float, ticks: int, recorder: Recorder):
        self.period_s, self.ticks, self.recorder = period_s, ticks, recorder
        self.k, self.now_s, self.logged = 0, BEGIN_S, 0

    def wait(self) -> Instant | None:
        if self.k == self.ticks:
            return None
        state = self.recorder.state
        while self.logged - state.written - state.lost - state.dropped > AHEAD:
            sleep(1e-3)
            state = self.recorder.state
        self.now_s = BEGIN_S + self.k * self.period_s
        self.k += 1
        return Instant(self.k - 1, self.now_s, UTC_LESS_MONOTONIC_S + self.now_s)

    def slack_s(self) -> None:
        return None

    def log(self, *message: Any) -> None:
        self.logged += 1
        self.recorder.write(*message)


class MemoryReader:
    """Reads the memory now and then and counts the ticks; its room is taken before the first one."""

    def __init__(self, first: int, last: int):
        self.at = [first + (last - first) * i // LOOKS for i in range(1, LOOKS + 1)]
        self.mb, self.looked = array("d", bytes(8 * LOOKS)), 0
        self.ticks = self.hybrid = self.promised = 0

    def on_tick(self, tick: Any) -> None:
        self.ticks += 1
        self.hybrid += tick.mode == "hybrid"
        self.promised += tick.certificate.inside
        if self.looked < LOOKS and self.ticks == self.at[self.looked]:
            self.mb[self.looked] = memory().anon_mb
            self.looked += 1


def child(hours: str, rate_hz: str, hull: str, change_s: str) -> None:
    """The voyage itself; prints its `MemorySlope` as JSON."""
    with tempfile.TemporaryDirectory() as folder:
        print(json.dumps(sailed(Path(folder), float(hours), float(rate_hz), hull, float(change_s))._asdict()))


def sailed(folder: Path, hours: float, rate_hz: float, hull: str, change_s: float) -> MemorySlope:
    began_s = monotonic()
    settings = Settings(
        {
            "ship.file": hull,
            "loop.rate_hz": rate_hz,
            "log.folder": str(folder / "logs"),
            "log.segment_s": change_s,
            "log.max_mb": LOG_MB,
            "state.folder": str(folder / "state"),
        }
    )
    realtime.save_memory()
    recorder = recorder_of(settings)
    assert recorder is not None
    first, last = round(WARM_UP * hours * 3600.0 * rate_hz), round((1.0 + WARM_UP) * hours * 3600.0 * rate_hz)
    clock, watcher = SailedClock(1.0 / rate_hz, last, recorder), MemoryReader(first, last)
    recorder.monotonic = lambda: clock.now_s
    feed = SteadyFeed(build.load_ship(hull, arrays=False), 1.0 / rate_hz)
    inbox = Inbox(feed, clock.log)
    loop = build.loop_of(settings, inbox, Outbox(Publisher(), "twin", "ship", feed, clock.log), None)
    feed.pushed_by(LearnedForce(loop.ship, loop.learned.residual, adapt=False))
    recorder.start()
    service = Service(loop, inbox, recorder, settings, clock)
    realtime.settle(lock_memory=False)
    service.run(Stop(), None, watcher.on_tick)
    path, state = recorder.state.path, recorder.close(60.0)
    mb, quarter = list(watcher.mb), LOOKS // 4
    b, within = slope([tick / rate_hz / 3600.0 for tick in watcher.at], mb)
    return MemorySlope(
        change_s,
        int(Path(path).name.split("-")[1]),
        watcher.ticks,
        watcher.hybrid / watcher.ticks,
        watcher.promised / watcher.ticks,
        state.written,
        clock.logged - state.written,
        sum(mb[:quarter]) / quarter,
        sum(mb[-quarter:]) / quarter,
        min(mb),
        max(mb),
        b,
        within,
        monotonic() - began_s,
        mb,
    )

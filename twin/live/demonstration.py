"""`twin demo`: a ship's twin alive, from nothing, in about a minute.

A reference ship sails in a process of its own, its instruments speak Keelson over Zenoh, the loop listens,
estimates, speaks and logs; the log is then replayed, and the replay held against what was said live.
"""

import argparse
import importlib.util
import math
import os
import shlex
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from twin.errors import TwinError, UsageError
from twin.live import log_replay, service
from twin.live.keelson import messages
from twin.live.log.logfile import read
from twin.live.signals.config import Settings
from twin.live.terminal import View
from twin.num import as_given, num
from twin.physics.ship import load

SEA = "bench.sea_process"  # the reference sea: a program beside the twin, not a part of it
UNDER_WAY, START_S = "under way", 60.0  # what the sea says when it is ready, and the longest wait for it
RUN_IN = 2.0  # ship lengths that it sails straight before a manoeuvre begins
RECORDED_COLUMNS = (
    "north_m",
    "east_m",
    "heading_true_north_deg",
    "surge_velocity_mps",
    "sway_velocity_mps",
    "yaw_rate_degps",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of `twin demo`."""
    parser.add_argument("--seconds", type=float, default=30.0, help="how long it sails (default: 30)")
    parser.add_argument(
        "--ship", default="kvlcc2", help="a bundled ship: kvlcc2 (320 m; the default), usv (2 m, lively), ..."
    )
    parser.add_argument(
        "--manoeuvre", default="zigzag_20", help="what the helmsman does (default: zigzag_20)"
    )
    parser.add_argument("--logs", default="logs", metavar="FOLDER", help="where the log goes (default: logs)")


def run(args: argparse.Namespace) -> int:
    """Sail, look, log, replay, and say what to do next. UsageError: a number of seconds that cannot be
    shown."""
    if not 5.0 <= args.seconds <= 3600.0:
        raise UsageError(f"--seconds {as_given(args.seconds)}: 5 to 3600 can be shown.")
    ship = load(args.ship)
    folder = Path(args.logs) / time.strftime("demo-%Y%m%d-%H%M%S")
    settings = settings_for(args.ship, folder)
    print(
        f"{ship.name} sails a {args.manoeuvre} in the reference sea for {as_given(args.seconds)} s; its twin "
        "listens."
    )
    with reference_sea(settings, args, RUN_IN * ship.L_pp / ship.U_0):
        view = View(sys.stdout, f"shiptwin demo: {ship.name}", args.seconds, str(folder))
        code = service.serve(settings, args.seconds, view.show)
    if code:
        return code
    log = newest(folder)
    tell(log, view.ticks, settings)
    return 0


def settings_for(ship: str, folder: Path) -> Settings:
    """As `twin run`, on a free port, 20 times a second, without the rights of a service."""
    values = {
        "ship.file": ship,
        "bus.listen": f"tcp/127.0.0.1:{free_port()}",
        "log.folder": str(folder),
        "loop.rate_hz": 20.0,
        "loop.priority": 0,
        "loop.lock_memory": False,
    }
    settings = Settings()
    for name, value in values.items():
        settings = settings.but(name, value)
    return settings


@contextmanager
def reference_sea(settings: Settings, args: argparse.Namespace, after_s: float) -> Iterator[None]:
    """The ship and its instruments, in a process of its own, until the demo is over; it is under way for
    `after_s`. TwinError: the package `bench` is not there, or the sea does not start."""
    if importlib.util.find_spec("bench") is None:
        raise TwinError(
            "The reference sea (package `bench`) is not installed here. Run `make demo` in the source folder."
        )
    command = [sys.executable, "-P", "-m", SEA, "--connect", settings["bus.listen"], "--hull", args.ship]
    command += ["--manoeuvre", args.manoeuvre, "--after", f"{after_s:.0f}"]
    command += ["--base", settings["bus.base"], "--entity", settings["bus.entity"]]
    with tempfile.TemporaryFile("w+") as said:
        sea = subprocess.Popen(command, stdout=said, stderr=said)
        try:
            _wait_for(sea, said)
            yield
        finally:
            sea.terminate()
            sea.wait(10)


def _wait_for(sea: "subprocess.Popen[bytes]", said: IO[str]) -> None:
    """Until it is under way."""
    until, text = time.monotonic() + START_S, ""
    while UNDER_WAY not in text:
        ended = sea.poll() is not None or time.monotonic() > until
        # its place in the file is the sea's too
        text = os.pread(said.fileno(), 10_000, 0).decode(errors="replace")
        if ended and UNDER_WAY not in text:
            raise TwinError(f"The reference sea did not start: {text.strip() or 'it said nothing'}")
        time.sleep(0.05)


def tell(log: Path, ticks: int, settings: Settings) -> None:
    """Replay the log and print where it is and what to do next."""
    print(f"\n{ticks} ticks. Replaying the log through the same objects ...", flush=True)
    again = log.with_name("again.mcap")
    summary = log_replay.replay(log, settings, again)
    modes = ", ".join(f"{mode} {n}" for mode, n in summary.modes.items())
    print(f"replayed {summary.ticks} ticks ({modes}); {compared(log, again)}")
    print(f"log:  {log} ({log.stat().st_size / 1e3:.0f} kB; Lichtblick, Foxglove and Rerun open it)")
    print(f"next: twin replay {shlex.quote(str(log))} --ship {shlex.quote(settings['ship.file'])}")


def compared(log: Path, again: Path) -> str:
    """How far the replay's estimates are from those said live."""
    live, replayed = ({t.index: t.estimate for t in ticks_of(path)} for path in (log, again))
    worst = max(
        (
            abs(getattr(live[i], name) - getattr(replayed[i], name))
            for i in live.keys() & replayed.keys()
            for name in RECORDED_COLUMNS
        ),
        default=math.nan,
    )
    return (
        ("the same estimates as live, bit for bit")
        if worst == 0.0
        else f"estimates differ from live by {num(worst, 2)} at most"
    )


def ticks_of(path: Path) -> Iterator[Any]:
    """The ticks in a log, in order."""
    for message in read(path):
        if message.type_name == "shiptwin.Tick":
            yield messages.Tick.FromString(message.data)


def newest(folder: Path) -> Path:
    """The last log of a folder. TwinError: there is none."""
    logs = sorted(folder.glob("*.mcap"))
    if not logs:
        raise TwinError(f"{folder}: no log was written. Is the disk full?")
    return logs[-1]


def free_port() -> int:
    """A TCP port on loopback that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])

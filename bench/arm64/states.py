"""What the loop makes of a log: every number of every tick to the last digit, and one SHA-256 of them all.

    python -m bench.arm64.states VOYAGE.mcap --ship kvlcc2 --seconds 60

Needs no more than the service does, so that it also runs where nothing else is installed.
"""

import argparse
import hashlib
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.log.played import PlayedLog
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings


def ticks(log: str | Path, settings: Settings, seconds: float) -> Iterator[Loop]:
    """The loop that the service builds, after each tick of the first seconds of a log."""
    played = PlayedLog(log, settings["loop.rate_hz"])
    ears = Played([], played.decoder)
    loop = loop_of(
        settings, ears, Outbox(Publisher(), settings["bus.base"], settings["bus.entity"]), patience_s=None
    )
    begin_s = None
    for number, batch in enumerate(played.batches()):
        begin_s = batch.time_s if begin_s is None else begin_s
        if batch.time_s - begin_s > seconds:
            return
        ears.next = batch.results
        loop.tick(Instant(number, batch.time_s, max(batch.wall_s, 0.0)))
        yield loop


def numbers(loop: Loop) -> Iterator[float]:
    """What the last tick estimated, and which forces acted in it [SI]."""
    seen = loop.last
    assert seen is not None
    yield from seen.estimate.state()
    yield from seen.estimate.sigma
    yield from (seen.estimate.current_north, seen.estimate.current_east)
    yield from chain.from_iterable(seen.forces)
    yield from seen.learned.force
    yield from loop.observer.rates


def lines(log: str | Path, settings: Settings, seconds: float = 60.0) -> list[str]:
    """A line a tick: the shortest text of each number that gives it back."""
    made = [" ".join(map(repr, numbers(loop))) for loop in ticks(log, settings, seconds)]
    assert made, f"{log}: not one tick could be made of it"
    return made


def digest(made: list[str]) -> str:
    """SHA-256 of these lines."""
    return hashlib.sha256("\n".join(made).encode()).hexdigest()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("log", metavar="LOG.mcap")
    parser.add_argument("--ship", default="kvlcc2", help="ship file or a bundled ship's name")
    parser.add_argument("--certificate", default="", help="the certificate's file, if it is worked out")
    parser.add_argument("--seconds", type=float, default=60.0, help="how much of the log")
    parser.add_argument("--lines", action="store_true", help="the numbers instead of their SHA-256")
    args = parser.parse_args()
    settings = Settings({"ship.file": args.ship, "observer.certificate": args.certificate})
    made = lines(args.log, settings, args.seconds)
    print("\n".join(made) if args.lines else digest(made))


if __name__ == "__main__":
    main()

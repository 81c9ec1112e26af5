"""`twin view`: the feed that was asked for, the watch, and the page or the terminal."""

import argparse
import sys
import time
from threading import Thread

from twin.errors import UsageError
from twin.live.bridge.feed import About, BridgeFeed, BusFeed, LogFeed
from twin.live.bridge.server import Server
from twin.live.bridge.text import Text
from twin.live.bridge.watch import RATE_HZ, BridgeWatch
from twin.live.signals import config
from twin.physics.ship import load


def viewed(args: argparse.Namespace) -> int:
    """Shows it until it is interrupted, or a log in the terminal is at its end; the exit code."""
    watch = BridgeWatch(_feed(args), _ship(args.ship))
    return _in_terminal(watch, args) if args.text else _on_page(watch, args)


def _feed(args: argparse.Namespace) -> BridgeFeed:
    if args.log:
        if args.connect or args.config:
            raise UsageError(
                "a log is played, or a bus is heard: leave out LOG.mcap, or --connect and --config."
            )
        return LogFeed(args.log, 1.0 if args.speed is None else args.speed)
    if args.speed is not None:
        raise UsageError("--speed is for LOG.mcap; on a bus the twin's own time counts.")
    settings = config.load(args.config)
    if args.connect:
        for name, value in (("listen", ""), ("router", ""), ("connect", [args.connect])):
            settings = settings.but(f"bus.{name}", value)
    return BusFeed(settings)


def _ship(file: str | None) -> About | None:
    """The name and size of a ship file, for a twin that does not say them."""
    if not file:
        return None
    ship = load(file)
    return About(ship.name, ship.L_pp, ship.B)


def _on_page(watch: BridgeWatch, args: argparse.Namespace) -> int:
    if not 0 <= args.port <= 65535:
        raise UsageError(f"--port {args.port}: 0 (any free one) to 65535.")
    watch.step(time.monotonic())

    def said(link: str) -> None:
        print(f"open once: {link}", flush=True)

    with Server(watch, args.port, said) as server:
        Thread(target=server.serve_forever, name="page", daemon=True).start()
        print(f"listening to {watch.feed.name}; Ctrl-C ends it", file=sys.stderr, flush=True)
        watch.run(lambda: True)
    return 0


def _in_terminal(watch: BridgeWatch, args: argparse.Namespace) -> int:
    text = Text(sys.stdout)
    while True:
        now_s = time.monotonic()
        frame = watch.step(now_s)
        text.show(frame, now_s)
        if watch.feed.over:
            print("the log is over", file=sys.stderr)
            return 0
        time.sleep(1.0 / RATE_HZ)

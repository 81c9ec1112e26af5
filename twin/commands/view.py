"""`twin view`: the twin for the bridge, in a browser or in the terminal, from the bus or from a log."""

import argparse

from twin.cli import guarded
from twin.live import ending
from twin.live.bridge.serve import viewed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "log", nargs="?", metavar="LOG.mcap", help="a log of the twin, played; default: the bus is heard"
    )
    parser.add_argument(
        "--connect", metavar="PLACE", help="where the twin listens (default: tcp/127.0.0.1:7447)"
    )
    parser.add_argument(
        "--config", metavar="TWIN.toml", help="settings of the twin: its names on the bus, its certificates"
    )
    parser.add_argument("--ship", metavar="SHIP.toml", help="size and name where the twin does not say them")
    parser.add_argument("--speed", type=float, metavar="X", help="with LOG.mcap: so many times as fast")
    parser.add_argument(
        "--port", type=int, default=8470, help="of the page on 127.0.0.1, 0 for any free one (default: 8470)"
    )
    parser.add_argument("--text", action="store_true", help="in the terminal instead of a browser")


def run(args: argparse.Namespace) -> int:
    """Never returns: ends the process with the exit code."""
    ending.ends_the_process(lambda: guarded(lambda: viewed(args)))

"""`twin run`: the service. Opens bus and log, ticks on time until it is told to stop, and always ends the
process itself.

An interpreter that ends with an open Zenoh session may hang for ever; so the outermost thing here is
os._exit.
"""

import argparse

from twin.cli import guarded
from twin.live import ending
from twin.live.service import _served
from twin.live.signals import config


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--config",
        metavar="TWIN.toml",
        help="settings (default: bundled KVLCC2, listening on this computer only)",
    )
    parser.add_argument(
        "--ship",
        metavar="SHIP.toml",
        help="ship file or name of a bundled ship, instead of the settings' own",
    )
    parser.add_argument("--duration", type=float, metavar="S", help="stop by itself after so many seconds")
    parser.add_argument(
        "--example-config", action="store_true", help="print a settings file with every key, and stop"
    )


def run(args: argparse.Namespace) -> int:
    """Never returns when it served: ends the process with the exit code."""
    if args.example_config:
        print(config.example())
        return 0
    ending.ends_the_process(lambda: guarded(lambda: _served(args)))

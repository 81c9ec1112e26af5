"""`twin health`: is the twin on this computer alive and well? Listens for a moment to what it says."""

import argparse
import os
import sys
import traceback

from twin.cli import guarded
from twin.live.health_check import ask


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--config", metavar="TWIN.toml", help="the settings the twin runs with (default: its defaults)"
    )
    parser.add_argument(
        "--timeout", type=float, default=3.0, metavar="S", help="how long to listen at most (default: 3)"
    )
    parser.add_argument("--json", metavar="FILE", help="write the answer as JSON, - for standard output")


def run(args: argparse.Namespace) -> int:
    """Ends the process itself (an open Zenoh session may hold up its end)."""
    code = 1
    try:
        code = guarded(lambda: ask(args))
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)

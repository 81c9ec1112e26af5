"""`twin replay`: a recorded voyage through the same objects, under the log's own clock. Twice gives the
same bytes."""

import argparse
import json
from pathlib import Path

from twin import whole
from twin.cli import guarded
from twin.errors import SettingsError, UsageError
from twin.live import ending
from twin.live.replay import SCHEMA_VERSION, Summary, replay, told
from twin.live.signals import config
from twin.live.signals.config import Settings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "log", metavar="LOG.mcap", help="a log of the twin, an imported voyage, or a log of Keelson scalars"
    )
    parser.add_argument(
        "-o", "--output", metavar="OUT.mcap", help="write what the twin said, and what it heard, to a new log"
    )
    parser.add_argument("--config", metavar="TWIN.toml", help="settings (default: as `twin run` without any)")
    parser.add_argument(
        "--ship",
        metavar="SHIP.toml",
        help="ship file or name of a bundled ship, instead of the settings' own",
    )
    parser.add_argument(
        "--realtime", action="store_true", help="as fast as the voyage was, not as fast as possible"
    )
    parser.add_argument(
        "--to-bus",
        action="store_true",
        help="say it on the bus of the settings, as fast as the voyage was, so that `twin view` and others "
        "can watch; space or Ctrl-Z pauses, + and - change the speed, q ends",
    )
    parser.add_argument("--speed", type=float, metavar="X", help="with --to-bus: so many times as fast")
    parser.add_argument(
        "--listen", metavar="PLACE", help="with --to-bus: where, instead of the settings' tcp/127.0.0.1:7447"
    )
    parser.add_argument("--json", metavar="FILE", help="write the summary as JSON, - for standard output")


def run(args: argparse.Namespace) -> int:
    settings = config.load(args.config)
    if args.ship:
        settings = settings.but("ship.file", args.ship)
    if args.output and Path(args.output).resolve() == Path(args.log).resolve():
        raise SettingsError(f"-o {args.output}: is the log itself. Give another name.")
    if args.to_bus:
        return run_on_the_bus(args, settings)
    if args.speed is not None or args.listen:
        raise UsageError("--speed and --listen are for --to-bus; as fast as the voyage was: --realtime.")
    return _told(replay(args.log, settings, args.output, args.realtime), args, settings)


def run_on_the_bus(args: argparse.Namespace, settings: Settings) -> int:
    """Never returns: an interpreter that ends with an open Zenoh session may hang for ever."""
    from twin.live.onto_bus import replay_onto_bus

    if args.listen:
        settings = settings.but("bus.listen", args.listen)
    speed = 1.0 if args.speed is None else args.speed

    def on_the_bus() -> int:
        return _told(replay_onto_bus(args.log, settings, args.output, speed), args, settings)

    ending.ends_the_process(lambda: guarded(on_the_bus))


def _told(summary: Summary, args: argparse.Namespace, settings: Settings) -> int:
    if args.json:
        _write_json(summary, args.json)
    if args.json != "-":
        print("\n".join(told(summary, args, settings["ship.file"])))
    return 0


def _write_json(summary: Summary, path: str) -> None:
    table = {
        "schema_version": SCHEMA_VERSION,
        **summary._asdict(),
        "foresight": [f._asdict() for f in summary.foresight],
        "tube": [c._asdict() for c in summary.tube],
    }
    text = json.dumps(table, indent=2)
    if path == "-":
        print(text)
        return
    whole.write(path, text + "\n", "--json")

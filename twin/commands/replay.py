"""`twin replay`: a recorded voyage through the same objects, under the log's own clock. Twice gives the
same bytes."""

import argparse
import json
from pathlib import Path

from twin import whole
from twin.cli import guarded
from twin.errors import SettingsError, UsageError
from twin.live import ending
from twin.live.replay import Summary, replay, told
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
        ending.ends_the_process(lambda: guarded(lambda: _on_the_bus(args, settings)))
    if args.speed is not None or args.listen:
        raise UsageError("--speed and --listen are for --to-bus; as fast as the voyage was: --realtime.")
    return _answer(replay(args.log, settings, args.output, args.realtime), args, settings)


def _on_the_bus(args: argparse.Namespace, settings: Settings) -> int:
    from twin.live.onto_bus import replay_onto_bus

    if args.listen:
        settings = settings.but("bus.listen", args.listen)
    speed = 1.0 if args.speed is None else args.speed
    return _answer(replay_onto_bus(args.log, settings, args.output, speed), args, settings)


def _answer(summary: Summary, args: argparse.Namespace, settings: Settings) -> int:
    if args.json:
        whole.put(args.json, json.dumps(summary.as_json(), indent=2), "--json")
    if args.json != "-":
        compare = f"twin compare {args.output or args.log} --ship {settings['ship.file']}"
        print("\n".join([*told(summary), f"next: {compare}"]))
    return 0

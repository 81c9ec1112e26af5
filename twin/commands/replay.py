"""`twin replay`: a recorded voyage through the same objects, under the log's own clock. Twice gives the
same bytes."""

import argparse
import json
from pathlib import Path

from twin import whole
from twin.errors import SettingsError
from twin.live.replay import SCHEMA_VERSION, Summary, replay, told
from twin.live.signals import config


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
    parser.add_argument("--json", metavar="FILE", help="write the summary as JSON, - for standard output")


def run(args: argparse.Namespace) -> int:
    settings = config.load(args.config)
    if args.ship:
        settings = settings.but("ship.file", args.ship)
    if args.output and Path(args.output).resolve() == Path(args.log).resolve():
        raise SettingsError(f"-o {args.output}: is the log itself. Give another name.")
    summary = replay(args.log, settings, args.output, args.realtime)
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
    }
    text = json.dumps(table, indent=2)
    if path == "-":
        print(text)
        return
    whole.write(path, text + "\n", "--json")

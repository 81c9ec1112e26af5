"""`twin replay`: a recorded voyage through the same objects; twice gives the same bytes."""

import argparse

from twin import whole
from twin.cli import guarded
from twin.commands import arguments
from twin.commands.typed_again import command_of
from twin.commands.verb_output import lines_to, typed
from twin.errors import UsageError
from twin.live import ending
from twin.live.log_replay import replay, summary_lines
from twin.live.onto_bus import replay_onto_bus
from twin.live.replay_record import ReplayRecord
from twin.live.signals import config

TO_BUS = "say it on the bus at the voyage's pace, for viewers; space or Ctrl-Z pauses, + and - set it, q ends"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("log", metavar="LOG.mcap", help="a log of the twin, an imported voyage, or a log of Keelson scalars")
    arguments.output(parser, "OUT.mcap", "write what the twin said, and what it heard, to a new log", False)
    add("--config", metavar="TWIN.toml", help="settings (default: as `twin run` without any)")
    arguments.ship(parser, "ship file or name of a bundled ship, instead of the settings' own", False)
    arguments.flag(parser, "--realtime", "as fast as the voyage was, not as fast as possible")
    arguments.flag(parser, "--to-bus", TO_BUS)
    add("--speed", type=float, metavar="X", help="with --to-bus: so many times as fast")
    add("--listen", metavar="PLACE", help="with --to-bus: where, instead of the settings' tcp/127.0.0.1:7447")
    arguments.as_json(parser, "write the summary as JSON, - for standard output")
    arguments.report(parser)


def run(args: argparse.Namespace) -> int:
    settings = config.load(args.config)
    settings = settings.but("ship.file", args.ship) if args.ship else settings
    if args.to_bus:
        settings = settings.but("bus.listen", args.listen) if args.listen else settings
        ending.ends_the_process(lambda: guarded(lambda: _sail(args, settings)))
    if args.speed is not None or args.listen:
        raise UsageError("--speed and --listen are for --to-bus; as fast as the voyage was: --realtime.")
    return _sail(args, settings)


def _sail(args: argparse.Namespace, settings: config.Settings) -> int:
    record, speed = ReplayRecord() if args.report else None, 1.0 if args.speed is None else args.speed
    if args.to_bus:
        found = replay_onto_bus(args.log, settings, args.output, speed, record)
    else:
        found = replay(args.log, settings, args.output, args.realtime, record=record)
    if args.json:
        whole.write_json(found.as_json(), args.json)
    if record:
        from twin.report.replay_page import replay_page

        whole.write(args.report, replay_page(found, record, command_of(args)), "--report")
    compare = typed("compare", args.output or args.log, "--ship", settings["ship.file"])
    print("\n".join([*summary_lines(found), f"next: {compare}"]), file=lines_to(args))
    return 0

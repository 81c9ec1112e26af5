"""`twin history`: the ladder of what was added to a ship's model, and how far the error fell each time."""

import argparse

from twin import whole
from twin.commands import arguments
from twin.commands.verb_output import lines_to, typed
from twin.physics.ship import load
from twin.recording.jsonable import plain
from twin.study.update.ladder import SCHEMA_VERSION, ladder, terminal_lines


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("ship", metavar="SHIP.toml")
    arguments.as_json(parser, "the same as JSON ('-': standard output)")
    arguments.report(parser)


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    if args.json:
        present = [type(e).__name__ for e in ship.effects]
        whole.write_json(
            plain(
                {
                    "schema_version": SCHEMA_VERSION,
                    "ship": ship.name,
                    "effects": present,
                    "history": ladder(ship),
                }
            ),
            args.json,
        )
    page = lines_to(args)
    print("\n".join(terminal_lines(ship)), file=page)
    if args.report:
        from twin.report.history_page import history_page

        whole.write(args.report, history_page(ship), "--report")
        print(f"wrote {args.report}", file=page)
    print(f"next: {typed('compare', 'VOYAGE.mcap', '--ship', args.ship)}", file=page)
    return 0

"""`twin remove`: take an effect out of a ship's model again; its history remembers both."""

import argparse

from twin import whole
from twin.commands import arguments
from twin.commands.verb_output import lines_to, typed
from twin.physics.ship import load
from twin.recording.ship_file_writer import save
from twin.study.update.removal import SCHEMA_VERSION, remove


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("effects", metavar="EFFECT", nargs="+", help="effects of the ship file")
    arguments.ship(parser, None)
    arguments.output(parser, "SHIP2.toml", "the ship file without them")
    arguments.force(parser)
    arguments.as_json(parser)


def run(args: argparse.Namespace) -> int:
    ship = remove(load(args.ship), args.effects)
    save(ship, args.output, args.ship)
    left = [type(e).__name__ for e in ship.effects]
    if args.json:
        answer = {
            "schema_version": SCHEMA_VERSION,
            "ship": ship.name,
            "removed": args.effects,
            "effects": left,
            "output": args.output,
        }
        whole.write_json(answer, args.json)
    page = lines_to(args)
    print(
        f"removed {', '.join(args.effects)}; left: {', '.join(left) or 'the core alone'}\nwrote "
        f"{args.output}",
        file=page,
    )
    print(f"next: {typed('history', args.output)}", file=page)
    return 0

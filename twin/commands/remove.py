"""`twin remove`: take an effect out of a ship's model again; its history remembers both."""

import argparse
import sys

from twin import whole
from twin.physics.ship import load
from twin.recording.import_voyage import write_json
from twin.recording.ship_file import save
from twin.study.update.remove import SCHEMA_VERSION, remove


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("effects", metavar="EFFECT", nargs="+", help="effects of the ship file")
    parser.add_argument("--ship", metavar="SHIP.toml", required=True)
    parser.add_argument(
        "-o", "--output", metavar="SHIP2.toml", required=True, help="the ship file without them"
    )
    parser.add_argument("--force", action="store_true", help="write over a file that is there")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")


def run(args: argparse.Namespace) -> int:
    whole.not_over(args.output, [args.ship], args.force)
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
        write_json(answer, args.json)
    page = sys.stderr if args.json == "-" else sys.stdout
    print(
        f"removed {', '.join(args.effects)}; left: {', '.join(left) or 'the core alone'}\nwrote "
        f"{args.output}",
        file=page,
    )
    print(f"next: twin history {args.output}", file=page)
    return 0

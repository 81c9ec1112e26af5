"""`twin remove`: take an effect out of a ship's model again; her history remembers both."""

import argparse
import datetime
import sys
from collections.abc import Sequence
from dataclasses import replace

from twin.errors import SettingsError, did_you_mean
from twin.physics.ship import Ship, load, save
from twin.recording.import_voyage import write_json

SCHEMA_VERSION = 1


def remove(ship: Ship, names: Sequence[str]) -> Ship:
    """The ship without these effects; SettingsError when she has no such effect."""
    present = [type(e).__name__ for e in ship.effects]
    for name in names:
        if name not in present:
            has = did_you_mean(name, present) if present else " It has no effects at all."
            raise SettingsError(f"{ship.name} has no effect {name!r}.{has}")
    notes = dict(ship.notes)
    notes["effects"] = {k: v for k, v in notes.get("effects", {}).items() if k not in names}
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    notes["history"] = [*notes.get("history", []), {"date": today, "removed": list(names)}]
    return replace(ship.without_effects(*names), notes=notes)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("effects", metavar="EFFECT", nargs="+", help="effects of the ship file")
    parser.add_argument("--ship", metavar="SHIP.toml", required=True)
    parser.add_argument(
        "-o", "--output", metavar="SHIP2.toml", required=True, help="the ship file without them"
    )
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")


def run(args: argparse.Namespace) -> int:
    ship = remove(load(args.ship), args.effects)
    save(ship, args.output)
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

"""`twin effects`: the catalogue in words, formulas and numbers, for the terminal, for programs and for
docs/effects.md."""

import argparse
import json
import shutil

from twin import whole
from twin.physics.effects import BUILT_IN, UNNAMED, catalogue, find
from twin.physics.ship import load
from twin.report.catalogue import as_table, one, overview, page


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "name",
        nargs="?",
        metavar="NAME",
        help="one effect, with its formula; without it, the whole catalogue",
    )
    parser.add_argument("--ship", metavar="SHIP.toml", help="give boxes and sizes in this ship's own units")
    parser.add_argument("--json", metavar="FILE", help="the same as JSON; - is standard output")
    parser.add_argument(
        "--markdown", metavar="FILE", help="the whole catalogue as a page (docs/effects.md is made by it)"
    )


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship) if args.ship else None
    by_form = [e for e in UNNAMED if e.__name__ == args.name]
    chosen = by_form or ([find(args.name)] if args.name else list(catalogue().values()))
    if args.json:
        _write(
            args.json,
            json.dumps(
                {"schema_version": 1, "effects": [as_table(e, ship) for e in chosen]},
                indent=2,
                ensure_ascii=False,
            ),
        )
    if args.markdown:
        _write(args.markdown, page(list(BUILT_IN)))
    if "-" not in (args.json, args.markdown):
        width = min(120, shutil.get_terminal_size((100, 24)).columns)
        print(one(chosen[0], ship, width) if args.name else overview(chosen, width))
    return 0


def _write(path: str, text: str) -> None:
    if path == "-":
        print(text)
        return
    whole.write(path, text.rstrip("\n") + "\n", "--json or --markdown")

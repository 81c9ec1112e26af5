"""`twin effects`: the catalogue in words, formulas and numbers, for the terminal, for programs and for
docs/effects.md."""

import argparse
import json
import shutil

from twin import whole
from twin.api.effect_check import check_effect
from twin.commands import arguments
from twin.errors import SettingsError
from twin.physics.effects import BUILT_IN
from twin.physics.ship import Ship, load
from twin.report.catalogue import as_json, chosen, one, overview, page

WIDEST = 120  # characters of a line on a terminal


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add, page = parser.add_argument, "the whole catalogue as a page (docs/effects.md is made by it)"
    one = "one effect, with its formula; without it, the whole catalogue"
    add("name", nargs="?", metavar="NAME", help=one)
    arguments.ship(parser, "give boxes and sizes in this ship's own units", required=False)
    arguments.as_json(parser, "the same as JSON; - is standard output")
    own = "what is wrong with an effect of one's own: an installed one, or a file NAME.py"
    add("--check", metavar="NAME", help=own)
    add("--markdown", metavar="FILE", help=page)


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship) if args.ship else None
    if args.check:
        return _checked(args.check, ship, args.json)
    effects = chosen(args.name, ship)
    if args.json:
        text = json.dumps(as_json(effects, ship), indent=2, ensure_ascii=False)
        whole.put(args.json, text, "--json or --markdown")
    if args.markdown:
        whole.put(args.markdown, page(list(BUILT_IN)), "--json or --markdown")
    if "-" not in (args.json, args.markdown):
        width = min(WIDEST, shutil.get_terminal_size((100, 24)).columns)
        print(one(effects[0], ship, width) if args.name else overview(effects, width))
    return 0


def _checked(name: str, ship: Ship | None, json_path: str | None) -> int:
    """Exit code 5 when the effect must be mended."""
    found = check_effect(name, ship=ship)
    if json_path:
        whole.write_json(found.to_dict(), json_path, "--json or --markdown")
    if json_path != "-":
        print("\n".join(found.text()))
    if wrong := found.wrong:
        said = f"{len(wrong)} of {len(found.answers)} to mend: {', '.join(wrong)}"
        raise SettingsError(f"{found.effect.__name__}: {said}.")
    return 0

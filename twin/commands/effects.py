"""`twin effects`: the catalogue in words, formulas and numbers, for the terminal, for programs and for
docs/effects.md."""

import argparse
import json
import shutil

from twin import whole
from twin.errors import SettingsError
from twin.physics.effects import BUILT_IN
from twin.physics.ship import Ship, load
from twin.report.catalogue import as_json, chosen, one, overview, page

WIDEST = 120  # characters of a line on a terminal


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
        "--check",
        metavar="NAME",
        help="what is wrong with an effect of one's own: an installed one, or a file NAME.py",
    )
    parser.add_argument(
        "--markdown", metavar="FILE", help="the whole catalogue as a page (docs/effects.md is made by it)"
    )


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
    from twin.report.effect_check import answers_as_json, check, find_to_check

    effect = find_to_check(name)
    answers = check(effect, ship)
    if json_path:
        text = json.dumps(answers_as_json(effect, answers), indent=2)
        whole.put(json_path, text, "--json or --markdown")
    if json_path != "-":
        print("\n".join([effect.__name__, *(a.line() for a in answers)]))
    if wrong := [a.question for a in answers if a.ok is False]:
        raise SettingsError(f"{effect.__name__}: {len(wrong)} of {len(answers)} to mend: {', '.join(wrong)}.")
    return 0

"""`twin effects`: the catalogue in words, formulas and numbers, for the terminal, for programs and for
docs/effects.md."""

import argparse
import json
import shutil

import numpy  # noqa: F401 (where it is loaded, an installed effect that does not work on arrays is left out)

from twin import whole
from twin.errors import SettingsError
from twin.physics.effect import Effect
from twin.physics.effects import BUILT_IN, OF_ACTUATORS, UNNAMED, catalogue, find, of_ship
from twin.physics.ship import Ship, load
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
    by_form = [e for e in UNNAMED if e.__name__ == args.name]
    family: list[type[Effect]] = [e for e in OF_ACTUATORS if e.__name__ == args.name]
    mine = of_ship(ship).values() if ship else catalogue().values()
    chosen: list[type[Effect]] = by_form or family or ([find(args.name)] if args.name else list(mine))
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


def _checked(name: str, ship: Ship | None, json_path: str | None) -> int:
    """Exit code 5 when the effect must be mended."""
    from twin.report.effect_check import check, find_to_check

    effect = find_to_check(name)
    answers = check(effect, ship)
    wrong = [a.question for a in answers if a.ok is False]
    if json_path:
        _write(
            json_path,
            json.dumps(
                {"schema_version": 1, "effect": effect.__name__, "answers": [a._asdict() for a in answers]},
                indent=2,
            ),
        )
    if json_path != "-":
        print("\n".join([effect.__name__, *(a.line() for a in answers)]))
    if wrong:
        raise SettingsError(f"{effect.__name__}: {len(wrong)} of {len(answers)} to mend: {', '.join(wrong)}.")
    return 0


def _write(path: str, text: str) -> None:
    if path == "-":
        print(text)
        return
    whole.write(path, text.rstrip("\n") + "\n", "--json or --markdown")

"""`twin add`: put a named effect into a ship's model, fit it, and prove that what was not fitted is likelier
with it."""

import argparse
import os
import sys
from collections.abc import Sequence
from typing import Any

from twin import whole
from twin.errors import SettingsError, ThresholdError, UsageError
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import Ship, load, save
from twin.recording.checks import losses
from twin.recording.import_voyage import write_json
from twin.study.reference.sailed import Sailed, read_all
from twin.study.update.add import Added, add
from twin.study.update.added import refused, told

EPILOG = """example:
  twin add Wind --ship alma2.toml --voyage monday.mcap --held-out tuesday.mcap -o alma3.toml --report add.html

Only the numbers of the named effects are written; the core stays as it is. Without --held-out the last third
of every voyage is held back from the fit and used to judge it; with --cross-validated all of every voyage is
fitted, and each third of it judged with numbers fitted to the others. Exit code 3: what was held out is not
clearly likelier, nothing is written (--force writes all the same), and how much more would tell is said;
4: a voyage cannot be used, or lacks what the effect needs; 5: no such effect, or the ship file is not valid.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument("effects", metavar="EFFECT", nargs="+", help="names from `twin effects`")
    parser.add_argument("--ship", metavar="SHIP.toml", required=True, help="the model it is added to")
    parser.add_argument(
        "--voyage", metavar="VOYAGE", nargs="+", action="extend", required=True, help="voyages to fit it on"
    )
    parser.add_argument(
        "--held-out", metavar="VOYAGE", nargs="+", action="extend", default=[], help="voyages to judge it by"
    )
    parser.add_argument(
        "--cross-validated",
        action="store_true",
        help="judge every third of the voyages by a fit to the others",
    )
    parser.add_argument("-o", "--output", metavar="SHIP2.toml", required=True, help="the better ship file")
    parser.add_argument(
        "--force",
        action="store_true",
        help="write it although it is not proved, or over the ship file itself",
    )
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--report", metavar="FILE.html", help="one self-contained page with the plots")


def run(args: argparse.Namespace) -> int:
    whole.not_over(args.output, [args.ship], args.force)
    if args.held_out and args.cross_validated:
        raise UsageError("--held-out and --cross-validated: a proof rests on one of them. Leave one out.")
    effects = [find(name) for name in dict.fromkeys(args.effects)]
    ship = load(args.ship)
    for path in (*args.voyage, *args.held_out):
        if os.path.exists(args.output) and os.path.exists(path) and os.path.samefile(path, args.output):
            raise SettingsError(f"-o {args.output}: is one of the voyages. Choose another name.")
    every = read_all([*args.voyage, *args.held_out], ship)
    sailed, held_out = every[: len(args.voyage)], every[len(args.voyage) :]
    made = add(
        ship,
        effects,
        sailed,
        held_out,
        args.force,
        args.cross_validated,
        lambda text: print(f"{text} ...", file=sys.stderr),
    )
    result = made.result | {
        "command": _command(args),
        "files": {"ship": args.ship, "voyages": args.voyage, "judged": args.held_out or args.voyage},
        "output": args.output if made.result["accepted"] else None,
    }
    page = sys.stderr if args.json == "-" or not result["accepted"] else sys.stdout
    print("\n".join([*told(result), *losses(result["data_checks"])]), file=page)
    if result["accepted"]:
        save(made.ship, args.output)
        print(f"\nwrote {args.output}", file=page)
    if args.json:
        write_json(result, args.json)
    if args.report:
        _report(args.report, made, ship, result, held_out or sailed)
        print(f"wrote {args.report}", file=page)
    if not result["accepted"]:
        raise ThresholdError(
            f"{refused(made.proof, made.fall)} {args.output} was not written. --force writes it."
        )
    print(f"next: twin compare {' '.join(args.held_out or args.voyage)} --ship {args.output}", file=page)
    return 0


def _report(path: str, made: Added, ship: Ship, result: dict[str, Any], shown: Sequence[Sailed]) -> None:
    from twin import report

    history = made.ship.notes["history"]
    report.write(
        path,
        "add",
        result | {"history": history},
        made.held,
        made.model,
        before=Model.of(ship),
        voyages=[s.voyage for s in shown],
    )


def _command(args: argparse.Namespace) -> str:
    command = f"twin add {' '.join(args.effects)} --ship {args.ship} --voyage {' '.join(args.voyage)}"
    command += (f" --held-out {' '.join(args.held_out)}") * bool(
        args.held_out
    ) + " --cross-validated" * args.cross_validated
    return f"{command} -o {args.output}"

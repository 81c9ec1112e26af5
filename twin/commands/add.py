"""`twin add`: put a named effect into a ship's model, fit it, and prove that what was not fitted is likelier
with it."""

import argparse
import sys

from twin import whole
from twin.api.update import of_sailed
from twin.commands.answer import asked, lines_to, progress
from twin.errors import ThresholdError, UsageError
from twin.physics.effects import find
from twin.physics.ship import load
from twin.recording.import_voyage import write_json
from twin.recording.ship_file import save
from twin.study.reference.sailed import read_all

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
    effects, ship, paths = [find(n) for n in dict.fromkeys(args.effects)], load(args.ship), args.voyage
    whole.not_onto(args.output, [*paths, *args.held_out], "one of the voyages")
    every = read_all([*paths, *args.held_out], ship)
    voyages, held_out = every[: len(paths)], every[len(paths) :]
    made = of_sailed(ship, effects, voyages, held_out, args.cross_validated, args.force, progress)
    judged = args.held_out or paths
    found = asked(made, _command(args), ship=args.ship, voyages=paths, judged=judged)
    found = found.with_keys(output=args.output if made.accepted else None)
    page = lines_to(args) if made.accepted else sys.stderr
    print("\n".join(found.text()), file=page)
    if made.accepted:
        save(made.ship, args.output, args.ship)
        print(f"\nwrote {args.output}", file=page)
    if args.json:
        write_json(found.to_dict(), args.json)
    if args.report:
        found.write_page(args.report)
        print(f"wrote {args.report}", file=page)
    if not made.accepted:
        raise ThresholdError(f"{made.refused} {args.output} was not written. --force writes it.")
    print(f"next: twin compare {' '.join(judged)} --ship {args.output}", file=page)
    return 0


def _command(args: argparse.Namespace) -> str:
    command = f"twin add {' '.join(args.effects)} --ship {args.ship} --voyage {' '.join(args.voyage)}"
    held_out = f" --held-out {' '.join(args.held_out)}" * bool(args.held_out)
    return f"{command}{held_out}{' --cross-validated' * args.cross_validated} -o {args.output}"

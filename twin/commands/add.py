"""`twin add`: put an effect into a ship's model, fit it, and prove what was not fitted likelier with it."""

import argparse
import sys

from twin.api.update import check_proof, of_sailed
from twin.commands import arguments
from twin.commands.typed_again import with_request
from twin.commands.verb_output import files, lines_to, progress, typed, wrote
from twin.errors import ThresholdError
from twin.physics.effects import find_for
from twin.physics.ship import load
from twin.recording.ship_file_writer import save
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
    arguments.after(parser, EPILOG)
    parser.add_argument("effects", metavar="EFFECT", nargs="+", help="names from `twin effects`")
    arguments.ship(parser, "the model it is added to")
    arguments.more_voyages(parser, "--voyage", "voyages to fit it on", required=True, again=True)
    arguments.more_voyages(parser, "--held-out", "voyages to judge it by", again=True)
    arguments.flag(parser, "--cross-validated", "judge every third of the voyages by a fit to the others")
    arguments.output(parser, "SHIP2.toml", "the better ship file")
    arguments.force(parser, "write it although it is not proved, or over the ship file itself")
    arguments.as_json(parser)
    arguments.report(parser)


def run(args: argparse.Namespace) -> int:
    check_proof(args.held_out, args.cross_validated)
    ship, paths = load(args.ship), args.voyage
    effects = [find_for(n, ship) for n in dict.fromkeys(args.effects)]
    every = read_all([*paths, *args.held_out], ship, progress)
    fit, kept, judged = every[: len(paths)], every[len(paths) :], args.held_out or paths
    made = of_sailed(ship, effects, fit, kept, args.cross_validated, args.force, progress)
    found = with_request(made, args, ship=args.ship, voyages=paths, judged=judged)
    found = found.with_keys(output=args.output if made.accepted else None)
    print("\n".join(found.text()), file=(page := lines_to(args) if made.accepted else sys.stderr))
    if made.accepted:
        save(made.ship, args.output, args.ship)
        print(f"\n{wrote(args.output)}", file=page)
    files(args, found, page)
    if not made.accepted:
        raise ThresholdError(f"{made.refused} {args.output} was not written. --force writes it.")
    print(f"next: {typed('compare', *judged, '--ship', args.output)}", file=page)
    return 0

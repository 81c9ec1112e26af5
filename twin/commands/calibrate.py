"""`twin calibrate`: fits the core to reference voyages, and learns what a model of this kind still leaves
unexplained."""

import argparse
import sys

from twin.api.calibration import of_sailed
from twin.commands import arguments
from twin.commands.verb_output import files, lines_to, progress, typed, wrote
from twin.errors import ThresholdError
from twin.physics.ship import load
from twin.recording.ship_file_writer import save
from twin.study.reference.sailed import read_all

EPILOG = """Reference voyages are ones on which nothing was wrong, in calm weather or with the wind recorded:
zigzags, circles, speed changes.
Without --held-out the last third of three or more voyages is held back to measure the error, and fitted in
the end; of one or two the last 30 % of each is held back and not fitted. What is given with --held-out is
never fitted, and is no reference voyage.
The standard errors, and the structural error that remains, are stored in the ship file: they keep an
imperfect model from being called a missing effect. Exit code 3: the error on what was not used for the fit
grew, so that no ship file is written; 4: a voyage cannot be used; 5: the ship file is not valid.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.after(parser, EPILOG)
    reference = "reference voyages: nothing wrong, manoeuvring, calm or with the wind recorded"
    arguments.voyages(parser, reference)
    arguments.ship(parser, "the ship file to start from, or a bundled ship's name")
    arguments.output(parser, "SHIP2.toml", "the calibrated ship file")
    arguments.more_voyages(parser, "--held-out", "voyages on which the error is measured")
    arguments.force(parser)
    arguments.as_json(parser)
    arguments.report(parser)


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    every = read_all(args.voyages, ship, progress)
    found = of_sailed(ship, every, read_all(args.held_out, ship, progress), progress)
    if found.accepted:
        save(found.ship, args.output, args.ship)
    written = str(args.output) if found.accepted else None
    files(args, found.with_keys(output=written), lines_to(args))
    if not found.accepted:
        print("\n".join(found.text()), file=sys.stderr)
        raise ThresholdError(f"{found.refused} {args.output} was not written.")
    compare = typed("compare", "VOYAGE.mcap", "--ship", args.output, "--report", "compare.html")
    print("\n".join([*found.text(), "", wrote(args.output), f"next: {compare}"]), file=lines_to(args))
    return 0

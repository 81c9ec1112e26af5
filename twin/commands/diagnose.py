"""`twin diagnose`: which physical effect is missing, in newtons, with its confidence, or an honest answer
that is none."""

import argparse

from twin.api.diagnosis import diagnose
from twin.commands import arguments
from twin.commands.next_command import after_diagnose
from twin.commands.typed_again import command_of
from twin.commands.verb_output import answer, lines_to, progress
from twin.live.learning.residual import load as load_residual
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.study.reference.sailed import own_references

EPILOG = """Verdicts: missing (named, lasting causes first, with size and interval, and with what cannot be
told from it), nothing_missing, unknown (something is there that no effect of the catalogue explains;
resembles: what it looks like, where that is known by its form), undecided (the voyages cannot tell; one_of:
the few of which one is surely there; next_manoeuvre: what to sail). JSON has the reason, the facts that
decided and the rivals (docs/diagnosis.md). Water and wind of the voyages stand beside every cause, in a part
of their own (weather). Reference voyages are those of the same ship on which nothing was wrong: they say what
an imperfect model leaves over anyway. Exit code 4: a voyage cannot be used; 5: the ship file is not valid.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.after(parser, EPILOG)
    arguments.voyages(parser, "voyages on which something may be wrong")
    arguments.ship(parser)
    healthy = "voyages of the same ship on which nothing was wrong"
    arguments.more_voyages(parser, "--reference", healthy)
    arguments.as_json(parser)
    arguments.report(parser)
    arguments.flag(parser, "--identifiability", "also say what the first of these voyages can tell at all")
    apart = "also say whether what was learned stands apart from the core"
    parser.add_argument("--residual", metavar="FILE.onnx", help=apart)


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    if args.residual:
        load_residual(args.residual, ship)  # one that must not be used is refused before the work
    voyages, reference = ([read_voyage(p) for p in paths] for paths in (args.voyages, args.reference))
    found = diagnose(ship, voyages, reference=reference, progress=progress)
    files = {"ship": args.ship, "voyages": args.voyages}
    found = found.with_keys(
        command=command_of(args),
        verdict_text=found.sentence,
        files=files,
        calibrated_on=own_references(ship, voyages, args.voyages),
    )
    if args.identifiability or args.residual:
        found = found.with_identifiability(args.residual or None)
    answer(args, found)
    then = after_diagnose(args.voyages, args.ship, found.data, *args.reference)
    print(f"\nnext: {then}", file=lines_to(args))
    return 0

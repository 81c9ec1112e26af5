"""`twin tube`: how far the predictions on board may be off, from reference voyages."""

import argparse

from twin import whole
from twin.api.tube import of_read
from twin.api.voyages import read_voyage
from twin.commands import arguments
from twin.commands.verb_output import lines_to, progress, typed
from twin.physics.ship import load
from twin.recording.ship_file_writer import save
from twin.study.reference.sailed import own_references
from twin.study.reference.tube_lines import terminal_lines

EPILOG = """Voyages on which nothing was wrong and which the model was not calibrated to, in the seas and
loadings it will meet. Each goes through the loop as it runs on board. How far the predictions for 10, 60 and
120 s were off from the measured place and heading, while helm and engine were held, becomes [tube] in the
ship file. `twin run` then says within how many metres and degrees the ship will be with 90 %, and on how many
voyages that rests. 90 % takes nine voyages; fewer promise less, and it is said. Once the model changes (twin
add, twin calibrate) a tube is not used any more: make it again. Exit code 4: a voyage cannot be used; 5: ship
file or settings are not valid.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.after(parser, EPILOG)
    arguments.voyages(parser, "voyages that the model was not calibrated to")
    arguments.ship(parser, "the ship file, or a bundled ship's name")
    settings = "settings of `twin run` on board, if it has any"
    parser.add_argument("--config", metavar="TWIN.toml", help=settings)
    arguments.output(parser, "SHIP2.toml", "the ship file with its tube")
    arguments.force(parser)
    arguments.as_json(parser)


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    voyages = [read_voyage(path) for path in args.voyages]
    done = of_read(ship, voyages, own_references(ship, voyages, args.voyages), args.config, progress)
    save(done.ship, args.output, args.ship)
    result = done.to_dict() | {"output": str(args.output)}
    if args.json:
        whole.write_json(result, args.json)
    page = lines_to(args)
    print("\n".join(terminal_lines(result)), file=page)
    replay = typed("replay", "VOYAGE.mcap", "--ship", args.output)
    print(f"\nwrote {args.output}\nnext: {replay}", file=page)
    return 0

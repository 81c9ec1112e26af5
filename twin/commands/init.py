"""`twin init`: a first model of my ship from what its owner knows; every estimated number says where it comes
from."""

import argparse
import shlex
from pathlib import Path

from twin import whole
from twin.api.first_model import first_model
from twin.commands import arguments
from twin.commands.verb_output import files, lines_to
from twin.num import as_given
from twin.physics.ship import load_actuators, save
from twin.study.first_model.first_estimate import OPTIONS, REQUIRED

ACTUATORS = (
    "tables [[actuators]] of what drives and steers the ship, where that is not a propeller with a rudder "
    "(docs/actuators.md)"
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="the ship's name")
    for option, doc, lo, hi in OPTIONS:
        said = f"{doc} [{as_given(lo)} to {as_given(hi)}]"
        needed = option in REQUIRED
        parser.add_argument(f"--{option}", type=float, required=needed, metavar="X", help=said)
    parser.add_argument("--actuators", metavar="FILE.toml", help=ACTUATORS)
    arguments.output(parser, "SHIP.toml", "the ship file to write")
    arguments.force(parser)
    arguments.as_json(parser, "the same as JSON; - is standard output")
    arguments.report(parser)


def run(args: argparse.Namespace) -> int:
    whole.not_over(args.output, args.force)
    names = [option.replace("-", "_") for option, *_ in OPTIONS]
    known = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    parts = load_actuators(args.actuators) if args.actuators else ()
    made = first_model(args.name, actuators=parts, **known)
    save(made.ship, args.output)
    better = Path(args.output).with_name(Path(args.output).stem + "-calibrated.toml")
    calibrate = f"twin calibrate REF-*.mcap {shlex.join(['--ship', str(args.output), '-o', str(better)])}"
    said = [*made.text(), "", f"written: {args.output}"]
    said += [f"next:    twin import each reference voyage, then {calibrate}"]
    print("\n".join(said), file=lines_to(args))
    files(args, made.with_keys(file=str(args.output)), lines_to(args))
    return 0

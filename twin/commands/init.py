"""`twin init`: a first model of my ship from what its owner knows; every estimated number says where it comes
from."""

import argparse
import sys
from pathlib import Path

from twin import whole
from twin.num import as_given
from twin.physics.ship import load_actuators, save
from twin.recording.import_voyage import write_json
from twin.study.first_model.first_trial import doubts, sea_trial, summary
from twin.study.first_model.init import OPTIONS, REQUIRED, first_model


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="the ship's name")
    for option, doc, lo, hi in OPTIONS:
        parser.add_argument(
            f"--{option}",
            type=float,
            required=option in REQUIRED,
            metavar="X",
            help=f"{doc} [{as_given(lo)} to {as_given(hi)}]",
        )
    parser.add_argument(
        "--actuators",
        metavar="FILE.toml",
        help="tables [[actuators]] of what drives and steers the ship, where that is not a propeller with a "
        "rudder (docs/actuators.md)",
    )
    parser.add_argument("-o", "--output", required=True, metavar="SHIP.toml", help="the ship file to write")
    parser.add_argument("--force", action="store_true", help="write over a file that is there")
    parser.add_argument("--json", metavar="FILE", help="the same as JSON; - is standard output")


def run(args: argparse.Namespace) -> int:
    whole.not_over(args.output, [args.output], args.force)
    given = {option: getattr(args, option.replace("-", "_")) for option, *_ in OPTIONS}
    ship, warnings = first_model(args.name, given, load_actuators(args.actuators) if args.actuators else ())
    figures = sea_trial(ship)
    warnings += doubts(figures, ship.C_b)
    save(ship, args.output)
    out = sys.stderr if args.json == "-" else sys.stdout
    print(summary(ship, figures, warnings, given), file=out)
    print(f"\nwritten: {args.output}", file=out)
    print(
        f"next:    twin import each reference voyage, then twin calibrate REF-*.mcap --ship {args.output} "
        f"-o {_next(args.output)}",
        file=out,
    )
    if args.json:
        write_json(
            {
                "schema_version": 1,
                "ship": ship.name,
                "file": str(args.output),
                "trial": figures,
                "warnings": warnings,
            },
            args.json,
        )
    return 0


def _next(path: str) -> str:
    return str(Path(path).with_name(Path(path).stem + "-calibrated.toml"))

"""`twin compare`: model against measurement, open loop from the measured state: how wrong, and where."""

import argparse

from twin.api.comparison import of_sailed
from twin.commands import arguments
from twin.commands.next_command import after_compare
from twin.commands.typed_again import with_request
from twin.commands.verb_output import answer, lines_to, progress
from twin.errors import ThresholdError
from twin.physics.ship import load
from twin.study.prediction.openloop import HORIZONS_S
from twin.study.prediction.thresholds import passed, positive, threshold
from twin.study.reference.sailed import read_all

EPILOG = """example:
  twin compare monday.mcap tuesday.mcap --ship alma.toml --report compare.html
  twin compare monday.mcap --ship alma.toml --fail-above position_mae_m=50 --json -

Metrics of --fail-above: position_mae_m, lateral_mae_m, heading_mae_deg (at the longest horizon, or at one:
position_mae_m@60), noise_units (position error over the expected one), unexplained_force.surge|sway|yaw,
learned_share, channels.COLUMN.mae. Exit code 3: a threshold is not met; 4: a voyage cannot be used; 5: the
ship file is not valid.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.after(parser, EPILOG)
    arguments.voyages(parser, "voyages: MCAP logs, or tables with the column names of docs/import.md")
    arguments.ship(parser)
    add, seconds = parser.add_argument, "seconds ahead (repeat; default 10, 60, 120)"
    add("--horizon", metavar="S", type=positive, action="append", help=seconds)
    add("--residual", metavar="FILE.onnx", help="what was learned, added as the loop adds it")
    limits = {"type": threshold, "action": "append", "default": []}
    add("--fail-above", metavar="METRIC=VALUE", help="exit 3 above VALUE", **limits)  # type: ignore[arg-type]
    arguments.as_json(parser)
    arguments.report(parser)


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    voyages = read_all(args.voyages, ship, progress)
    progress("predicting")
    found = of_sailed(ship, voyages, args.horizon or HORIZONS_S, args.residual)
    answer(args, with_request(found, args, ship=args.ship, voyages=args.voyages))
    print(f"\nnext: {after_compare(args.voyages, args.ship, found.data)}", file=lines_to(args))
    if unmet := passed(found.to_dict(), args.fail_above):
        raise ThresholdError(f"{'; '.join(unmet)}.")
    return 0

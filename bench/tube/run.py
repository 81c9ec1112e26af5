"""Is the prediction tube kept on voyages, in seas and on hulls that it was not calibrated with?
`twin-bench tube --work .tube`

Voyages of the reference sea go through the loop that the service builds (network, adaptation and
certificate on). Each is judged by a tube of all other voyages of its hull, and by tubes of other hulls; a
tube around dead reckoning (speed over ground and rate of turn kept) is made in the same way."""

import argparse
from itertools import permutations
from pathlib import Path

from bench import bench_output
from bench.options import positive
from bench.tube.interval_score import CoverageRow, across, left_out
from bench.tube.page import page
from bench.tube.sailing import voyages
from twin.recording.jsonable import plain

SHIPS = ("kvlcc2", "container", "kvlcc2_model", "usv")
VOYAGES = 64


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--ships",
        nargs="+",
        type=ship,
        metavar="SHIP[=VOYAGES]",
        default=[ship(name) for name in SHIPS],
        help=f"{', '.join(SHIPS)}, and how many voyages of each (default: {VOYAGES})",
    )
    parser.add_argument(
        "--work",
        metavar="FOLDER",
        type=Path,
        default=Path(".tube"),
        help="what was sailed is kept here, and taken from here",
    )
    bench_output.add_arguments(parser)


def ship(text: str) -> tuple[str, int]:
    """A ship and how many voyages of it; ValueError for any other text."""
    name, given, count = text.partition("=")
    if name not in SHIPS:
        raise ValueError(name)
    return name, positive(count) if given else VOYAGES


def run(args: argparse.Namespace) -> int:
    sailed = {hull: voyages(hull, count, args.work) for hull, count in args.ships}
    own: dict[str, dict[str, list[CoverageRow]]] = {}
    for hull, found in sailed.items():
        bench_output.tell(f"{hull}: each voyage by the tube of the others")
        own[hull] = {who: left_out(hull, found, who) for who in ("model", "reckoning")}
    others = {f"{a} -> {b}": across(a, b, sailed) for a, b in permutations(sailed, 2)}
    result = {
        "schema_version": 1,
        "voyages": {hull: len(found) for hull, found in sailed.items()},
        "left_one_out": {
            h: {w: [r._asdict() for r in rows] for w, rows in o.items()} for h, o in own.items()
        },
        "other_hull": {pair: [r._asdict() for r in rows] for pair, rows in others.items()},
    }
    text = page({hull: len(found) for hull, found in sailed.items()}, own, others)
    bench_output.give(args, plain(result), text, bench_output.kept(args.page))
    return 0

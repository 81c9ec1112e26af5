"""`twin fleet`: many ships and their voyages, one table and one page, ranked by what is wrong."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from twin.api.fleet import fleet
from twin.commands.typed_again import command_of
from twin.commands.verb_output import answer, lines_to, progress, typed
from twin.study.fleet.spread import cores

EPILOG = """example:
  twin fleet ships/ -o results --report fleet.html
  twin fleet fleet.toml -o results --scheduler tcp://10.0.0.5:8786 --json -

FLEET is a TOML that lists calibrated ships and their voyages (docs/fleet.md), or a folder in which every
folder holds one ship file and the voyages of that ship. Answers are kept in RESULTS/rows.parquet, a row a
cause and a voyage; a run that was interrupted goes on where it stopped, and later only what changed is asked:
a ship file, a voyage, its map, the version. A voyage that cannot be used is a row that says so. Exit code 4:
no voyage could be used; 5: the list or a ship file is not valid, or a ship was never calibrated.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument("fleet", metavar="FLEET", help="a list of ships (TOML), or a folder of their folders")
    parser.add_argument(
        "-o", metavar="RESULTS", dest="folder", required=True, help="the folder that keeps the answers"
    )
    parser.add_argument(
        "--workers", metavar="N", type=int, default=cores(), help="processes (default: as many as processors)"
    )
    parser.add_argument("--scheduler", metavar="ADDRESS", help="a dask scheduler in place of own processes")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--report", "--html", metavar="FILE.html", help="one self-contained page")


def run(args: argparse.Namespace) -> int:
    found = fleet(args.fleet, args.folder, workers=args.workers, scheduler=args.scheduler, progress=progress)
    rows = str(Path(args.folder) / "rows.parquet")
    answer(args, found.with_keys(command=command_of(args), rows=rows))
    print(f"\n{rows} has every row\nnext: {_next(args, found.data['ships'])}", file=lines_to(args))
    return 0


def _next(args: argparse.Namespace, ships: Sequence[Mapping[str, Any]]) -> str:
    """The first ship that was judged is looked at."""
    first = next((s for s in ships if s["latest"]), None)
    if first is None:
        judged = "a ship is not judged by those that it was calibrated on"
        return f"add voyages to judge ({judged}), then {command_of(args)}"
    return typed("diagnose", first["latest"]["file"], "--ship", first["file"], "--report", "diagnose.html")

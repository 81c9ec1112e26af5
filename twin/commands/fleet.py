"""`twin fleet`: many ships and their voyages, one table and one page, ranked by what is wrong."""

import argparse
from importlib.util import find_spec
from pathlib import Path

from twin.api.fleet import fleet
from twin.commands.verb_output import answer, lines_to, progress, typed
from twin.errors import TwinError, UsageError
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
    if args.workers < 1:
        raise UsageError(f"--workers {args.workers}: at least 1 is needed.")
    if (args.scheduler or args.workers > 1) and find_spec("distributed") is None:
        raise TwinError(
            "more than one worker needs the package distributed. Run: pip install 'shiptwin[fleet]'"
        )
    found = fleet(args.fleet, args.folder, workers=args.workers, scheduler=args.scheduler, progress=progress)
    command = typed("fleet", args.fleet, "-o", args.folder)
    rows = str(Path(args.folder) / "rows.parquet")
    answer(args, found.with_keys(command=command, rows=rows))
    first = found.data["ships"][0]
    look = typed("diagnose", first["latest"]["file"], "--ship", first["file"], "--report", "diagnose.html")
    print(f"\n{rows} has every row\nnext: {look}", file=lines_to(args))
    return 0

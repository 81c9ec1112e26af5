"""The fleet's command: `python -m bench.fleet run FOLDER` asks ships and writes a row a voyage; `table`
makes the
figures, `fit` the decision."""

import argparse
import json
import sys
import time
import traceback
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bench.fleet.hull_families import FAMILIES
from bench.fleet.voyage_plan import VOYAGES
from twin.study.fleet.spread import spread

ROWS = "rows.jsonl"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "folder", type=Path, help="rows are added to FOLDER/rows.jsonl, ships kept in FOLDER/ships"
    )
    parser.add_argument(
        "--families",
        nargs="+",
        default=list(FAMILIES),
        choices=list(FAMILIES),
        metavar="FAMILY",
        help=f"of {', '.join(FAMILIES)}",
    )
    parser.add_argument("--seeds", type=_span, default="0-3", help="ships of each family: FIRST-LAST")
    parser.add_argument(
        "--voyages", type=int, default=VOYAGES, help="asked of each ship (default: %(default)s)"
    )
    parser.add_argument("--workers", type=int, default=1, help="processes (default: %(default)s)")
    parser.add_argument(
        "--seconds", type=float, default=float("inf"), help="begin no case after so many seconds"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="a dask scheduler in the place of own processes"
    )


def _span(text: str) -> range:
    first, _, last = text.partition("-")
    try:
        return range(int(first), int(last or first) + 1)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no FIRST-LAST, as in 0-3") from None


def done(folder: Path) -> frozenset[str]:
    """Keys of the rows that are there."""
    path = folder / ROWS
    return frozenset(row["key"] for row in read(path)) if path.exists() else frozenset()


def read(path: Path) -> Iterator[dict[str, Any]]:
    """Rows of a file; a last line that was cut off is left out."""
    for line in path.read_text().splitlines():
        try:
            yield json.loads(line)
        except json.JSONDecodeError:
            continue


def one_ship(job: tuple[str, int, int, str, frozenset[str], float]) -> list[str]:
    """Rows of one ship, as lines."""
    family, seed, voyages, folder, known, until = job
    out: list[str] = []
    if time.time() > until:
        return out
    try:
        from bench.fleet.fact_rows import rows

        for row in rows(family, seed, voyages, Path(folder) / "ships", known, until):
            out.append(json.dumps(row))
            part = Path(folder) / "parts" / f"{family}-{seed}.jsonl"
            part.parent.mkdir(parents=True, exist_ok=True)
            with part.open("a") as file:
                file.write(out[-1] + "\n")
    except Exception:
        print(f"{family} {seed}: {traceback.format_exc()}", file=sys.stderr, flush=True)
    return out


def run(args: argparse.Namespace) -> int:
    seeds = _span(args.seeds) if isinstance(args.seeds, str) else args.seeds
    args.folder.mkdir(parents=True, exist_ok=True)
    gather(args.folder)
    known, until = done(args.folder), time.time() + args.seconds
    jobs = [(f, s, args.voyages, str(args.folder), known, until) for s in seeds for f in args.families]
    began, count = time.time(), 0
    try:
        for lines in _each(jobs, args):
            count += len(lines)
            with (args.folder / ROWS).open("a") as file:
                file.writelines(line + "\n" for line in lines)
            if lines:
                print(f"{count} cases in {time.time() - began:.0f} s", flush=True)
    finally:
        gather(args.folder)
    return 0


def gather(folder: Path) -> None:
    """Rows of ships that were cut off, put with the others; each key once."""
    rows: dict[str, dict[str, Any]] = {}
    for path in [folder / ROWS, *sorted((folder / "parts").glob("*.jsonl"))]:
        if path.exists():
            rows |= {row["key"]: row for row in read(path)}
    if rows:
        (folder / ROWS).write_text("".join(json.dumps(row) + "\n" for row in rows.values()))


def _each(jobs: list[Any], args: argparse.Namespace) -> Iterator[list[str]]:
    for one in spread(one_ship, jobs, args.workers, args.scheduler):
        if one.why:
            print(f"{one.job[0]} {one.job[1]}: {one.why}", file=sys.stderr, flush=True)
        yield one.answer or []

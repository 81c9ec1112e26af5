"""What `run` left in its folders: the calibrated ships, and the answers of each."""

import argparse
import json
import pickle
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from bench.fleet.plausibility import build
from bench.fleet.random_ship import RandomShip
from bench.fleet.run import ROWS, read
from bench.fleet.voyage_plan import FleetCase
from twin.errors import DataError
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.study.fleet.spread import spread

Job = tuple[str, dict[str, Any]]  # a folder of `run`, and an answer in it


def of_families(folders: Sequence[Path]) -> list[Path]:
    """Their files, FAMILY-SEED.pickle. DataError: fewer than two families, of which none can be left out."""
    paths = [path for folder in folders for path in sorted((folder / "ships").glob("*.pickle"))]
    families = len({path.stem.rpartition("-")[0] for path in paths})
    if families < 2:
        raise DataError(f"{folders[0]}: ships of {families} families in ships/; two at least.")
    return paths


def answers(folder: Path) -> list[dict[str, Any]]:
    """The answers of a folder, a voyage each. DataError: there are none."""
    paths = [folder / ROWS, *sorted((folder / "parts").glob("*.jsonl"))]
    rows = {row["key"]: row for path in paths if path.exists() for row in read(path)}
    if not rows:
        raise DataError(f"{folder}: no answers in it. Make them: python -m bench.fleet run {folder}")
    return [row for row in rows.values() if "missing" in row]


def kept(path: Path) -> list[dict[str, Any]]:
    """Rows that `--keep` put into docs/results."""
    return list(read(path))


def opened(job: Job) -> tuple[RandomShip, FleetCase, Ship]:
    """The random ship of an answer, what was hidden, and the ship as its owner has calibrated it."""
    folder, row = job
    family, seed, number = row["family"], row["seed"], int(row["key"].rpartition("-")[2])
    model, _ = pickle.loads((Path(folder) / "ships" / f"{family}-{seed}.pickle").read_bytes())
    return build(family, seed), FleetCase(family, seed, number, row["kind"], row["hidden"]), model


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of a verb that asks more about the answers of `run`."""
    parser.add_argument("folder", type=Path, nargs="+", help="of `run`: its rows and its calibrated ships")
    parser.add_argument("--workers", type=int, default=1, help="processes (default: %(default)s)")
    parser.add_argument("--keep", action="store_true", help="put the rows into docs/results, for the page")


def ask_again(
    folders: Sequence[Path],
    name: str,
    wanted: Callable[[dict[str, Any]], bool],
    ask: Callable[[Job], dict[str, Any]],
    workers: int,
) -> Iterator[dict[str, Any]]:
    """A row for each wanted answer of each folder, added to FOLDER/NAME as it comes; those that are there
    are not asked again. One whose process ended is told, and no row: it is asked the next time."""
    for folder in folders:
        path = folder / name
        done = {row["key"] for row in read(path)} if path.exists() else set()
        jobs = [(str(folder), r) for r in answers(folder) if r["key"] not in done and wanted(r)]
        for one in spread(ask, jobs, workers):
            if one.answer is None:
                print(f"{one.job[1]['key']}: {one.why}", file=sys.stderr)
                continue
            with path.open("a") as file:
                file.write(json.dumps(plain(one.answer)) + "\n")
        yield from read(path) if path.exists() else ()

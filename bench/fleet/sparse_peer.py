"""pysindy asked of the fleet's single causes, beside the twin's answers in FOLDER/rows.jsonl: does the
largest term of its sparse regression point at the cause? `python -m bench.fleet peer FOLDER`.

It starts from the same calibrated ship and the same track (bench/league/peer.py). It is asked less: it gives
no size with a unit, cannot say that nothing is missing, and is not asked of causes for which it has no
term."""

import argparse
import json
import pickle
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from bench.fleet import answer_score
from bench.fleet.answer_score import Row, share
from bench.fleet.decided_again import decided
from bench.fleet.fact_rows import voyage
from bench.fleet.fleet_page import lines, rows_of
from bench.fleet.plausibility import build
from bench.fleet.voyage_plan import FleetCase, sailed
from bench.league.peer import POINTS_AT, peer
from twin.physics.model import Model
from twin.study.track.track import track

ANSWERS = "peer.jsonl"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, help="of `run`; answers are added to FOLDER/peer.jsonl")


def run(args: argparse.Namespace) -> int:
    """What was asked before is not asked again. 1 without pysindy."""
    out = args.folder / ANSWERS
    lines_there = out.read_text().splitlines() if out.exists() else []
    known = {(a := json.loads(line))["key"]: a for line in lines_there}
    asked = [
        r for r in rows_of([args.folder]) if len(r["hidden"]) == 1 and set(r["hidden"]) <= set(POINTS_AT)
    ]
    for row in (r for r in asked if r["key"] not in known):
        said = _of_row(args.folder, row)
        if said is None:
            print("pysindy is not installed: pip install -e '.[peers]'")
            return 1
        known[row["key"]] = said
        with out.open("a") as file:
            file.write(json.dumps(said) + "\n")
    print("\n".join(page([decided(r) for r in asked], known)))
    return 0


def _of_row(folder: Path, row: Row) -> dict[str, Any] | None:
    ship, _ = pickle.loads((folder / "ships" / f"{row['family']}-{row['seed']}.pickle").read_bytes())
    number = int(row["key"].rpartition("-")[2])
    case = FleetCase(row["family"], row["seed"], number, row["kind"], row["hidden"])
    one, began = voyage(sailed(build(row["family"], row["seed"]), case)), time.process_time()
    said = peer(track(one, ship), Model.of(ship), next(iter(row["hidden"])))
    return said and {"key": row["key"], **said, "cpu_s": time.process_time() - began}


def page(rows: Sequence[Row], known: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A line a cause, and all: how often the twin named it alone, and the peer's term pointed at it."""
    body = list(_body(rows, known))
    head = ("hidden alone", "the twin", "pysindy", "the twin, gains 10 %", "pysindy, gains 10 %")
    return lines("A peer", "", head, body)


def _body(rows: Sequence[Row], known: Mapping[str, Mapping[str, Any]]) -> Iterator[tuple[Any, ...]]:
    for name in (*sorted({next(iter(r["hidden"])) for r in rows}), "all"):
        own = [r for r in rows if name in (*r["hidden"], "all")]
        gains = [r for r in own if answer_score.gains(r)]
        yield (
            name,
            *(
                mark
                for of in (own, gains)
                for mark in (
                    share([answer_score.right(r) for r in of]),
                    share([known[r["key"]]["right"] for r in of]),
                )
            ),
        )

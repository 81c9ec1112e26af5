"""`python -m bench.fleet partly FOLDER`: what is said of a cause that acts for a part of a voyage only.

Growth, a worn propeller and a worn rudder in the second half, a tow in the middle third, on a voyage of each
calibrated ship in FOLDER/ships. Nothing that belongs to a ship begins between two buoys: right is what names
none. A row a voyage is added to FOLDER/partly.jsonl, so that a run that was ended goes on."""

import argparse
import json
import pickle
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from bench.fleet.answer_score import causes
from bench.fleet.fact_rows import voyage
from bench.fleet.kept_ships import of_families
from bench.fleet.plausibility import build
from bench.fleet.run import read
from bench.fleet.voyage_plan import FleetCase, sailed
from twin import whole
from twin.recording.jsonable import plain
from twin.study.diagnosis.decision import decide
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.diagnosis.facts import Facts
from twin.study.fleet.spread import spread

PARTLY = "partly.jsonl"
ACTING = {  # cause -> the share of the voyage from which, and to which, it acts
    "HullFouling": (0.5, 1.0),
    "PropellerWear": (0.5, 1.0),
    "RudderWear": (0.5, 1.0),
    "TowForce": (0.33, 0.67),
}
FIRST = 100  # number of such a voyage of a ship: none of `run` has it
ANSWERS = ("no name", "itself", "another name", "nothing missing")
Job = tuple[str, str]  # a calibrated ship's file, and a cause


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, help="of `run`: its calibrated ships")
    parser.add_argument("--workers", type=int, default=1, help="processes (default: %(default)s)")
    parser.add_argument("--page", metavar="FILE.md", help="the table as a page")


def run(args: argparse.Namespace) -> int:
    """A row a ship and a cause; then the table of all that are there."""
    path = args.folder / PARTLY
    done = {(r["ship"], r["hidden"]) for r in read(path)} if path.exists() else set()
    jobs = [
        (str(p), name) for p in of_families([args.folder]) for name in ACTING if (p.stem, name) not in done
    ]
    for one in spread(_answered, jobs, args.workers):
        row = one.answer or {"ship": Path(one.job[0]).stem, "hidden": one.job[1], "failed": one.why}
        with path.open("a") as file:
            file.write(json.dumps(plain(row)) + "\n")
    lines = table(list(read(path)))
    print("\n".join(lines))
    if args.page:
        whole.write(args.page, "\n".join(["# Causes that act for a part of a voyage", "", *lines, ""]))
    return 0


def _answered(job: Job) -> dict[str, Any]:
    path, name = Path(job[0]), job[1]
    family, _, seed = path.stem.rpartition("-")
    model, _ = pickle.loads(path.read_bytes())
    ship = build(family, int(seed))
    case = FleetCase(family, int(seed), FIRST + list(ACTING).index(name), "single", {name: 1.0})
    result = diagnose([voyage(sailed(ship, case, ACTING[name]))], model).result
    said = {k: result[k] for k in ("verdict", "reason", "missing", "facts")}
    return {"ship": path.stem, "hidden": name} | said


def answer(reason: str, missing: Sequence[str], hidden: str) -> str:
    """Which of ANSWERS this is; weather that is named beside it never counts."""
    named = causes(list(missing))
    if not named:
        return "nothing missing" if reason in ("nothing", "weather_only") else "no name"
    return "itself" if hidden in named else "another name"


def unasked(facts: Facts) -> Facts:
    """The same, were no size compared from part to part."""
    return replace(facts, causes=tuple(replace(c, varies=0.0) for c in facts.causes))


def table(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """By what is hidden, how often each answer was given; and were sizes not compared from part to part."""
    lines = ["| hidden | asked | " + " | ".join(ANSWERS) + " |", "|---" * (2 + len(ANSWERS)) + "|"]
    for name in ACTING:
        some = [r for r in rows if r["hidden"] == name and "facts" in r]
        counts = []
        for kind in ANSWERS:
            now = sum(answer(r["reason"], r["missing"], name) == kind for r in some)
            before = sum(_without(r) == kind for r in some)
            counts.append(f"{now} ({before})")
        lines.append(f"| {name} | {len(some)} | {' | '.join(counts)} |")
    failed = sum("failed" in r for r in rows)
    return [
        *lines,
        "",
        "In brackets: were sizes not compared from part to part.",
        f"Could not be asked: {failed}.",
    ]


def _without(row: Mapping[str, Any]) -> str:
    decided = decide(unasked(Facts.read(row["facts"])))
    return answer(decided.reason, decided.missing, row["hidden"])

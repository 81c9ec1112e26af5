"""The league at work: questions in rounds, many processes, every answer written down as it comes."""

import argparse
import json
import multiprocessing
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from bench.league import league_score, plan
from bench.league.examiner import judge
from bench.league.league_ships import LeagueFleet, make, ships_of
from bench.league.league_voyages import BATCH, forget, sail
from bench.league.plan import Question

PART = 60  # questions whose voyages are sailed before they are judged
FULL_ROUND: dict[str, Any] = {"hulls": plan.HULLS, "seeds": 5, "strengths": plan.STRENGTHS}
QUICK: dict[str, Any] = {"hulls": ("kvlcc2",), "seeds": 1, "strengths": (1.0,)}


class League:
    """Rounds of questions: sail them, judge them, write each answer down, forget the voyages."""

    def __init__(self, args: argparse.Namespace, folder: Path) -> None:
        quick = QUICK if args.quick else FULL_ROUND
        self.hulls: Sequence[str] = args.hull or quick["hulls"]
        self.strengths: Sequence[float] = args.strength or quick["strengths"]
        self.fleet, self.jobs = (args.duration, args.references, not args.quick), args.jobs
        asked = (args.effect, args.quick, args.duration, args.every, args.first_seed)
        seeds = args.seeds or quick["seeds"]
        self.seeds = list(range(args.first_seed, args.first_seed + seeds))
        rounds = plan.questions(self.hulls, seeds, self.strengths, *asked)
        self.rounds = [[q for q in r if q.kind in args.kind] for r in rounds]
        self.folder, self.log = folder, folder / "answers.jsonl"
        self.ends = time.monotonic() + 60.0 * args.minutes if args.minutes else float("inf")
        self.done: dict[str, dict[str, Any]] = {}

    def play(self) -> list[dict[str, Any]]:
        """Everything, or what fits into --minutes; all answers, in the plan's order."""
        self.folder.mkdir(parents=True, exist_ok=True)
        if self.log.exists():
            rows = map(json.loads, self.log.read_text().splitlines())
            self.done = {row["key"]: row for row in rows if row["verdict"] != "failed"}
        with ProcessPoolExecutor(self.jobs, multiprocessing.get_context("spawn")) as pool:
            self._ships(pool)
            for number, questions in enumerate(self.rounds, 1):
                self._round(pool, [q for q in questions if q.key not in self.done], number)
        return [self.done[q.key] for r in self.rounds for q in r if q.key in self.done]

    def _ships(self, pool: ProcessPoolExecutor) -> None:
        """Calibrate the ships that are not there yet, then forget their voyages."""
        fleets = [LeagueFleet(h, *self.fleet) for h in self.hulls if not (self.folder / f"{h}.ship").exists()]
        cases = [c for f in fleets for c in f.cases()]
        self._sail(pool, cases)
        self._wait([pool.submit(make, f, self.folder) for f in fleets], f"{len(fleets)} ships calibrated")
        forget(cases, self.folder)

    def _round(self, pool: ProcessPoolExecutor, questions: list[Question], number: int) -> None:
        """Small batches in the plan's order, so that a run that ends early has judged what it has sailed."""
        for part in _parts(questions, PART):
            if time.monotonic() > self.ends:
                return
            cases = [c for q in part for c in q.voyages()]
            self._sail(pool, cases)
            jobs = {pool.submit(_answer, q, self.folder, self.ends): q for q in part}
            for count, job in enumerate(as_completed(jobs), 1):
                self._note(job, f"round {number}: {count}/{len(part)}")
            forget(cases, self.folder)

    def _note(self, job: "Future[dict[str, Any] | None]", where: str) -> None:
        row = job.result()
        if row is not None:
            self.done[row["key"]] = row
            with open(self.log, "a") as log:
                log.write(json.dumps(row) + "\n")
            print(f"{where} {row['key']}: {league_score.called(row)}", file=sys.stderr, flush=True)

    def _sail(self, pool: ProcessPoolExecutor, cases: list[Any]) -> None:
        parts = _parts(cases, max(1, min(BATCH, -(-len(cases) // self.jobs))))
        self._wait([pool.submit(sail, part, self.folder) for part in parts], f"{len(cases)} voyages sailed")

    def _wait(self, jobs: "Sequence[Future[None]]", said: str) -> None:
        for job in jobs:
            job.result()
        print(said, file=sys.stderr, flush=True)

    def calibrations(self) -> dict[str, Any]:
        return {
            h: ships_of(h, self.folder)["calibration"]
            for h in self.hulls
            if (self.folder / f"{h}.ship").exists()
        }

    def facts(self, rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
        """What was run, of what."""
        planned = sum(len(r) for r in self.rounds)
        return {
            "references": self.fleet[1],
            "hulls": list(self.hulls),
            "strengths": list(self.strengths),
            "seeds": self.seeds,
            "planned": planned,
            "answered": len(rows),
            "failed": sum(r["verdict"] == "failed" for r in rows),
        }


def _answer(question: Question, folder: Path, ends: float) -> dict[str, Any] | None:
    return judge(question, folder) if time.monotonic() < ends else None


def _parts(items: list[Any], size: int) -> Iterator[list[Any]]:
    return iter([items[i : i + size] for i in range(0, len(items), size)])

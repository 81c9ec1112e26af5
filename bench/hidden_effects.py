"""The hidden-effect league: voyages of the reference sea with something hidden, and what the diagnosis makes of them."""

import argparse
import json
import multiprocessing
import os
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from bench import league_plan as plan
from bench import league_score as score
from bench.league_judge import judge
from bench.league_page import page
from bench.league_plan import Question
from bench.league_sea import BATCH, fleet_cases, forget, make_ships, sail
from twin.errors import SettingsError
from twin.physics.effects import catalogue

EPILOG = """example:
  twin-bench hidden-effects --quick --json -
  twin-bench hidden-effects --seeds 5 --jobs 2 --resume league --out docs/results/hidden-effects.md

Each ship is a bundled ship file, calibrated in memory on calm reference voyages of the reference sea. With --resume a run
that was stopped goes on where it ended; without it the voyages are deleted at the end.
"""
PART = 60  # questions whose voyages are sailed before they are judged
QUICK = {"hulls": ("kvlcc2",), "seeds": 1, "strengths": (1.0,)}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("--quick", action="store_true", help="one hull, one seed, strength 1, some 12 voyages")
    parser.add_argument("--hull", nargs="+", choices=plan.HULLS, help="default: all")
    parser.add_argument("--seeds", type=int, help="rounds; each is a fair sample (default 5)")
    parser.add_argument("--strength", nargs="+", type=float, help="default: 1 and 0.5")
    parser.add_argument("--effect", nargs="+", default=[], help="hide only these of the catalogue")
    parser.add_argument("--kind", nargs="+", choices=plan.KINDS, default=plan.KINDS, help="only these questions")
    parser.add_argument("--duration", type=float, metavar="S", help="of a voyage (default 1800, usv 300)")
    parser.add_argument("--minutes", type=float, help="begin no voyage after so many minutes")
    parser.add_argument("--jobs", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--resume", metavar="DIR", help="keep what is done here, and go on from it")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--out", metavar="FILE.md", help="the result as a page, FILE.json beside it")


def run(args: argparse.Namespace) -> int:
    strange = [n for n in args.effect if n not in catalogue()]
    if strange:
        raise SettingsError(f"--effect {strange[0]}: no such effect. Known: {', '.join(catalogue())}.")
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # a voyage a process, a thread a process
    with tempfile.TemporaryDirectory() as spare:
        league = League(args, Path(args.resume or spare))
        rows = league.play()
        result = score.contract(rows) | {"run": league.facts(rows)}
        text = page(rows, result, league.calibrations())
    _write(args, result, text)
    return 0


def _write(args: argparse.Namespace, result: dict[str, Any], text: str) -> None:
    data = json.dumps(result, indent=1)
    if args.out:
        Path(args.out).write_text(text)
        Path(args.out).with_suffix(".json").write_text(data + "\n")
    if args.json == "-":
        print(data)
    else:
        print(text)
        if args.json:
            Path(args.json).write_text(data + "\n")


class League:
    """Rounds of questions: sail them, judge them, write each answer down, forget the voyages."""

    def __init__(self, args: argparse.Namespace, folder: Path) -> None:
        quick = QUICK if args.quick else {"hulls": plan.HULLS, "seeds": 5, "strengths": plan.STRENGTHS}
        self.hulls: Sequence[str] = args.hull or quick["hulls"]
        self.seeds: int = args.seeds or quick["seeds"]
        self.strengths: Sequence[float] = args.strength or quick["strengths"]
        self.duration_s, self.few, self.jobs = args.duration, args.quick, args.jobs
        rounds = plan.questions(self.hulls, self.seeds, self.strengths, args.effect, args.quick, args.duration)
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
        hulls = [h for h in self.hulls if not (self.folder / f"{h}.ship").exists()]
        cases = [c for h in hulls for c in fleet_cases(h, self.duration_s, self.few)]
        self._sail(pool, cases)
        jobs = [pool.submit(make_ships, h, self.folder, self.duration_s, self.few) for h in hulls]
        self._wait(jobs, f"{len(hulls)} ships calibrated")
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
            print(f"{where} {row['key']}: {score.called(row)}", file=sys.stderr, flush=True)

    def _sail(self, pool: ProcessPoolExecutor, cases: list[Any]) -> None:
        parts = _parts(cases, max(1, min(BATCH, -(-len(cases) // self.jobs))))
        self._wait([pool.submit(sail, part, self.folder) for part in parts], f"{len(cases)} voyages sailed")

    def _wait(self, jobs: "Sequence[Future[None]]", said: str) -> None:
        for job in jobs:
            job.result()
        print(said, file=sys.stderr, flush=True)

    def calibrations(self) -> dict[str, Any]:
        from bench.league_sea import ships_of

        return {h: ships_of(h, self.folder)["calibration"] for h in self.hulls if (self.folder / f"{h}.ship").exists()}

    def facts(self, rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
        """Exactly what was run."""
        planned = sum(len(r) for r in self.rounds)
        seeds = sorted({r["seed"] for r in rows if r["kind"] == "effect"})
        return {
            "command": "twin-bench hidden-effects" + " --quick" * self.few + f" --seeds {self.seeds} --jobs {self.jobs}",
            "hulls": list(self.hulls), "strengths": list(self.strengths), "seeds": seeds,
            "planned": planned, "answered": len(rows), "failed": sum(r["verdict"] == "failed" for r in rows),
        }  # fmt: skip


def _answer(question: Question, folder: Path, ends: float) -> dict[str, Any] | None:
    return judge(question, folder) if time.monotonic() < ends else None


def _parts(items: list[Any], size: int) -> Iterator[list[Any]]:
    return iter([items[i : i + size] for i in range(0, len(items), size)])

"""`python -m bench.fleet together FOLDER`: what more voyages are worth.

Each answered voyage is asked again together with one and with two more of the same ship, on other days and
courses, with what is wrong of ship and instruments as it was. Cases whose day is what is hidden are left out:
another day has not got it. A row a case is added to FOLDER/together.jsonl, so that a run that was ended goes
on."""

import argparse
import json
import time
from collections.abc import Mapping, Sequence
from typing import Any

from bench.fleet.answer_score import alarm, causes, gains, right, share, wrong_names
from bench.fleet.fact_rows import voyage
from bench.fleet.hidden_causes import OF_THE_VOYAGE
from bench.fleet.keep_answers import RESULTS
from bench.fleet.kept_ships import Job, answers, ask_again, opened
from bench.fleet.kept_ships import add_arguments as of_answers
from bench.fleet.voyage_plan import SHARES, sailed, sailed_again
from twin.errors import TwinError
from twin.recording.jsonable import plain
from twin.study.diagnosis.effect_diagnosis import diagnose

TOGETHER = "together.jsonl"
KEPT_TOGETHER = RESULTS / "fleet_together.jsonl"
COUNTS = ("2", "3")  # voyages asked together
ANSWER = ("verdict", "reason", "missing", "weather", "failed")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    of_answers(parser)
    parser.add_argument(
        "--kinds", nargs="+", default=list(SHARES), choices=list(SHARES), help="cases asked (default: all)"
    )


def run(args: argparse.Namespace) -> int:
    """A row a case; then the table of all that are there, beside the answers of the first voyage alone."""

    def wanted(row: Mapping[str, Any]) -> bool:
        return row["kind"] in args.kinds and not set(row["hidden"]) & set(OF_THE_VOYAGE)

    asked = {r["key"]: r for r in ask_again(args.folder, TOGETHER, wanted, _both_answers, args.workers)}
    alone = {r["key"]: r for folder in args.folder for r in answers(folder) if r["key"] in asked}
    rows = [_kept(alone[key], row) for key, row in asked.items()]
    print("\n".join(table(rows)))
    if args.keep:
        KEPT_TOGETHER.write_text("".join(json.dumps(plain(row)) + "\n" for row in rows))
    return 0


def _kept(alone: Mapping[str, Any], asked: Mapping[str, Any]) -> dict[str, Any]:
    """What a case hides, and its answers by how many voyages were asked together."""
    said = {"1": alone} | {n: asked[n] for n in COUNTS}
    answers = {n: {k: a[k] for k in ANSWER if k in a} for n, a in said.items()}
    return {k: alone[k] for k in ("key", "kind", "hidden")} | {"gains": gains(alone)} | answers


def _both_answers(job: Job) -> dict[str, Any]:
    """The answers about two voyages and about three."""
    ship, case, model = opened(job)
    voyages = [voyage(sailed(ship, case))]
    voyages += [voyage(sailed_again(ship, case, k, False)) for k in range(int(COUNTS[-1]) - 1)]
    out: dict[str, Any] = {"key": case.key}
    for n in COUNTS:
        began = time.process_time()
        try:
            result = diagnose(voyages[: int(n)], model).result
            said = {k: result[k] for k in ANSWER if k in result}
        except TwinError as error:
            said = {"failed": str(error)}
        out[n] = said | {"cpu_s": time.process_time() - began}
    return out


def table(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """By kind, the answers about one voyage, about two, and about three, of the same cases."""
    whole = [r for r in rows if all("verdict" in r[n] for n in COUNTS)]
    lines = [
        "| | one voyage | " + " | ".join(f"{n} together" for n in COUNTS) + " |",
        "|---" * (2 + len(COUNTS)) + "|",
    ]
    for what, kind, gained, mark in (
        ("single cause, gains", "single", True, right),
        ("single cause", "single", False, right),
        ("single cause, a wrong name", "single", False, lambda r: bool(wrong_names(r))),
        ("pair, gains", "pair", True, right),
        ("pair", "pair", False, right),
        ("healthy, a cause is named", "nothing", False, lambda r: bool(causes(r["missing"]))),
        ("healthy, an alarm", "nothing", False, alarm),
    ):
        some = [r for r in whole if r["kind"] == kind and (r["gains"] or not gained)]
        marks = (share([mark({**r, **r[n]}) for r in some]) for n in ("1", *COUNTS))
        lines.append(f"| {what} | {' | '.join(map(str, marks))} |")
    return [*lines, "", f"Could not be asked: {len(rows) - len(whole)} of {len(rows)}."]

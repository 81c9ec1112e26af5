"""`python -m bench.fleet together FOLDER`: what more voyages are worth.

Each answered voyage is asked again together with one and with two more of the same ship, on other days and
courses, with what is wrong of ship and instruments as it was. Cases whose day is what is hidden are left out:
another day has not got it. A row a case is added to FOLDER/together.jsonl, so that a run that was ended goes
on."""

import argparse
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from bench.fleet.answer_score import alarm, causes, gains, right, share
from bench.fleet.fact_rows import KEPT_FACTS, voyage
from bench.fleet.hidden_causes import OF_THE_VOYAGE
from bench.fleet.kept_ships import Job, answers, ask_again, opened
from bench.fleet.voyage_plan import SHARES, sailed, sailed_again
from twin.errors import TwinError
from twin.study.diagnosis.effect_diagnosis import diagnose

TOGETHER = "together.jsonl"
MORE = (1, 2)  # voyages beside the first


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="+", help="of `run`: its rows and its calibrated ships")
    parser.add_argument("--workers", type=int, default=1, help="processes (default: %(default)s)")
    parser.add_argument(
        "--kinds", nargs="+", default=list(SHARES), choices=list(SHARES), help="cases asked (default: all)"
    )


def run(args: argparse.Namespace) -> int:
    """A row a case; then the table of all that are there, beside the answers of the first voyage alone."""
    asked = ask_again(
        args.folder, TOGETHER, lambda r: r["kind"] in args.kinds and _lasts(r), _asked, args.workers
    )
    rows = {r["key"]: r for r in asked}
    alone = {r["key"]: r for folder in args.folder for r in answers(folder) if r["key"] in rows}
    print("\n".join(table(alone, rows)))
    return 0


def _lasts(row: Mapping[str, Any]) -> bool:
    return not set(row["hidden"]) & set(OF_THE_VOYAGE)


def _asked(job: Job) -> dict[str, Any]:
    """The answers about two voyages and about three."""
    ship, case, model = opened(job)
    voyages = [voyage(sailed(ship, case))]
    voyages += [voyage(sailed_again(ship, case, k, False)) for k in range(max(MORE))]
    out: dict[str, Any] = {"key": case.key}
    for more in MORE:
        began = time.process_time()
        try:
            result = diagnose(voyages[: 1 + more], model).result
            said = {k: result[k] for k in KEPT_FACTS if k in result}
        except TwinError as error:
            said = {"failed": str(error)}
        out[str(1 + more)] = said | {"cpu_s": time.process_time() - began}
    return out


def table(alone: Mapping[str, dict[str, Any]], rows: Mapping[str, dict[str, Any]]) -> list[str]:
    """By kind, the answers about one voyage, about two, and about three, of the same cases."""
    counts = [str(1 + more) for more in MORE]
    keys = [k for k, r in rows.items() if all("verdict" in r.get(n, ()) for n in counts)]
    said = [{k: alone[k] for k in keys}] + [{k: alone[k] | rows[k][n] for k in keys} for n in counts]
    lines = [
        "| | one voyage | " + " | ".join(f"{n} together" for n in counts) + " |",
        "|---" * (2 + len(MORE)) + "|",
    ]
    for what, chosen, mark in (
        ("single, gains", lambda r: r["kind"] == "single" and gains(r), right),
        ("single, all", lambda r: r["kind"] == "single", right),
        ("single: a wrong name", lambda r: r["kind"] == "single", _names_wrong),
        ("pair, gains", lambda r: r["kind"] == "pair" and gains(r), right),
        ("triple, gains", lambda r: r["kind"] == "triple" and gains(r), right),
        ("healthy: a cause is named", lambda r: r["kind"] == "nothing", lambda r: bool(causes(r["missing"]))),
        ("healthy: an alarm", lambda r: r["kind"] == "nothing", alarm),
        ("outside the catalogue", lambda r: r["kind"] == "outside", right),
    ):
        some = [k for k in keys if chosen(alone[k])]
        lines.append(f"| {what} | " + " | ".join(str(share([mark(s[k]) for k in some])) for s in said) + " |")
    return [*lines, "", f"Could not be asked: {len(rows) - len(keys)} of {len(rows)}."]


def _names_wrong(row: Mapping[str, Any]) -> bool:
    return bool(causes(row["missing"]) - set(row["hidden"]))

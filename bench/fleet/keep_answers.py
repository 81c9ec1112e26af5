"""Answers of the fleet put into docs/results, of which `python docs/results_page.py` makes the page on the
judgement: `python -m bench.fleet keep --first FOLDER`; or put beside those, such as voyages of them that were
asked again: `python -m bench.fleet keep --beside --again FOLDER`; or in a table of their own, to which
nothing is fitted: `python -m bench.fleet keep --apart new-ships --first FOLDER`."""

import argparse
import json
from pathlib import Path

from bench.fleet import decision_fit, kept_rows
from bench.fleet.fleet_page import rows_of
from twin.errors import UsageError

RESULTS = Path(__file__).resolve().parents[2] / "docs" / "results"
TABLE, FACTS, FIT = RESULTS / "fleet.csv", RESULTS / "fleet_facts.jsonl", RESULTS / "fleet_fit.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    for asked, about in kept_rows.TIMES.items():
        parser.add_argument(
            f"--{asked}",
            type=Path,
            nargs="*",
            default=[],
            metavar="FOLDER",
            help=f"folders with rows.jsonl of {about}",
        )
    parser.add_argument("--beside", action="store_true", help="put beside what is kept, not in its place")
    parser.add_argument(
        "--apart", metavar="NAME", help="put in NAME.csv and NAME_facts.jsonl, to which nothing is fitted"
    )


def run(args: argparse.Namespace) -> int:
    """The rows put down, and what families of ships ask of the decision for the one that is left out: of
    all voyages, each with its latest answer. (Minutes.)"""
    if not any(getattr(args, asked) for asked in kept_rows.TIMES):
        raise UsageError("no folder of answers is given: --first FOLDER, or --beside --again FOLDER.")
    answers = [(row, asked) for asked in kept_rows.TIMES for row in rows_of(getattr(args, asked))]
    if args.apart:
        kept_rows.write(answers, RESULTS / f"{args.apart}.csv", RESULTS / f"{args.apart}_facts.jsonl")
        return 0
    (kept_rows.write_beside if args.beside else kept_rows.write)(answers, TABLE, FACTS)
    rows = kept_rows.read(TABLE, FACTS)
    fit = decision_fit.chosen(decision_fit.with_facts(kept_rows.together(rows)))
    FIT.write_text(json.dumps(fit, indent=1) + "\n")
    return 0

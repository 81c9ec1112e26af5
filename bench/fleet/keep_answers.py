"""Answers of the fleet put into docs/results, of which `python docs/results_page.py` makes the page on the
judgement: `python -m bench.fleet keep FOLDER`; or those of ships that no fit had seen when they were asked:
`python -m bench.fleet keep FOLDER --new`."""

import argparse
import json
from pathlib import Path

from bench.fleet import decision_fit, kept_rows
from bench.fleet.fleet_page import rows_of

RESULTS = Path(__file__).resolve().parents[2] / "docs" / "results"
FLEET = RESULTS / "fleet.csv", RESULTS / "fleet_facts.jsonl"
NEW_SHIPS = RESULTS / "new-ships.csv", RESULTS / "new-ships_facts.jsonl"
FIT = RESULTS / "fleet_fit.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="+", help="folders with rows.jsonl")
    parser.add_argument(
        "--new",
        nargs="?",
        const=NEW_SHIPS[0].stem,
        metavar="NAME",
        help="of ships that no fit had seen when they were asked: into docs/results/NAME.csv (new-ships)",
    )


def run(args: argparse.Namespace) -> int:
    """The rows put down, and what the forms of hulls ask of the decision for the one that is left out.
    (Minutes.)"""
    new = RESULTS / f"{args.new}.csv", RESULTS / f"{args.new}_facts.jsonl"
    kept_rows.write(rows_of(args.folder), *(new if args.new else FLEET))
    if not args.new:
        fit = decision_fit.chosen(decision_fit.of_one_search(decision_fit.with_facts(kept_rows.read(*FLEET))))
        FIT.write_text(json.dumps(fit, indent=1) + "\n")
    return 0

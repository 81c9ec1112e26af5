"""What the checks of an import say of healthy random ships, whose instruments have their small faults:
`python -m bench.fleet proofs`. A check that calls such a voyage unusable proves what is not so."""

import argparse
from collections import Counter
from collections.abc import Iterator

from bench.fleet.answer_score import share
from bench.fleet.fact_rows import voyage
from bench.fleet.hull_families import FAMILIES
from bench.fleet.plausibility import build
from bench.fleet.voyage_plan import SailedCase, plan, references, sailed
from twin.recording.checks import run_checks

VOYAGES_PLANNED = 8


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--seeds", type=int, default=8, help="ships of each family (default: %(default)s)")


def run(args: argparse.Namespace) -> int:
    """A line a voyage of which something is proved, then how many there are of how many."""
    marks, looks = [], Counter[str]()
    for one in healthy(args.seeds):
        checks = run_checks(voyage(one))
        proved = [c for c in checks if c.unusable]
        looks.update(c.name for c in checks if not c.ok and not c.unusable)
        marks.append(bool(proved))
        for c in proved:
            print(f"{one.name}: {c.name}: {c.text}", flush=True)
    print(f"something is proved wrong: {share(marks)}; asked for a look: {dict(looks) or 'none'}")
    return 0


def healthy(seeds: int) -> Iterator[SailedCase]:
    """The reference voyages of each ship, and those of its plan on which nothing is hidden."""
    for family in FAMILIES:
        for seed in range(seeds):
            ship = build(family, seed)
            yield from references(ship)
            yield from (sailed(ship, c) for c in plan(ship, VOYAGES_PLANNED) if c.kind == "nothing")

"""`twin-bench gap`: the gap from validation to test on several times as many runs as the paper's split has.

Each run of the two parts is sailed again, the same manoeuvre, sea and speed with other seeds, and judged by
the network and the filter that the paper's training runs made: nothing is trained or chosen on the new runs.
What differs between the parts sailed again is their manoeuvres, seas and speeds, and chance; what differs
between validation and itself sailed again is selection, and chance."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from bench import bench_output
from bench.options import positive
from bench.paper import paper_voyages

EPILOG = """example: twin-bench gap --work .paper --markdown docs/results/gap.md

Trains the hybrid first where DIR holds none from `twin-bench paper` (--full: that of its full plan). Exit
code 0: the table is made.
"""
SEED_STRIDE = 10_000  # seeds between one sailing and the next
PAIRS = {
    "validation to test, as in the paper": ("validation", "test"),
    "the same two parts sailed again": ("validation again", "test again"),
    "validation to itself sailed again": ("validation", "validation again"),
    "test to itself sailed again": ("test", "test again"),
}
WORDS = {"hybrid": "hybrid", "analytic_current": "nominal, told the current: never trained"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument("--full", action="store_true", help="the network of `twin-bench paper --full`")
    parser.add_argument(
        "--times",
        metavar="N",
        type=positive,
        default=5,
        help="how often each run is sailed again (%(default)s)",
    )
    parser.add_argument(
        "--work",
        metavar="DIR",
        type=Path,
        default=Path(".paper"),
        help="voyages and checkpoints (%(default)s)",
    )
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    result = compare(args.work, paper_voyages.FULL_PLAN if args.full else paper_voyages.QUICK, args.times)
    bench_output.give(args, result, "\n".join(page(result, args.full)))
    return 0


def compare(work: Path, plan: paper_voyages.PaperPlan, times: int) -> dict[str, Any]:
    """Sail, predict, count."""
    from bench.paper.filter import predict
    from bench.paper.gap import gap
    from bench.paper.lab import course, free
    from bench.paper.models import Workshop
    from bench.paper.nominal_ship import nominal
    from twin.physics.model import Model

    model, shop = Model(nominal()), Workshop.planned(plan, work, bench_output.tell)
    network = shop.taught(model, plan.seeds[0], "hybrid").network
    tuning = shop.tuned(model, network)
    others = again(
        paper_voyages.lessons(plan), len(shop.parts["train"]), len(shop.parts["validation"]), times
    )
    sailed = {
        name: paper_voyages.sail(cases, work / "voyages", bench_output.tell) for name, cases in others.items()
    }
    parts = shop.parts | {name: [course(one, model.ship) for one in some] for name, some in sailed.items()}
    models = {
        "hybrid": lambda cs: predict(cs, model, network, tuning),
        "analytic_current": lambda cs: free(model, None, cs),
    }
    pairs = {said: gap(models, parts[a], parts[b]) for said, (a, b) in PAIRS.items()}
    return {"schema_version": 1, "times": times, "pairs": pairs}


def again(cases: Sequence[Any], train: int, validation: int, times: int) -> dict[str, list[Any]]:
    """The runs of both parts with other seeds, `times` over."""
    parts = {"validation again": cases[train : train + validation], "test again": cases[train + validation :]}
    return {
        name: [replace(c, seed=c.seed + SEED_STRIDE * (k + 1)) for k in range(times) for c in some]
        for name, some in parts.items()
    }


def page(r: dict[str, Any], full: bool) -> list[str]:
    """Markdown."""
    lines = [
        "# The gap from validation to test, on more runs",
        "",
        f"`twin-bench gap{' --full' if full else ''} --times {r['times']}`: each run of the two parts sailed "
        f"again {r['times']} times with other "
        "seeds; nothing trained, tuned or chosen on them. Errors over 120 s, windows every minute; 95 % by "
        "voyage, and by "
        "voyage among those of the same manoeuvre and sea. Paper: at most 4.5 %.",
        "",
        "| compared | runs | model | heading deg | change | 95 % | among like | lateral m | change | 95 % | "
        "among like |",
        "|---" * 11 + "|",
    ]
    for said, found in r["pairs"].items():
        for name, words in WORDS.items():
            cells = []
            for short, digits in (("heading", 3), ("lateral", 2)):
                x = found[name][short]
                cells += [
                    f"{x['validation']:.{digits}f}, {x['test']:.{digits}f}",
                    f"{x['change_percent']:+.1f} %",
                ]
                cells += [
                    f"{low:+.1f} to {high:+.1f} %" for low, high in (x["by_voyage_95"], x["among_like_95"])
                ]
            lines.append(
                f"| {said} | {found['runs']['validation']}, {found['runs']['test']} | {words} | "
                f"{' | '.join(cells)} |"
            )
    return [
        *lines,
        "",
        "Intervals among like are too narrow where a kind has one voyage only, as most kinds "
        "of the paper's parts have.",
    ]

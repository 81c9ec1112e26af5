"""Ten thousand ships try to break the stabilizer's certificate: `twin-bench stability`.

Truth is the ship's own equations with a bounded force added, integrated twice as finely; the observer sees
late, noisy, missing measurements and a hostile network. Disturbance, noise and network are chosen against it
(along its error, held in one corner, square waves, white), all within their bounds. A run that leaves the
operating set is judged until it leaves, and counted. Beside them a few of the twin's own loops
(adversary_loop.py)."""

import argparse
from dataclasses import asdict

from bench import bench_output
from bench.options import positive
from bench.stability.adversary_case import AdversaryCase, certified
from bench.stability.adversary_fleet import AdversaryFleet, AdversaryOutcome, trial
from twin.errors import ThresholdError
from twin.recording.jsonable import plain

ATTACK_RUNS = 15000


CASES = (
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 3000),
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 1000, H_s=2.0),
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 1500, dropouts=True),
    AdversaryCase("kvlcc2", 10.0, (12, 12, 1), 500),
    AdversaryCase("kvlcc2", 50.0, (1, 1, 1), 500),
    AdversaryCase("container", 10.0, (1, 1, 1), 1500),
    AdversaryCase("container", 10.0, (1, 1, 1), 500, dropouts=True),
    AdversaryCase("usv", 50.0, (1, 1, 1), 500),
    AdversaryCase("usv", 50.0, (0, 0, 0), 500, dropouts=True),
    AdversaryCase("usv", 10.0, (0, 0, 0), 500),
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 1000, moving=("RudderWear", "HullFouling")),
    AdversaryCase("container", 10.0, (1, 1, 1), 500, moving=("RudderWear", "Loading")),
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--runs",
        type=positive,
        help=f"runs in all (default: {sum(c.runs for c in CASES)}, of the attack {ATTACK_RUNS})",
    )
    parser.add_argument(
        "--attack",
        action="store_true",
        help="worst-case adversaries instead of random ones, inside the assumptions and outside",
    )
    parser.add_argument("--seed", type=int, default=1)
    bench_output.add_arguments(parser, "--results")


def run(args: argparse.Namespace) -> int:
    """All cases; ThresholdError when a bound was broken inside the operating set."""
    if args.attack:
        from bench.stability.attack.run import attacked

        return attacked(args, args.runs or ATTACK_RUNS)
    args.runs = args.runs or sum(c.runs for c in CASES)
    from bench.stability.adversary_loop import CASES as LOOPS
    from bench.stability.adversary_loop import Loops
    from bench.stability.attack.section import section_of
    from bench.stability.stability_tables import tables

    share = args.runs / sum(c.runs for c in CASES)
    rows, loops = [], []
    for i, case in enumerate(CASES):
        model, c = certified(case)
        fleet = AdversaryFleet(
            model,
            c,
            max(1, round(case.runs * share)),
            args.seed + i,
            case.H_s,
            case.dropouts,
            bool(case.moving),
        )
        rows.append((case, c, _result_line(f"{case.ship} {case.rate_hz:g} Hz", trial(fleet))))
    for i, of_loop in enumerate(LOOPS):
        sailed = Loops(of_loop, max(1, round(of_loop.runs * share)), args.seed + i)
        loops.append(
            (
                of_loop,
                sailed.c,
                _result_line(f"the loop, {of_loop.ship} {of_loop.rate_hz:g} Hz", trial(sailed)),
            )
        )
    cases, own = (
        [{**case._asdict(), **asdict(o), "bound": c.bound, "K": c.K} for case, c, o in some]
        for some in (rows, loops)
    )
    bench_output.give(
        args,
        plain({"schema_version": 1, "cases": cases, "loops": own}),
        tables(rows, loops, args),
        section_of(args.page),
    )
    broken = sum(o.violations for _, _, o in (*rows, *loops))
    if broken:
        raise ThresholdError(
            f"the bound was broken in {broken} samples inside the operating set. Do not use the certificate."
        )
    return 0


def _result_line(what: str, o: AdversaryOutcome) -> AdversaryOutcome:
    bench_output.tell(f"{what}: {o.violations} violations in {o.runs} runs")
    return o

"""`twin-bench stability --attack`: all cases, a table and JSON; a bound that was broken inside ends it."""

import argparse
from typing import Any

from bench import bench_output
from bench.stability.attack.adversary_search import Attacked, CaseAttacked, attack
from bench.stability.attack.attack_section import section
from bench.stability.attack.cases import CASES, groups_of
from bench.stability.attack.section import with_section
from twin import whole
from twin.errors import ThresholdError
from twin.recording.jsonable import plain


def attacked(args: argparse.Namespace, runs: int) -> int:
    """All cases with about so many runs in all; ThresholdError when a bound was broken inside."""
    found = []
    for i, case in enumerate(CASES):
        found.append(attack(case, round(runs / len(CASES)), args.seed + i, groups_of(case)))
        bench_output.tell(_result_line(found[-1]))
    text = section(found, f"twin-bench stability --attack --runs {runs} --seed {args.seed}")
    result = {"schema_version": 1, "seed": args.seed, "cases": [as_table(x) for x in found]}
    bench_output.give(argparse.Namespace(**{**vars(args), "page": None}), plain(result), text)
    if args.page:
        whole.write(args.page, with_section(args.page, text), args.page_option)
    broken = [g for x in found for g in x.groups if g.group.inside and g.violations]
    if broken:
        raise ThresholdError(
            f"the bound was broken in {sum(g.violations for g in broken)} samples inside the assumptions, "
            f"first: {broken[0].first}. Do not use the certificate."
        )
    return 0


def as_table(x: CaseAttacked) -> dict[str, Any]:
    """A case as plain numbers."""
    return {
        **x.case._asdict(),
        "K": x.K,
        "h": x.h,
        "delay_samples": x.delay,
        "inner_steps": x.inner,
        "ticks": x.ticks,
        "bound": x.bound,
        "groups": [_group(g) for g in x.groups],
    }


def _group(g: Attacked) -> dict[str, Any]:
    return {
        "delay": g.group.delay,
        "pattern": g.group.pattern,
        "excess": g.group.excess._asdict(),
        "inside": g.group.inside,
        "runs": g.runs,
        "left": g.left,
        "samples": g.samples,
        "violations": g.violations,
        "of_tube": g.of_tube.tolist(),
        "of_bound": g.of_bound.tolist() if g.bound is not None else None,
        "bound": g.bound,
        "by_pass": {name: ratio.tolist() for name, ratio in g.by_pass.items()},
        "first": g.first,
    }


def _result_line(x: CaseAttacked) -> str:
    inside, outside = (
        sum(g.violations for g in x.groups if g.group.inside is which) for which in (True, False)
    )
    runs = sum(g.runs for g in x.groups)
    return (
        f"{x.case.ship} {x.case.rate_hz:g} Hz: {inside} violations inside, {outside} outside, {runs} runs "
        f"of {x.ticks} ticks, {x.seconds:.0f} s"
    )

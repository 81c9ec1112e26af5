"""`twin-bench endurance`: the service with bus, log, certificate, network and adaptation on the reference
sea, killed at random instants, paused, its wall clock set; the loop that the service builds under a storm of
messages, pauses and set clocks; and under instruments that lie."""

import argparse
import math
import statistics
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from bench import bench_output
from bench.endurance.lies import LIE_AT_S, SECONDS, LieNoticed, lies
from bench.endurance.shocks import Shocked
from bench.endurance.side_by_side import KINDS_OF_SHOCK, ShocksKept, shocked
from bench.endurance.storm import Storm, storm

SIZES_S = (0.05, 0.5, 1.0, 3.0, 10.0, 60.0, math.inf)  # in the tables of pauses and clock steps


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--kills", type=int, default=200, help="kill -9 at a random instant (default: 200)")
    add("--pauses", type=int, default=200, help="SIGSTOP of 0.1 s to 10 min (default: 200)")
    add("--clocks", type=int, default=200, help="steps of the wall clock (default: 200)")
    add("--messages", type=int, default=1_000_000, help="into the loop (default: 1000000)")
    add("--at-once", type=int, default=1, metavar="N", help="services side by side (default: 1)")
    add("--kept", type=Path, default=Path(".endurance"), metavar="DIR", help="goes on there (.endurance)")
    add("--hull", default="kvlcc2", help="of the reference sea (default: kvlcc2)")
    add("--no-lies", action="store_true", help="leave out the instruments that lie")
    add("--weather", default="TS-01", help="under the lies (default: TS-01)")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    parts, result = [f"# Endurance of the service\n\n{(__doc__ or '').strip()}"], dict[str, Any]()
    for name in KINDS_OF_SHOCK:
        if count := getattr(args, name):
            found = shocked(name, count, args.at_once, args.hull, args.kept)
            result[name] = {**found._asdict(), "shocks": [row._asdict() for row in found.shocks]}
            parts.append(of_kills(found) if name == "kills" else of_shocks(name, found))
    if args.messages:
        blown = storm(args.messages)
        result["messages"] = blown._asdict()
        parts.append(of_storm(blown))
    if not args.no_lies:
        told = lies(args.hull, args.weather)
        result["lies"] = [row._asdict() for row in told]
        parts.append(of_lies(args.hull, args.weather, told))
    bench_output.give(args, result, "\n\n".join(parts), bench_output.kept(args.page))
    return 0


def of_kills(found: ShocksKept) -> str:
    made = found.shocks
    lost, start = sorted(k.lost_s for k in made), sorted(k.start_s for k in made)
    return (
        f"## kill -9\n\n{len(made)} of {len(made)} processes were killed and the next one ticked. Lost of "
        f"the log: {statistics.median(lost):.3f} s in the median, {lost[-1]:.3f} at most. From start to the "
        f"first tick: {statistics.median(start):.2f} s in the median, {start[-1]:.2f} at most. Log files "
        f"whole after repair: {found.good} of {found.ended}. At the end the promise was given again."
    )


def of_shocks(name: str, found: ShocksKept) -> str:
    """A row for each range of sizes, and one for each shock after which something was missing."""
    made: list[Shocked] = found.shocks
    lines = [
        f"## {name.capitalize()}",
        "",
        f"{len(made)} of {len(made)} lived through by the process; ended with 0 when told to: "
        f"{found.good} of {found.ended}.",
        "",
        f"| {name} of | number | next tick after s, at most | said | said after s, median and most | "
        "promise back after s, median and most | not back in time | ticks not hybrid, median and most |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for low_s, high_s in pairwise(SIZES_S):
        some = [s for s in made if low_s <= s.size_s < high_s]
        if some:
            size = f"{low_s:g} to {high_s:g} s" if high_s < math.inf else f"{low_s:g} s and more"
            lines.append(f"| {size} | {_row(some)} |")
    short = [s for s in made if s.tick_s is None or s.promise_s is None]
    return "\n".join([*lines, "", *(f"* {s.what}: {s}" for s in short)]).rstrip()


def _row(some: list[Shocked]) -> str:
    said = [s.said_s for s in some if s.said_s is not None]
    return " | ".join(
        (
            str(len(some)),
            _seconds(max((s.tick_s for s in some if s.tick_s is not None), default=None)),
            str(len(said)),
            _middle_and_most(said),
            _middle_and_most([s.promise_s for s in some if s.promise_s is not None]),
            str(sum(s.promise_s is None for s in some)),
            _middle_and_most([s.not_hybrid for s in some], 0),
        )
    )


def _middle_and_most(values: Sequence[float], digits: int = 1) -> str:
    return f"{statistics.median(values):.{digits}f}, {max(values):.{digits}f}" if values else "-"


def of_storm(s: Storm) -> str:
    return (
        f"## Messages\n\n{s.messages} messages in {s.ticks} ticks of {s.voyages} voyages on the loop that "
        f"the service builds (certificate, network and adaptation on), {s.pauses} pauses of 0.1 s to 10 min, "
        f"{s.clocks} steps of the wall clock or of a source's clock. Every number finite, every bound kept, "
        f"no exception. In {s.honest_ticks} ticks all instruments were true: "
        f"{100.0 * s.honest_inside / s.honest_ticks:.1f} % of them with a promise, and none of it broken."
    )


def of_lies(hull: str, weather: str, told: list[LieNoticed]) -> str:
    lines = [
        "## Lies",
        "",
        f"{hull}, {weather}, zigzag 10/10; the lie begins after {LIE_AT_S:.0f} s of {SECONDS:.0f}. Wrong: "
        "ticks with a promise in which an error of u, v or r exceeded its bound; shares of the ticks since.",
        "",
        "| lie | said after s | first word | promised | wrong | greatest error / bound |",
        "|---|---|---|---|---|---|",
    ]
    for t in told:
        lines.append(
            f"| {t.lie} | {_seconds(t.said_s)} | {t.word[:60].replace('|', '/')} | {100 * t.inside:.0f} % | "
            f"{100 * t.wrong:.1f} % | {t.worst:.2f} |"
        )
    return "\n".join(lines)


def _seconds(x: float | None) -> str:
    return "-" if x is None else f"{x:.1f}"

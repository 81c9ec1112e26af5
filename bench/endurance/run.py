"""`twin-bench endurance`: the service with bus, log, certificate, network and adaptation on the reference
sea, killed at random instants, paused, its wall clock set; then the same loop under instruments that lie."""

import argparse
import statistics
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench import bench_output
from bench.endurance.killed_service import ServiceFolder
from bench.endurance.lies import LIE_AT_S, SECONDS, LieNoticed, lies
from bench.endurance.shocks import Killed, Shocked, clocks, kills, pauses


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--kills", type=int, default=200, help="kill -9 at a random instant (default: 200)")
    parser.add_argument("--pauses", type=int, default=18, help="SIGSTOP of 1 to 60 s (default: 18)")
    parser.add_argument("--clocks", type=int, default=12, help="steps of the wall clock (default: 12)")
    parser.add_argument("--hull", default="kvlcc2", help="of the reference sea (default: kvlcc2)")
    parser.add_argument("--no-lies", action="store_true", help="leave out the instruments that lie")
    parser.add_argument("--weather", default="TS-01", help="under the lies (default: TS-01)")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    parts, result = [f"# Endurance of the service\n\n{(__doc__ or '').strip()}"], dict[str, Any]()
    for name, count, tried, page in (
        ("kills", args.kills, kills, of_kills),
        ("pauses", args.pauses, pauses, of_shocks),
        ("clocks", args.clocks, clocks, of_shocks),
    ):
        if count:
            found = shocked(args.hull, tried, count)
            result[name] = [row._asdict() for row in found[0]] + list(found[1:])
            parts.append(page(name, *found))
    if not args.no_lies:
        told = lies(args.hull, args.weather)
        result["lies"] = [row._asdict() for row in told]
        parts.append(of_lies(args.hull, args.weather, told))
    bench_output.give(args, result, "\n\n".join(parts), bench_output.kept(args.page))
    return 0


def shocked(hull: str, tried: Callable[[ServiceFolder, int], Any], count: int) -> Any:
    """One kind of shock, in a folder of its own."""
    with TemporaryDirectory() as folder:
        place = ServiceFolder(Path(folder), hull)
        try:
            return tried(place, count)
        finally:
            place.close()


def of_kills(name: str, made: list[Killed], whole: int, files: int) -> str:
    lost, start = sorted(k.lost_s for k in made), sorted(k.start_s for k in made)
    return (
        f"## kill -9\n\n{len(made)} of {len(made)} processes were killed and the next one ticked. Lost of "
        f"the log: {statistics.median(lost):.3f} s in the median, {lost[-1]:.3f} at most. From start to the "
        f"first tick: {statistics.median(start):.2f} s in the median, {start[-1]:.2f} at most. Log files "
        f"whole after repair: {whole} of {files}. At the end the promise was given again."
    )


def of_shocks(name: str, made: list[Shocked], code: int) -> str:
    lines = [
        f"## {name.capitalize()}",
        "",
        f"Exit code at the end, told to stop: {code}.",
        "",
        "| what | next tick after s | promise back after s | announced | ticks not hybrid |",
        "|---|---|---|---|---|",
    ]
    for s in made:
        lines.append(
            f"| {s.what} | {_seconds(s.tick_s)} | {_seconds(s.promise_s)} | "
            f"{'yes' if s.announced else 'no'} | {s.not_hybrid} |"
        )
    return "\n".join(lines)


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

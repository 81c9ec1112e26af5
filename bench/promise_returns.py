"""Is the promise given while all is well, and does it come back? `twin-bench promise`

The loop that the service builds (certificate, residual where there is one, adaptation) sails the reference
sea on logs of 10, 5 and 1 Hz, the loop as fast as the log or at its usual 10 Hz. First nothing is wrong: the
share of the time without a promise, and why. Then one instrument at a time lies for a minute: when the
promise is taken back, for how long it was wrong, and how long after the lie it is given again."""

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from bench import bench_output
from bench.broken_assumptions import Exceeded, exceeded
from bench.endurance.lies import OTHERS
from bench.instrument_lies import HULLS, WEATHERS, rows_of
from bench.lie_kinds import LIES, Lie, Row
from bench.promised_bound import promised_bound
from bench.reference import SeaCase, simulate
from bench.sea_disturbance import sailed
from bench.through_loop import BEGIN_S, WALL
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.study.reference.split import SplitVoyage, low_frequency, window

SEA_HZ = 10.0
RATES = ((10.0, 10.0), (5.0, 5.0), (1.0, 1.0), (5.0, 10.0), (1.0, 10.0))  # of the log, of the loop
LIE_WEATHERS = {"kvlcc2": "TS-01", "container": "TS-01", "usv": "calm"}
WAVES = 1e-3  # a lower sea is none [m]
LIE_RATES = {"kvlcc2": (10.0, 5.0, 1.0), "container": (10.0, 5.0, 1.0), "usv": (10.0, 5.0)}
LEFT_OUT_S, LIE_AT_S, LIE_S, AFTER_S = 60.0, 180.0, 60.0, 420.0
SUSPECTED = ("against", "far noisier", "stays at", "farther from", "clock of", "stepped")


class Withdrawn(NamedTuple):
    """A healthy voyage: share of its time without a promise; of that because an instrument is suspected; the
    reason most often said."""

    hull: str
    sea: str
    log_hz: float
    loop_hz: float
    share: float
    suspected: float
    said: str


class Returned(NamedTuple):
    """A lie of a minute: the assumption that it comes nearest to and its greatest share of that limit;
    seconds to the first tick without a promise since it is exceeded (since the lie began where none is; NaN:
    none in the minute), seconds with a wrong promise, seconds after the lie to the last tick without one."""

    hull: str
    lie: str
    rate_hz: float
    share: float
    assumption: str
    gone_s: float
    wrong_s: float
    back_s: float
    said: str


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--hull", action="append", choices=HULLS, help="only this hull (repeat)")
    parser.add_argument(
        "--seconds", type=long_enough, default=900.0, metavar="S", help="of a healthy voyage (default: 900)"
    )
    parser.add_argument("--seed", type=int, default=17, help="of the healthy voyages (default: 17)")
    parser.add_argument("--no-lies", action="store_true", help="healthy voyages only")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    healthy = [row for hull in args.hull or HULLS for row in withdrawn(hull, args.seconds, args.seed)]
    told = [] if args.no_lies else [(hull, rate) for hull in args.hull or HULLS for rate in LIE_RATES[hull]]
    back = [row for hull, rate in told for row in returns(rate, hull)]
    result = {"healthy": [r._asdict() for r in healthy], "lies": [r._asdict() for r in back]}
    bench_output.give(args, result, page(healthy, back), bench_output.kept(args.page))
    return 0


def long_enough(text: str) -> float:
    """Seconds of a voyage of which more is judged than the first that are left out."""
    try:
        seconds = float(text)
    except ValueError:
        seconds = float("nan")
    if not 2.0 * LEFT_OUT_S <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no length of a voyage: give {LEFT_OUT_S * 2.0:.0f} s or more, "
            f"of which the first {LEFT_OUT_S:.0f} are left out"
        )
    return seconds


def withdrawn(hull: str, seconds: float, seed: int) -> Iterator[Withdrawn]:
    """One hull, calm and in waves, at each pair of rates."""
    for sea, weathers in WEATHERS.items():
        case = SeaCase(hull, "mixed", weathers[HULLS.index(hull)], seed=seed, duration_s=seconds)
        (recording,) = simulate([case], 1.0 / SEA_HZ)
        rows = list(rows_of(recording))
        for log_hz, loop_hz in RATES:
            bench_output.tell(f"{hull} {sea}, log {log_hz:g} Hz, loop {loop_hz:g} Hz")
            yield _healthy(hull, sea, rows, log_hz, loop_hz)


def _healthy(hull: str, sea: str, rows: Sequence[Row], log_hz: float, loop_hz: float) -> Withdrawn:
    loop, without, suspected, ticks = loop_for(hull, loop_hz), 0, 0, 0
    said = Counter[str]()
    every, tick_every = round(SEA_HZ / log_hz), round(SEA_HZ / loop_hz)
    for k in range(0, len(rows), tick_every):
        tick = heard(loop, rows[k] if k % every == 0 else {}, k / SEA_HZ, k // tick_every)
        if k < LEFT_OUT_S * SEA_HZ:
            continue
        ticks += 1
        if not tick.certificate.inside:
            why = (loop.stabilizer.outside or "").partition(" = ")[0]
            why = why if loop.stabilizer.promises else "no certificate at this rate"
            without, suspected = without + 1, suspected + any(word in why for word in SUSPECTED)
            said[why] += 1
    return Withdrawn(hull, sea, log_hz, loop_hz, without / ticks, suspected / ticks, _first(said))


def returns(rate_hz: float, hull: str) -> Iterator[Returned]:
    """Every lie on one voyage at one rate of log and loop; the first part of it is sailed once."""
    case = SeaCase(hull, "zigzag_10", LIE_WEATHERS[hull], seed=23, duration_s=LIE_AT_S + LIE_S + AFTER_S)
    (recording,) = simulate([case], 1.0 / SEA_HZ)
    bench_output.tell(f"lies on {hull} at {rate_hz:g} Hz")
    voyage, every = sailed(recording), round(SEA_HZ / rate_hz)
    # without waves all motion is the ship's own
    n = window(voyage.T_p, 1.0 / SEA_HZ) if voyage.H_s > WAVES else 1
    nu = low_frequency(voyage.nu, n)[:, : -2 * n]  # its mean needs both sides
    voyage = replace(voyage, nu=nu[:, ::every], psi=voyage.psi[::every], current=voyage.current[:, ::every])
    rows, loop = list(rows_of(recording))[::every], loop_for(hull, rate_hz)
    first = round(LIE_AT_S * rate_hz)
    for k in range(first):
        heard(loop, rows[k], k / rate_hz, k)
    for lie in (*LIES, *OTHERS):
        copied = deepcopy(loop, {id(x): x for x in (loop.ship, loop.learned.residual)})
        yield _lied(copied, lie, rows, voyage, first, hull, rate_hz)


def _lied(
    loop: Loop,
    lie: Lie,
    rows: Sequence[Row],
    voyage: SplitVoyage,
    first: int,
    hull: str,
    rate_hz: float,
) -> Returned:
    memory: dict[str, float] = {}
    said = Counter[str]()
    gone_s, wrong, last_s, over = np.nan, 0, 0.0, first + round(LIE_S * rate_hz)
    most, broken_s = Exceeded(), np.nan
    for k in range(first, min(len(rows), voyage.nu.shape[1])):
        row, since_s = dict(rows[k]), (k - first) / rate_hz
        if k < over:
            lie.tell(row, since_s, memory)
            now = exceeded(loop, voyage, k, rows[k], row)
            if now.breaks and not most.breaks:
                gone_s, broken_s = np.nan, since_s
            most = max(most, now)
        tick, e = heard(loop, row, k / rate_hz, k), loop.observer.estimate
        if tick.certificate.inside:
            error = np.abs(np.array((e.u, e.v, e.r)) - voyage.nu[:, k])
            wrong += bool(np.any(error > promised_bound(loop)))
        elif k < over:
            gone_s = since_s - (broken_s if most.breaks else 0.0) if gone_s != gone_s else gone_s
        else:
            last_s = (k + 1 - over) / rate_hz
            said[(loop.stabilizer.outside or "").partition(" = ")[0]] += 1
    return Returned(hull, lie.name, rate_hz, *most, gone_s, wrong / rate_hz, last_s, _first(said))


def loop_for(hull: str, rate_hz: float) -> Loop:
    """The loop that the service builds for this hull."""
    settings = Settings({"ship.file": hull, "loop.rate_hz": rate_hz})
    return loop_of(settings, Played([]), Outbox(Publisher(), "twin", "ship"), None)


def heard(loop: Loop, row: Row, t: float, number: int) -> Any:
    """One tick, on one row of the log or on none."""
    now_s = BEGIN_S + t
    loop.ears.next = [  # type: ignore[attr-defined]
        Reading(name, x % 360.0 if name == "heading_true_north_deg" else x, WALL + now_s, now_s, "ship")
        for name, x in row.items()
        if x == x and name in loop.sensors.gates
    ]
    return loop.tick(Instant(number, now_s, WALL + now_s))


def _first(said: Counter[str]) -> str:
    return next((word for word, _ in said.most_common() if word), "")


def page(healthy: Sequence[Withdrawn], back: Sequence[Returned]) -> str:
    """The tables."""
    columns = "hull", "sea", "log Hz", "loop Hz", "withdrawn", "of it: an instrument suspected", "said most"
    lines = bench_output.begun("The promise, healthy and after a lie", __doc__, *columns)
    for w in healthy:
        lines.append(
            f"| {w.hull} | {w.sea} | {w.log_hz:g} | {w.loop_hz:g} | {100 * w.share:.1f} % | "
            f"{100 * w.suspected:.1f} % | {w.said} |"
        )
    return "\n".join([*lines, *(_after_lies(back) if back else [])])


LIES_BEGUN = f"""
Zigzag 10/10 in TS-01, the boat in calm water, each lie from {LIE_AT_S:.0f} s on for a minute. A lie breaks an
assumption where it exceeds the noise of a reading of motion or heading (A4), or where rudder or shaft are
said to do what is more than D beyond what they do (A3). Taken back: counted from then on.

| hull | Hz | lies | that break an assumption | taken back within 1 s | within 60 s | wrong s, all lies |
|---|---|---|---|---|---|---|"""
EACH_LIE = """
| hull | lie | Hz | share of its limit | taken back after s | wrong s | last missing s after it | said then |
|---|---|---|---|---|---|---|---|"""


def _after_lies(back: Sequence[Returned]) -> list[str]:
    """How soon it is taken back, by hull and rate, and every lie."""
    lines = [LIES_BEGUN]
    for hull, rate in dict.fromkeys((r.hull, r.rate_hz) for r in back):
        some = [r for r in back if (r.hull, r.rate_hz) == (hull, rate)]
        breaks = [r for r in some if r.share > 1.0]
        soon, late = (sum(r.gone_s <= s for r in breaks) for s in (1.0, 60.0))
        wrong_s = sum(r.wrong_s for r in some)
        lines.append(f"| {hull} | {rate:g} | {len(some)} | {len(breaks)} | {soon} | {late} | {wrong_s:.1f} |")
    return [*lines, EACH_LIE, *map(_line, back)]


def _line(r: Returned) -> str:
    gone = "-" if r.gone_s != r.gone_s else f"{r.gone_s:.1f}"
    share = f"{r.assumption} {r.share:.2g}" if r.share else "none"
    back = f"{gone} | {r.wrong_s:.1f} | {r.back_s:.0f} | {r.said}"
    return f"| {r.hull} | {r.lie} | {r.rate_hz:g} | {share} | {back} |"

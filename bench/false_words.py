"""How often is something said of a healthy ship? `twin-bench false-words FOLDER`

The loop that the service builds sails voyages of the reference sea on which nothing is wrong: every bundled
hull, calm and in waves of several seas, manoeuvres in turn. Counted are beginnings: of an alarm that suspects
an instrument, of the promise's being contradicted by samples (both are false words), and of every other time
without a promise (withdrawn: it is at the edge of its operating set, its bound is too wide). A voyage's
counts are appended to FOLDER/voyages.jsonl; the same command goes on where it was ended."""

import argparse
import json
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from bench import bench_output
from bench.instrument_lies import MANOEUVRES, rows_of
from bench.instrument_lies import WEATHERS as SEAS
from bench.options import positive
from bench.promise_returns import LEFT_OUT_S, SUSPECTED, heard, long_enough, loop_for
from bench.reference import SeaCase, Weather, simulate
from bench.stability.stability_tables import SHIPS

RATE_HZ = 10.0
KEPT = "voyages.jsonl"
# of a model as of the ship in TS-03, by Froude's law: lengths by 7 m / 320 m, speeds by its root
MODEL_SEA = Weather(1.8, 60.0, 0.12, 0.041, 1.2, 60.0, 0.12, 240.0, 0.02)
# seas other than those of the other benches: a ship's, and a boat's
OTHERS = {
    "moderate": ("TS-02", Weather(2.0, 60.0, 0.12, 0.04, 1.0, 60.0, 0.1, 240.0, 0.02)),
    "rough": (
        Weather(15.0, 60.0, 0.12, 3.0, 10.0, 60.0, 0.8, 240.0, 0.25),
        Weather(4.0, 60.0, 0.12, 0.12, 2.0, 60.0, 0.3, 240.0, 0.05),
    ),
}
NONE_SEEN = 3.0  # of a Poisson's mean: with 95 % no greater one shows nothing


class TrueVoyage(NamedTuple):
    """One voyage: seconds judged and without a promise; how often a false word began, by its words without
    numbers; how often the promise was withdrawn without one, likewise."""

    hull: str
    sea: str
    manoeuvre: str
    seed: int
    seconds: float
    without_s: float
    false: dict[str, int]
    withdrawn: dict[str, int]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, help=f"voyages are appended to FOLDER/{KEPT}")
    parser.add_argument("--rounds", type=positive, default=1, help="of all manoeuvres, another seed each")
    parser.add_argument("--seconds", type=long_enough, default=900.0, metavar="S", help="of a voyage")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    args.folder.mkdir(parents=True, exist_ok=True)
    path = args.folder / KEPT
    done = kept_voyages(path)
    have = {(v.hull, v.sea, v.manoeuvre, v.seed) for v in done}
    for case in cases(args.rounds, args.seconds):
        _, hull, sea, _, seed, manoeuvre = case
        if (hull, sea, manoeuvre, seed) in have:
            continue
        bench_output.tell(f"{hull}, {sea}, {manoeuvre}, seed {seed}")
        voyage = healthy(*case)
        with path.open("a") as file:
            file.write(json.dumps(voyage._asdict()) + "\n")
        done.append(voyage)
    bench_output.rows(args, done, page(done))
    return 0


def kept_voyages(path: Path) -> list[TrueVoyage]:
    """The whole lines of the file; a last one that was cut off is sailed again."""
    lines = path.read_text().splitlines(keepends=True) if path.exists() else []
    return [TrueVoyage(**json.loads(line)) for line in lines if line.endswith("}\n")]


def cases(rounds: int, seconds: float) -> Iterator[tuple[float, str, str, str | Weather, int, str]]:
    """(seconds, hull, sea, weather, seed, manoeuvre); each round has every hull, sea and manoeuvre once."""
    known = {
        (hull, sea): weather
        for sea, weathers in SEAS.items()
        for hull, weather in zip(("kvlcc2", "container", "usv"), weathers, strict=True)
    } | {("kvlcc2_model", "calm"): "calm", ("kvlcc2_model", "waves"): MODEL_SEA}
    for sea, (ships, boats) in OTHERS.items():
        known |= {("kvlcc2", sea): ships, ("container", sea): ships, ("usv", sea): boats}
    for seed in range(rounds):
        for manoeuvre in MANOEUVRES:
            for hull in SHIPS:
                for sea in (*SEAS, *OTHERS):
                    if (hull, sea) in known:
                        yield seconds, hull, sea, known[hull, sea], 400 + seed, manoeuvre


def healthy(
    seconds: float, hull: str, sea: str, weather: str | Weather, seed: int, manoeuvre: str
) -> TrueVoyage:
    """One voyage through the loop at 10 Hz."""
    (recording,) = simulate([SeaCase(hull, manoeuvre, weather, seed=seed, duration_s=seconds)], 1.0 / RATE_HZ)
    loop, ticks, without = loop_for(hull, RATE_HZ), 0, 0
    false, withdrawn, before, was = Counter[str](), Counter[str](), set[str](), ""
    for k, row in enumerate(rows_of(recording)):
        tick = heard(loop, row, k / RATE_HZ, k)
        said = {text for text in map(without_numbers, tick.reasons) if any(w in text for w in SUSPECTED)}
        why = "" if tick.certificate.inside else without_numbers(loop.stabilizer.outside or "")
        if k >= LEFT_OUT_S * RATE_HZ:
            ticks, without = ticks + 1, without + bool(why)
            false.update(said - before)
            suspected = any(word in why for word in SUSPECTED)
            withdrawn.update([why] if why and not was and not suspected else [])
        before, was = said, why
    return TrueVoyage(
        hull,
        sea,
        manoeuvre,
        seed,
        ticks / RATE_HZ,
        without / RATE_HZ,
        dict(false),
        dict(withdrawn),
    )


def without_numbers(text: str) -> str:
    """What is said, whoever passes it on: the same word with another number, or because of which the learned
    force is off, or the promise, is no other word."""
    text = text.removeprefix("certificate: ").removeprefix("learned force off: ")
    return " ".join(w for w in text.partition(" = ")[0].split() if not any(c.isdigit() for c in w))


def page(voyages: Sequence[TrueVoyage]) -> str:
    """The table; by hull and sea."""
    columns = (
        "hull", "sea", "voyages", "hours", "false words", "in 1000 h", "without a promise",
        "withdrawn otherwise in 1000 h", "false words said",
    )  # fmt: skip
    lines = bench_output.begun("False words", __doc__, *columns)
    for hull, sea in dict.fromkeys((v.hull, v.sea) for v in voyages):
        these = [v for v in voyages if (v.hull, v.sea) == (hull, sea)]
        hours = sum(v.seconds for v in these) / 3600.0
        false = sum((Counter(v.false) for v in these), Counter[str]())
        withdrawn = sum(sum(v.withdrawn.values()) for v in these)
        n = sum(false.values())
        rate = f"{1000.0 * n / hours:.0f}" if n else f"0 (below {1000.0 * NONE_SEEN / hours:.0f})"
        words = "; ".join(f"{text} ({count})" for text, count in false.most_common())
        lines.append(
            f"| {hull} | {sea} | {len(these)} | {hours:.2f} | {n} | {rate} | "
            f"{100.0 * sum(v.without_s for v in these) / 3600.0 / hours:.1f} % | "
            f"{1000.0 * withdrawn / hours:.0f} | {words} |"
        )
    return "\n".join(lines)

"""Is a voyage of another ship noticed, and one of the file's own left in peace? `twin-bench whose FOLDER`

The bundled hulls in the reference sea and random ships of the fleet, each voyage beside its own ship file (of
a random ship: the first model of `twin init`), healthy and with what is hidden; then healthy voyages beside
the files of other ships. Counted are voyages of which `other_ship` says that they may be another ship's, and
those of which a check of the import proves a mistake, though there is none. A voyage's answer is appended to
FOLDER/answers.jsonl; the same command goes on where it was ended."""

import argparse
import json
from collections.abc import Iterator, Sequence
from itertools import chain, pairwise
from pathlib import Path
from typing import NamedTuple

from bench import bench_output
from bench.bundled import recorded
from bench.fleet.fact_rows import voyage as of_fleet
from bench.fleet.hull_families import FAMILIES
from bench.fleet.plausibility import build
from bench.fleet.random_ship import RandomShip
from bench.fleet.voyage_plan import generator, plan, references, sailed
from bench.reference import SeaCase, simulate
from bench.reference.hidden_catalogue import EFFECTS
from twin.physics.ship import Ship, load
from twin.recording.checks import run_checks
from twin.recording.voyage import Voyage
from twin.study.first_model.first_estimate import OPTIONS, first_model

ANSWERS = "answers.jsonl"
SEA_HULLS = ("kvlcc2", "container", "usv", "kvlcc2_model")
SAILED = ("zigzag_20", "turning_circle", "mixed", "course_changes", "speed_changes", "square")
VOYAGE_S, SEA_SEED = 1200.0, 700
PLANNED = 6
NEIGHBOURS = 6  # other random ships by whose files a random ship's voyage is asked
SIZES = (0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.4, 2.0, 3.0, 5.0, 10.0, float("inf"))


class WhoseAnswer(NamedTuple):
    """What was said of one voyage beside one ship file; `ratio`: length of the ship that sailed over the
    file's."""

    key: str
    group: str
    hidden: str
    own: bool
    ratio: float
    fired: bool
    informative: bool  # whether the voyage could tell at all
    said: str
    proved: list[str]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, help=f"answers are appended to FOLDER/{ANSWERS}")
    parser.add_argument("--seeds", type=int, default=5, help="random ships of each family (default: 5)")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    args.folder.mkdir(parents=True, exist_ok=True)
    path = args.folder / ANSWERS
    done = kept_answers(path)
    have = frozenset(a.key for a in done)
    with path.open("a") as file:
        for answer in chain(of_sea(have), of_random(args.seeds, have)):
            file.write(json.dumps(answer._asdict()) + "\n")
            file.flush()
            done.append(answer)
    bench_output.rows(args, done, whose_page(done))
    return 0


def kept_answers(path: Path) -> list[WhoseAnswer]:
    """The whole lines of the file; a last one that was cut off is asked again."""
    lines = path.read_text().splitlines(keepends=True) if path.exists() else []
    return [WhoseAnswer(**json.loads(line)) for line in lines if line.endswith("}\n")]


def answer_of(
    key: str, group: str, hidden: str, ship: Ship, voyage: Voyage, own: bool, length: float
) -> WhoseAnswer:
    checks = {c.name: c for c in run_checks(voyage, ship)}
    whose = checks["other_ship"]
    proved = [c.name for c in checks.values() if c.unusable]
    ratio = length / float(ship.L_pp)
    return WhoseAnswer(key, group, hidden, own, ratio, not whose.ok, whose.informative, whose.text, proved)


def of_sea(have: frozenset[str]) -> Iterator[WhoseAnswer]:
    """The bundled hulls: healthy and with every effect, beside their own file; healthy, beside the others.
    A hull's voyages are sailed together."""
    files = {name: load(name) for name in SEA_HULLS}
    for hull in SEA_HULLS:
        wanted = {key: left for key, case in cases(hull) if (left := files_left(key, case, have))}
        sail = {key: case for key, case in cases(hull) if key in wanted}
        bench_output.tell(f"{hull}: {len(sail)} voyages")
        for key, one in zip(sail, simulate(list(sail.values())) if sail else (), strict=True):
            voyage = recorded(key, one.columns, 2 if hull in ("usv", "kvlcc2_model") else 10)
            hidden = "+".join(name for name, _ in sail[key].hidden)
            for file in wanted[key]:
                by, length = f"{hull} by {file}", float(files[hull].L_pp)
                yield answer_of(f"{key} by {file}", by, hidden, files[file], voyage, file == hull, length)


def cases(hull: str) -> Iterator[tuple[str, SeaCase]]:
    """Every voyage of a hull, by its name: healthy ones, then one with each effect."""
    seas = ("calm",) if hull == "kvlcc2_model" else ("calm", "TS-02")
    every: list[tuple[str, str, str]] = [(m, w, "") for m in SAILED for w in seas]
    every += [(SAILED[i % len(SAILED)], "calm", name) for i, name in enumerate(EFFECTS)]
    for i, (manoeuvre, weather, name) in enumerate(every):
        hidden = ((name, 1.0),) if name else ()
        case = SeaCase(hull, manoeuvre, weather, hidden=hidden, seed=SEA_SEED + i, duration_s=VOYAGE_S)
        yield f"{hull} {manoeuvre} {weather} {name or 'nothing'}", case


def files_left(key: str, case: SeaCase, have: frozenset[str]) -> list[str]:
    """The ship files beside which a voyage is still to be asked: its own; a healthy one, the others too."""
    every = [case.hull] if case.hidden else SEA_HULLS
    return [str(file) for file in every if f"{key} by {file}" not in have]


def of_random(seeds: int, have: frozenset[str]) -> Iterator[WhoseAnswer]:
    """Random ships, with the files of their first models: their own, and those of the ships before."""
    before: list[tuple[str, Ship]] = []
    for seed in range(seeds):
        for family in FAMILIES:
            ship, name = build(family, 50 + seed), f"{family}-{50 + seed}"
            file = first_file(ship)
            healthy = references(ship)[:2]
            voyages = [(one, "") for one in healthy]
            voyages += [(sailed(ship, c), "+".join(c.hidden)) for c in plan(ship, PLANNED)]
            for one, hidden in voyages:
                key = f"{name} {one.name} by {name}"
                if key not in have:
                    yield answer_of(key, "random ships", hidden, file, of_fleet(one), True, ship.p.L)
            for other, theirs in before[-NEIGHBOURS:]:
                key = f"{name} {healthy[0].name} by {other}"
                if key not in have:
                    yield answer_of(key, "random ships", "", theirs, of_fleet(healthy[0]), False, ship.p.L)
            before.append((name, file))


def first_file(ship: RandomShip) -> Ship:
    """What `twin init` makes of the particulars that its owner has."""
    given = {name: None for name, *_ in OPTIONS} | ship.given(generator(ship, 4))
    return first_model(f"{ship.family}-{ship.seed}", given)[0]


def whose_page(answers: Sequence[WhoseAnswer]) -> str:
    """Two tables: own files, then the files of other ships, by how much longer the ship is that sailed."""
    columns = ("voyages", "of", "another ship, it says", "cannot tell", "a mistake is proved")
    lines = bench_output.begun("Whose voyage is this?", __doc__, *columns)
    own = [a for a in answers if a.own]
    for group in dict.fromkeys(a.group for a in own):
        for words, hidden in (("healthy", False), ("something hidden", True)):
            of = [a for a in own if a.group == group and bool(a.hidden) == hidden]
            lines.append(_row(f"{group}, {words}", of))
    lines += [
        "",
        "Beside the file of another ship:",
        "",
        f"| {' | '.join(columns)} |",
        "|---" * len(columns) + "|",
    ]
    others = [a for a in answers if not a.own]
    for group in dict.fromkeys(a.group for a in others if a.group != "random ships"):
        lines.append(_row(group, [a for a in others if a.group == group]))
    for low, high in pairwise(SIZES):
        some = [a for a in others if a.group == "random ships" and low <= a.ratio < high]
        if some:
            lines.append(_row(f"random ships, {low:g} to {high:g} times as long as the file's", some))
    lines += ["", *(f"* {a.key}: {', '.join(a.proved)} proved" for a in answers if a.proved)]
    lines += [f"* {a.key}, {a.hidden or 'healthy'}: called another ship's" for a in own if a.fired]
    return "\n".join(lines) + "\n"


def _row(words: str, some: Sequence[WhoseAnswer]) -> str:
    fired, blind = sum(a.fired for a in some), sum(not a.informative for a in some)
    return f"| {words} | {len(some)} | {fired} | {blind} | {sum(bool(a.proved) for a in some)} |"

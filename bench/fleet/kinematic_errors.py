"""What kinematics say of the instruments of random ships, beside what they truly are:
`python -m bench.fleet instruments FOLDER`. Each voyage is asked by itself, without a ship, as `twin
instruments` is. From the errors on healthy voyages it fits by how much each number varies from voyage to
voyage beside what its readings leave open (`InstrumentUnknown.varies`):

    varies' = varies sqrt(mean((told - true)^2 / sd^2))

where sd holds `varies`; repeated until nothing changes: of all ships, and with each family left out, of which
the range is told. What lies inside its 95 % is told with `varies` as the twin has it."""

import argparse
import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bench.fleet.answer_score import share
from bench.fleet.fact_rows import voyage
from bench.fleet.hull_families import FAMILIES
from bench.fleet.plausibility import build
from bench.fleet.random_ship import RandomShip
from bench.fleet.run import read
from bench.fleet.voyage_plan import VOYAGES, SailedCase, plan, references, sailed
from twin import whole
from twin.physics.effects import catalogue
from twin.study.instruments.findings import P95, InstrumentEstimate
from twin.study.instruments.instrument_estimate import Instruments, estimate
from twin.study.instruments.unknowns import effect_of

ROWS = "kinematics.jsonl"
WAYS = {"as on these ships": True, "readings alone": False}  # what is said -> whether numbers vary


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, help=f"rows are added to FOLDER/{ROWS}")
    parser.add_argument("--seeds", type=int, default=5, help="ships of each family (default: %(default)s)")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="begin no voyage after so many")
    parser.add_argument("--page", type=Path, help="write the tables there, as markdown")


def run(args: argparse.Namespace) -> int:
    """A row a voyage and a way; then the tables."""
    args.folder.mkdir(parents=True, exist_ok=True)
    path, until = args.folder / ROWS, time.time() + args.seconds
    known = {(r["voyage"], r["way"]) for r in read(path)} if path.exists() else set()
    with path.open("a") as file:
        for ship, one, hidden in sailed_voyages(args.seeds):
            for way, varying in WAYS.items():
                if (one.name, way) not in known and time.time() < until:
                    found = estimate([voyage(with_apparent(one))], float(ship.p.L), varying=varying)
                    file.write(json.dumps(row(ship, one, hidden, found) | {"way": way}, default=float) + "\n")
                    file.flush()
    lines = tables([*read(path)])
    print("\n".join(lines))
    if args.page:
        whole.write(args.page, "\n".join(["# Instruments of random ships, by kinematics", "", *lines, ""]))
    return 0


def sailed_voyages(seeds: int) -> Iterator[tuple[RandomShip, SailedCase, Mapping[str, float]]]:
    """The reference voyages of each ship, those of its plan on which nothing is hidden, and those on which a
    fault of an instrument is, with what is hidden."""
    of_instruments = {name for name, e in catalogue().items() if e.belongs_to == "instrument"}
    for seed in range(1, 1 + seeds):
        for family in FAMILIES:
            ship = build(family, seed)
            for one in references(ship):
                yield ship, replace(one, name=f"{family}-{seed}-{one.name}"), {}
            for case in plan(ship, VOYAGES):
                if case.kind == "nothing" or of_instruments & set(case.hidden):
                    yield ship, sailed(ship, case), case.hidden


def with_apparent(one: SailedCase) -> SailedCase:
    """The same with the apparent wind that the anemometer showed, from which its true wind was made."""
    c = one.columns
    if "true_wind_speed_mps" not in c:
        return one
    angle = np.radians(c["true_wind_direction_deg"] - c["heading_true_north_deg"])
    ahead = c["true_wind_speed_mps"] * np.cos(angle) + c["surge_velocity_mps"]
    aside = c["true_wind_speed_mps"] * np.sin(angle) + c["sway_velocity_mps"]
    shown = {"apparent_wind_speed_mps": np.hypot(ahead, aside)}
    shown["apparent_wind_angle_deg"] = np.degrees(np.arctan2(aside, ahead))
    return replace(one, columns=c | shown)


def truth(ship: RandomShip, clock: str) -> dict[str, float]:
    """What each number of healthy instruments is, ages counted from that of `clock`: of a receiver whose
    position and speed are of two ages the one between."""
    k = ship.kit
    ages = {"gnss_delay": (k.gnss_late + k.speed_late) / 2, "log_delay": k.log_late}
    ages |= {"heading_delay": 0.0, "rate_delay": 0.0}
    return {name: age - ages[clock] for name, age in ages.items()} | {
        "smoothing": 0.0,
        "A": k.heading_bias,
        "B": k.deviation * float(np.cos(0.4)),
        "C": k.deviation * float(np.sin(0.4)),
        "D": 0.0,
        "E": 0.0,
        "gyro_bias": k.rate_bias,
        "gyro_scale": 0.0,
        "log_scale": k.log_scale,
        "log_bias": 0.0,
        "log_angle": k.log_angle,
        "antenna_ahead": k.arm[0],
        "antenna_starboard": k.arm[1],
        "antenna_above": k.high,
        "vane": k.wind_angle,
        "wind_scale": k.wind_factor - 1.0,
    }


def row(ship: RandomShip, one: SailedCase, hidden: Mapping[str, float], found: Instruments) -> dict[str, Any]:
    """What was said of one voyage, and what is true; `named`: effects of faults that were seen, or would
    stand in the place of one."""
    true = truth(ship, found.clock)
    told = [e for e in found.estimates if e.known and e.unknown.name in true]
    either = {f: (f, *found.instead[f]) for f in found.faults}
    return {
        "voyage": one.name,
        "family": ship.family,
        "hidden": list(hidden),
        "named": [[effect_of(f) or f for f in fs] for fs in either.values()],
        "numbers": {e.unknown.name: number(e, true[e.unknown.name]) for e in told},
    }


def number(e: InstrumentEstimate, true: float) -> dict[str, Any]:
    """One number: its error and sd, and whether it was seen."""
    return {"error": e.value - true, "sd": e.sd, "seen": e.seen, "true": true}


def tables(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """By way: false names on healthy voyages and right ones on others; by number: errors and coverage."""
    lines = ["| | " + " | ".join(WAYS) + " |", "|---" * (1 + len(WAYS)) + "|"]
    for says, mark in MARKS.items():
        each = [share([m for r in rows if r["way"] == way for m in mark(r)]) for way in WAYS]
        lines.append(f"| {says} | {' | '.join(map(str, each))} |")
    lines += ["", "| number | told | RMS error | inside 95 % | and by the readings alone | `varies` times |"]
    lines.append("|---" * 6 + "|")
    for name in dict.fromkeys(n for r in rows for n in r["numbers"]):
        by = {way: of_number(rows, way, name) for way in WAYS}
        told = by["as on these ships"]
        z = np.array([e / s for e, s, _ in told])
        error = np.sqrt(np.mean([e**2 for e, *_ in told]))
        cover = {way: share([abs(e / s) < P95 for e, s, _ in each]) for way, each in by.items()}
        times = np.sqrt(np.mean(z**2))
        lines.append(
            f"| {name} | {len(told)} | {error:.3g} | {cover['as on these ships']} | "
            f"{cover['readings alone']} | {times:.2f} ({', '.join(left_out(told))}) |"
        )
    return lines


def of_number(rows: Sequence[Mapping[str, Any]], way: str, name: str) -> list[tuple[float, float, str]]:
    """(error, sd, family) of it on each healthy voyage that told of it."""
    return [
        (n["error"], n["sd"], r["family"])
        for r in rows
        if r["way"] == way and not r["hidden"] and (n := r["numbers"].get(name)) and n["sd"] > 0.0
    ]


def left_out(told: Sequence[tuple[float, float, str]]) -> list[str]:
    """By how much `varies` would change were each family left out: the least and the most."""
    each = [
        float(np.sqrt(np.mean([(e / s) ** 2 for e, s, f in told if f != family])))
        for family in {f for *_, f in told}
        if any(f != family for *_, f in told)
    ]
    return [f"{x:.2f}" for x in (min(each), max(each))] if each else []


def false_names(r: Mapping[str, Any]) -> list[bool]:
    """Of a healthy voyage: whether a number was said to be seen that is not there, or elsewhere."""
    if r["hidden"]:
        return []
    return [any(n["seen"] and abs(n["error"]) > P95 * n["sd"] for n in r["numbers"].values())]


def right_names(r: Mapping[str, Any]) -> list[bool]:
    """Of each hidden fault of an instrument: whether it was named, or stands as one of those that may be."""
    named = {name for names in r["named"] for name in names}
    known = catalogue()
    return [h in named for h in r["hidden"] if h in known and known[h].belongs_to == "instrument"]


MARKS = {
    "healthy: a number seen where it is not": false_names,
    "a fault of an instrument, named (by itself or as one of few)": right_names,
}

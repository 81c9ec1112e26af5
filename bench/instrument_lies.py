"""Instruments that lie: how long until it is said, and how often it is said of instruments that do not.

    twin-bench lies                          three hulls, calm and in waves: docs/results/instrument-lies.md

A voyage of the reference sea goes through what watches in the loop: gates, observer, physics, cross-checks
and the pairs of units and signs. From half way one instrument lies, until it is said or the time is over. The
voyage without a lie counts the false alarms.
"""

import argparse
import math
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from copy import deepcopy
from itertools import product
from typing import NamedTuple

import numpy as np

from bench.lie_kinds import LIES, RATE_HZ, Lie, Row
from bench.reference import Recording, SeaCase, Weather, simulate
from twin import whole
from twin.live.gates.crosscheck import CrossChecks
from twin.live.gates.lacking import CorrectedTick
from twin.live.gates.plausible import Plausibility
from twin.live.gates.sensors import Sensors
from twin.live.observer.dynamics import NONE, Dynamics
from twin.live.observer.observer import Observer
from twin.live.signals.readings import Reading
from twin.physics.ship import Ship, load

WALL, BEGIN_S = 1.7e9, 500.0
HULLS = ("kvlcc2", "container", "usv")
WEATHERS = {
    "calm": ("calm",) * 3,
    "waves": ("TS-03", "TS-03", Weather(3.0, 60.0, 0.12, 0.08, 1.5, 60.0, 0.2, 240.0, 0.03)),
}
MANOEUVRES = ("mixed", "course_changes", "speed_changes", "zigzag_10")


class Outcome(NamedTuple):
    """One voyage: seconds to the first word (NaN: none) and whose; of a true voyage, ticks with each word and
    how many words."""

    hull: str
    weather: str
    manoeuvre: str
    lie: str
    ticks: int
    found_s: float
    by: str
    words: dict[str, int]
    refused: int


class LieWatch:
    """What watches the instruments in a loop, and the observer that it needs."""

    def __init__(self, ship: Ship):
        self.sensors, self.observer, self.dynamics = Sensors(ship), Observer(ship), Dynamics(ship)
        self.checks, self.plausible = CrossChecks(ship), Plausibility(ship)
        self.now_s = BEGIN_S

    def hear(self, row: Row) -> list[str]:
        """One tick of the loop on one row of the voyage; what is said of the instruments."""
        now_s, dt, e = self.now_s, 1.0 / RATE_HZ, self.observer.estimate
        said = [
            Reading(name, _round(name, x), WALL + now_s, now_s, "ship")
            for name, x in row.items()
            if x == x and name != "time_s"
        ]
        measured = self.sensors.read(said, now_s, WALL + now_s, e)
        s, physics, forces = self.dynamics.known(self.observer.correct(measured), measured)
        self.checks.feed(CorrectedTick(measured, self.observer, s, physics, forces, dt))
        self.plausible.feed(measured, dt)
        self.observer.steer(self.dynamics.ahead(s, forces, NONE, dt))
        self.now_s += dt
        return [
            *self.checks.reasons,
            *self.plausible.reasons(),
            *(f"gate: {text}" for text in self.sensors.reasons()),
        ]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--hull", action="append", choices=HULLS, help="only this hull (repeat)")
    parser.add_argument("--manoeuvre", action="append", help=f"default: {', '.join(MANOEUVRES)}")
    parser.add_argument(
        "--duration",
        type=float,
        default=1200.0,
        metavar="S",
        help="of a voyage (default: 1200); the lie begins half way",
    )
    parser.add_argument("--healthy", action="store_true", help="false alarms only")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("-o", "--output", metavar="FILE.md", help="write the page there")


def run(args: argparse.Namespace) -> int:
    cases = [(h, w, m) for h, w, m in product(args.hull or HULLS, WEATHERS, args.manoeuvre or MANOEUVRES)]
    tasks = [
        (h, w, m, args.duration, not args.healthy and i % len(MANOEUVRES) < 2)
        for i, (h, w, m) in enumerate(cases)
    ]
    if args.jobs > 1:
        with ProcessPoolExecutor(args.jobs) as pool:
            outcomes = [o for many in pool.map(_sailed, tasks) for o in many]
    else:
        outcomes = [o for task in tasks for o in _sailed(task)]
    text = page(outcomes, args.duration)
    print(text)
    if args.output:
        whole.write(args.output, text + "\n", "-o")
    return 0


def _sailed(task: tuple[str, str, str, float, bool]) -> list[Outcome]:
    hull, weather, manoeuvre, duration_s, lies = task
    rows = voyage_rows(hull, WEATHERS[weather][HULLS.index(hull)], manoeuvre, duration_s)
    watch, words = LieWatch(load(hull)), Counter[str]()
    half = watch
    for k, row in enumerate(rows):
        if k == len(rows) // 2:
            half = deepcopy(watch)
        words.update(watch.hear(row))
    outcomes = [
        Outcome(
            hull, weather, manoeuvre, "none", len(rows), math.nan, "", dict(words), watch.sensors.rejected
        )
    ]
    if lies:
        outcomes += [
            Outcome(hull, weather, manoeuvre, lie.name, 0, *_found(half, rows[len(rows) // 2 :], lie), {}, 0)
            for lie in LIES
        ]
    return outcomes


def _found(half: LieWatch, rows: list[Row], lie: Lie) -> tuple[float, str]:
    """Seconds until a word that was not said before the lie, and the word."""
    watch, memory, before = deepcopy(half), dict[str, float](), set[str]()
    begins_s = 0.0 if lie.since is None else math.nan
    for k, true in enumerate(rows):
        row = dict(true)
        if k > 0:
            lie.tell(row, k / RATE_HZ, memory)
        if (
            lie.since is not None
            and begins_s != begins_s
            and abs(row[lie.since[0]] - true[lie.since[0]]) > lie.since[1]
        ):
            begins_s = k / RATE_HZ
        said = watch.hear(row)
        if k == 0:
            before = set(said)
        elif new := [text for text in said if text not in before]:
            return (k / RATE_HZ - begins_s if begins_s == begins_s else 0.0), new[0]
    return math.nan, ""


def voyage_rows(hull: str, weather: str | Weather, manoeuvre: str, duration_s: float) -> list[Row]:
    """What the instruments say on one voyage of the reference sea, row by row."""
    (recording,) = simulate([SeaCase(hull, manoeuvre, weather, seed=17, duration_s=duration_s)])
    return list(rows_of(recording))


def rows_of(recording: Recording) -> Iterator[Row]:
    names = list(recording.columns)
    for values in np.column_stack([recording.columns[name] for name in names]).tolist():
        yield dict(zip(names, values, strict=True))


def _round(name: str, x: float) -> float:
    return x % 360.0 if name == "heading_true_north_deg" else x


def page(outcomes: list[Outcome], duration_s: float) -> str:
    """The tables."""
    lines = [
        "# Instruments that lie",
        "",
        (__doc__ or "").strip(),
        "",
        f"Voyages of {duration_s:.0f} s at {RATE_HZ:g} Hz.",
        "",
    ]
    lines += [
        "## False alarms",
        "",
        "| hull | sea | manoeuvre | refused | what is said, of all ticks [%] |",
        "|---|---|---|---|---|",
    ]
    for o in (o for o in outcomes if o.lie == "none"):
        which = "; ".join(f"{text} {100.0 * n / o.ticks:.1f}" for text, n in o.words.items()) or "nothing"
        lines.append(f"| {o.hull} | {o.weather} | {o.manoeuvre} | {o.refused} | {which} |")
    columns = list(dict.fromkeys((o.hull, o.weather, o.manoeuvre) for o in outcomes if o.lie != "none"))
    lines += ["", "## Seconds until it is said (- : not within the voyage)", ""]
    lines += [
        "| lie | wanted | " + " | ".join(" ".join(column) for column in columns) + " |",
        "|---" * (len(columns) + 2) + "|",
    ]
    found = {(o.lie, o.hull, o.weather, o.manoeuvre): o for o in outcomes}
    for lie in LIES:
        cells = [_cell(found[(lie.name, *column)]) for column in columns]
        lines.append(f"| {lie.name} | {lie.wanted_s:.0f} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _cell(o: Outcome) -> str:
    return (
        "-"
        if o.found_s != o.found_s
        else f"{o.found_s:.0f} ({o.by.split(':')[0].split(' against ')[0].replace('_', ' ')})"
    )

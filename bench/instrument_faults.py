"""`twin-bench instruments`: what `twin instruments` finds of faults of known size, alone and in pairs, and
how near to the Cramer-Rao bound.

The reference sea sails the healthy ship; the faults are planted in its readings (instruments_plant.py), so
that truth is known exactly."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from bench import bench_output, instruments_real
from bench.instruments_plant import LATE, PAIRS, SIZES, planted
from bench.options import positive
from bench.reference.hulls import HULLS
from bench.reference.sea_voyage import Recording, SeaCase, simulate
from twin.recording.raw import Raw
from twin.recording.voyage import Voyage
from twin.study.instruments.instrument_estimate import Instruments, estimate

EPILOG = """example: twin-bench instruments --seeds 2 --markdown docs/results/instruments.md

Exit code 0: the table is made; nothing is a threshold.
"""
SHIPS = ("container", "kvlcc2", "usv")
FIRST_SEED = 11
BOAT = 6.0
# healthy instruments of the sea are late by LATE, and the wind pushes: to find that is right
TRUE = ("gnss_delay", "log_delay", "leeway")


@dataclass
class ResultRow:
    """One set of faults: how often each was named, what else was, and errors over the bound."""

    faults: tuple[str, ...]
    cases: int = 0
    named: int = 0  # all of the set seen
    more: list[str] = field(default_factory=list)  # faults seen that were not there
    errors: dict[str, list[float]] = field(default_factory=dict)
    bounds: dict[str, list[float]] = field(default_factory=dict)

    def enter(self, found: Instruments, truth: dict[str, float]) -> None:
        self.cases += 1
        wanted = [f for f in self.faults if f not in ("nothing", "current")]
        self.named += all(f in found.faults for f in wanted)
        self.more += [f for f in found.faults if f not in (*wanted, *TRUE)]
        for name in (n for f in self.faults for n in SIZES[f]):
            e = found.of(name)
            if e is None:
                continue
            self.errors.setdefault(name, []).append(e.value - truth[name])
            self.bounds.setdefault(name, []).append(e.sd)

    def ratio(self) -> dict[str, float]:
        """RMS error over the Cramer-Rao bound, number by number."""
        return {
            n: float(np.sqrt(np.mean((np.array(e) / np.array(self.bounds[n])) ** 2)))
            for n, e in self.errors.items()
        }


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument(
        "--seeds", metavar="N", type=positive, default=2, help="voyages of each hull (%(default)s)"
    )
    parser.add_argument(
        "--minutes", metavar="MIN", type=positive, default=25, help="length of a voyage (%(default)s)"
    )
    parser.add_argument(
        "--hull", metavar="NAME", action="append", choices=SHIPS, help="one hull alone (repeat)"
    )
    parser.add_argument(
        "--bridge", action="store_true", help="velocities over ground turned by the ship's own compass"
    )
    parser.add_argument(
        "--data", metavar="DIR", type=Path, help="real voyages too (logs/nmea2000 and esso_osaka in DIR)"
    )
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    hulls = tuple(args.hull or SHIPS)
    voyages = simulate([_case(h, FIRST_SEED + s, args.minutes) for h in hulls for s in range(args.seeds)])
    rows = measured(voyages, args.bridge)
    result = {
        "schema_version": 1,
        "hulls": list(hulls),
        "seeds": args.seeds,
        "bridge": args.bridge,
        "rows": [_plain(r) for r in rows],
    }
    real = instruments_real.page(instruments_real.findings(args.data)) if args.data else []
    bench_output.give(
        args, result, "\n".join([*page(rows, hulls, args), *real]), bench_output.kept(args.page)
    )
    return 0


def _case(hull: str, seed: int, minutes: float) -> SeaCase:
    """A boat does in a sixth of the time what a ship does."""
    return SeaCase(
        hull,
        "mixed",
        "calm",
        (),
        seed=seed,
        duration_s=60.0 * minutes / (BOAT if HULLS[hull].L < 20.0 else 1.0),
    )


def measured(voyages: Sequence[Recording], bridge: bool) -> list[ResultRow]:
    rows = [ResultRow((name,)) for name in SIZES] + [ResultRow(pair) for pair in PAIRS]
    for row in rows:
        for recording in voyages:
            found, truth = finding(recording, row.faults, bridge)
            row.enter(found, truth)
        bench_output.tell(
            f"{' + '.join(row.faults)}: {row.named} of {row.cases}; more: {row.more}; {row.ratio()}"
        )
    return rows


def finding(
    recording: Recording, faults: tuple[str, ...], bridge: bool
) -> tuple[Instruments, dict[str, float]]:
    """What is found of one voyage with these faults, and the truth."""
    hull = HULLS[recording.case.hull]  # type: ignore[index]
    columns, truth = planted(recording.columns, recording.truth, hull, faults, bridge)
    time_s = columns.pop("time_s")
    name = f"{recording.case.hull}-{recording.case.seed}"
    raw = Raw(
        Path(f"{name}.csv"),
        np.arange(time_s.size),
        time_s,
        columns,
        {"velocity_frame": "course" if bridge else "body"},
    )
    return estimate([Voyage.of(raw, controls=False)], hull.L), truth


def _plain(row: ResultRow) -> dict[str, Any]:
    return {
        "faults": list(row.faults),
        "cases": row.cases,
        "named": row.named,
        "more": row.more,
        "rms_over_bound": row.ratio(),
        "errors": row.errors,
        "bounds": row.bounds,
    }


def page(rows: Sequence[ResultRow], hulls: Sequence[str], args: argparse.Namespace) -> list[str]:
    """Markdown."""
    every = [np.array(e) / np.array(r.bounds[n]) for r in rows for n, e in r.errors.items()]
    told = np.concatenate(every)
    return [
        "# Instruments by kinematics",
        "",
        f"`twin-bench instruments --seeds {args.seeds} --minutes "
        f"{args.minutes:g}{' --bridge' if args.bridge else ''}"
        f"{' --data DIR' if args.data else ''}`: {', '.join(hulls)}; "
        "calm, manoeuvres of all kinds, a boat for a sixth of the time. Healthy instruments of the sea are "
        "late: satellites "
        f"{LATE['gnss']} s, log {LATE['log']} s; to find that is right.",
        "",
        f"All {told.size} numbers together: RMS error {np.sqrt(np.mean(told**2)):.2f} times the "
        "Cramer-Rao bound; "
        f"{100 * np.mean(np.abs(told) < 1.96):.0f} % of the truths inside the 95 % interval.",
        "",
        "| planted | seen | what else was named | RMS error / bound |",
        "|---|---|---|---|",
        *map(_line, rows),
    ]


def _line(r: ResultRow) -> str:
    ratios = ", ".join(f"{n} {x:.2f}" for n, x in r.ratio().items())
    return f"| {' + '.join(r.faults)} | {r.named}/{r.cases} | {_counted(r.more)} | {ratios} |"


def _counted(names: Sequence[str]) -> str:
    return ", ".join(f"{n} x{names.count(n)}" for n in sorted(set(names))) or "-"

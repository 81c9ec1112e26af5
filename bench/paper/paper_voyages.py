"""The paper's voyages, sailed on the reference sea: TS-01 to TS-03 (Table 2), and zigzags that no model has
seen.

72 runs of 900 s are the paper's 18 h at 10 Hz (648 000 samples). Scenarios take turns, so that each part of
the split has all."""

import hashlib
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bench.reference import HULLS, Recording, SeaCase, simulate
from twin.recording.voyage import Voyage

SCENARIOS = ("TS-01", "TS-02", "TS-03")
RUN_S, STARTS_S = 900.0, (290.0, 350.0, 410.0, 470.0, 530.0)  # of every voyage, and where its windows begin
MANOEUVRES = ("zigzag_20", "mixed", "mixed", "zigzag_10", "mixed")  # of the lessons
DRIVEN = (1.0, 1.05, 0.45)  # and their speeds, of U_0
GNSS_LATE_S = 0.1
TRUE = ("north", "east", "psi")


@dataclass(frozen=True)
class PaperPlan:
    """How much is sailed: runs to learn from, zigzags for each scenario and angle, for each changed ship, for
    each speed."""

    runs: int
    zigzags: int
    changed: int
    speeds: int
    angles: tuple[int, ...] = (10, 20)  # of the zigzags of changed ships and other speeds
    curve: tuple[int, ...] = (1, 4)  # runs that teach, for the curve of error over data
    closed: int = 20  # seeds of the closed loop
    seeds: tuple[int, ...] = (42, 123, 256, 512, 1024)  # of the hybrid
    epochs: int = 150  # at most, of single moments
    rollout_epochs: int = 40
    rollout_batch: int = 256
    lstm_epochs: int = 150
    resamples: int = 10_000  # of Table 4; half as many of Table 6
    tick_s: float = 0.1  # of the sea
    run_s: float = RUN_S
    starts_s: tuple[float, ...] = STARTS_S


QUICK = PaperPlan(15, 2, 1, 1, (20,), (3,), 2, (42,), 25, 12, 64, 30)
FULL_PLAN = PaperPlan(72, 15, 5, 5)
SPEEDS = {
    "Maneuvering": 0.333,
    "Cruising": 0.677,
    "Full speed": 0.935,
}  # 5, 10.5 and 14.5 kn of 15.5: it has no 20 kn


@dataclass(frozen=True)
class PaperVoyage:
    """A voyage as measured, and where it truly was (N, 3) at its samples."""

    voyage: Voyage
    truth: np.ndarray


def lessons(plan: PaperPlan) -> list[SeaCase]:
    """What is learned from, in the order of time. Any 15 in a row hold the same manoeuvres in the same seas,
    so that training, validation and test are alike; speeds take turns with them. It is driven harder than
    its service speed and slower than half of
    it: what a network was never shown (a propeller that turns faster than U_0 needs) it must leave to the
        physics."""
    return [
        SeaCase(
            "kvlcc2",
            MANOEUVRES[(i // 3) % len(MANOEUVRES)],
            SCENARIOS[i % 3],
            seed=1000 + i,
            duration_s=plan.run_s,
            speed_fraction=DRIVEN[(i // 3 + i + i // 15) % len(DRIVEN)],
        )
        for i in range(plan.runs)
    ]


def zigzags(
    count: int,
    seed: int,
    scenarios: Sequence[str] = SCENARIOS,
    angles: Sequence[int] = (10, 20),
    **changes: Any,
) -> list[SeaCase]:
    """`count` zigzags of each of `angles` (10/10 and 20/20) in each scenario."""
    return [
        replace(
            SeaCase("kvlcc2", f"zigzag_{angle}", ts, seed=seed + 100 * i + 10 * j + 1, duration_s=RUN_S),
            **changes,
        )
        for i in range(count)
        for j, ts in enumerate(scenarios)
        for angle in angles
    ]


def unseen(plan: PaperPlan) -> list[SeaCase]:
    """The zigzags of Tables 3 to 6."""
    return zigzags(plan.zigzags, 9001, duration_s=plan.run_s)


def changed(plan: PaperPlan) -> dict[str, list[SeaCase]]:
    """Table 7: the ship as the models know it, and two that are not."""
    hull = HULLS["kvlcc2"]
    heavy = replace(hull, name="kvlcc2", m=1.05 * hull.m)
    held = replace(hull, R0=1.1 * hull.R0, X=_more(hull.X, 1.1), Y=_more(hull.Y, 1.1), N=_more(hull.N, 1.1))
    return {
        "as it is": zigzags(plan.changed, 50_000, angles=plan.angles, duration_s=plan.run_s),
        "Mass error M (+5%)": zigzags(
            plan.changed, 50_000, angles=plan.angles, duration_s=plan.run_s, hull=heavy
        ),
        "Damping error D (+10%)": zigzags(
            plan.changed, 50_000, angles=plan.angles, duration_s=plan.run_s, hull=held
        ),
    }


def _more(derivatives: tuple[float, ...], by: float) -> tuple[float, ...]:
    return tuple(by * d for d in derivatives)


def without_gnss_noise(sailed: PaperVoyage) -> PaperVoyage:
    """The same voyage with places as they were, 0.1 s late as the receiver is."""
    v = sailed.voyage
    exact = {
        name: np.interp(v.time_s - GNSS_LATE_S, v.time_s, sailed.truth[:, i])
        for i, name in enumerate(("north_m", "east_m"))
    }
    seen = {name: np.where(np.isfinite(v.columns[name]), x, np.nan) for name, x in exact.items()}
    return PaperVoyage(v.with_rows(v.time_s, dict(v.columns) | seen), sailed.truth)


def by_speed(plan: PaperPlan) -> dict[str, list[SeaCase]]:
    """Table 8."""
    return {
        name: zigzags(plan.speeds, 60_000, angles=plan.angles, duration_s=plan.run_s, speed_fraction=share)
        for name, share in SPEEDS.items()
    }


def sail(
    cases: Sequence[SeaCase], folder: Path, tell: Callable[[str], None], tick_s: float = 0.1
) -> list[PaperVoyage]:
    """These voyages, from the folder where they were sailed before."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{_key(case)}.npz" for case in cases]
    due = [(c, p) for c, p in zip(cases, paths, strict=True) if not p.exists()]
    if due:
        tell(f"sailing {len(due)} voyages of {cases[0].duration_s:g} s")
    for k in range(0, len(due), 48):
        some = due[k : k + 48]
        for recording, (_, path) in zip(simulate([c for c, _ in some], tick_s), some, strict=True):
            _write(recording, path)
    return [_read(case, path) for case, path in zip(cases, paths, strict=True)]


def _key(case: SeaCase) -> str:
    # voyages sailed before there were changes keep their names
    told = repr(case).replace(", change=None", "")
    return f"{case.manoeuvre}-{case.weather}-{case.seed}-{hashlib.sha256(told.encode()).hexdigest()[:10]}"


def _write(recording: Recording, path: Path) -> None:
    truth = np.column_stack([recording.truth[name] for name in TRUE])
    with open(aside := path.with_suffix(".part"), "wb") as out:
        np.savez(out, truth=truth, **recording.columns)
    os.replace(aside, path)


def _read(case: SeaCase, path: Path) -> PaperVoyage:
    with np.load(path) as held:
        columns = {name: held[name].astype(float) for name in held.files}
    truth = columns.pop("truth")
    return PaperVoyage(
        Voyage(f"{case.weather} {case.manoeuvre} {case.seed}", columns.pop("time_s"), columns), truth
    )

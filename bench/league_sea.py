"""Voyages for the league: sailed many at a time, kept in a folder until they are judged; and the ships that judge them."""

import json
import os
import pickle
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bench import league_plan as plan
from bench.reference import Case, Recording, simulate
from twin.physics.effects import find
from twin.physics.ship import Ship, load
from twin.study.adding import fitted
from twin.study.calibrate import calibrate
from twin.study.sailed import Sailed
from twin.study.track import track
from twin.study.voyage import Voyage

BATCH = 96  # ships that sail side by side


def name_of(case: Case) -> str:
    """A file name that no other voyage of the league has."""
    hidden = [f"{n}:{s:g}" for n, s in case.hidden]
    return "_".join([str(case.hull), str(case.manoeuvre), *hidden, *case.decoys, f"{case.duration_s:g}s", str(case.seed)])


def voyage(recording: Recording) -> Voyage:
    """What was measured, and nothing else."""
    columns = {name: np.asarray(x, float) for name, x in recording.columns.items()}
    return Voyage(name_of(recording.case), columns.pop("time_s"), columns)


def sail(cases: Sequence[Case], folder: Path) -> None:
    """Sail these voyages and keep them; those that are there already are not sailed again."""
    folder.mkdir(parents=True, exist_ok=True)
    cases = [c for c in dict.fromkeys(cases) if not (folder / f"{name_of(c)}.npz").exists()]
    for recording in simulate(cases, batch=BATCH):
        path = folder / f"{name_of(recording.case)}.npz"
        columns = {name: x.astype(np.float32) for name, x in recording.columns.items() if name != "time_s"}
        with open(aside := path.with_suffix(".part"), "wb") as out:
            np.savez(out, time_s=recording.columns["time_s"], truth=json.dumps(recording.hidden), **columns)
        os.replace(aside, path)


def kept(case: Case, folder: Path) -> tuple[Voyage, dict[str, Any]]:
    """A voyage that was sailed, and what was hidden in it."""
    with np.load(folder / f"{name_of(case)}.npz") as held:
        columns = {name: held[name].astype(float) for name in held.files if name != "truth"}
        truth = json.loads(str(held["truth"]))
    return Voyage(name_of(case), columns.pop("time_s"), columns), truth


def forget(cases: Sequence[Case], folder: Path) -> None:
    for case in cases:
        (folder / f"{name_of(case)}.npz").unlink(missing_ok=True)


def fleet_cases(hull: str, duration_s: float | None, few: bool) -> list[Case]:
    """Every voyage from which the ships of a hull are made."""
    weather = [] if few else [c for n in plan.WEATHERS for c in plan.weather_references(hull, n, duration_s)]
    return plan.references(hull, duration_s) + weather


def ships(hull: str, folder: Path, duration_s: float | None = None, few: bool = False) -> dict[str, Any]:
    """{"": the ship calibrated on the reference voyages, "Wind": the same with that effect fitted ..., "calibration": how well}."""
    start = load(hull)
    sailed = [_sailed(kept(c, folder)[0], start) for c in plan.references(hull, duration_s)]
    done = calibrate(sailed[:-1], [(sailed[-1].track, 0)], start)
    out: dict[str, Any] = {"": done.ship, "calibration": done.result}
    for effect in () if few else plan.WEATHERS:
        tracks = [track(kept(c, folder)[0], done.ship) for c in plan.weather_references(hull, effect, duration_s)]
        out[effect] = done.ship.with_effects(*fitted(done.ship, [find(effect)], tracks)[0].effects)
    return out


def _sailed(v: Voyage, ship: Ship) -> Sailed:
    return Sailed(v, track(v, ship), v.name)


def make_ships(hull: str, folder: Path, duration_s: float | None, few: bool) -> None:
    """Calibrate a hull's ships and keep them beside the voyages."""
    path = folder / f"{hull}.ship"
    if not path.exists():
        path.write_bytes(pickle.dumps(ships(hull, folder, duration_s, few)))


def ships_of(hull: str, folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = pickle.loads((folder / f"{hull}.ship").read_bytes())
    return found

"""Voyages for the league: sailed many at a time, kept in a folder until they are judged."""

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bench.reference import Recording, SeaCase, simulate
from twin.recording.voyage import Voyage

BATCH = 96  # ships that sail side by side


def name_of(case: SeaCase) -> str:
    """A file name that no other voyage of the league has."""
    hidden = [f"{n}:{s:g}" for n, s in case.hidden]
    return "_".join(
        [str(case.hull), str(case.manoeuvre), *hidden, *case.decoys, f"{case.duration_s:g}s", str(case.seed)]
    )


def voyage(recording: Recording) -> Voyage:
    """What was measured, and nothing else."""
    columns = {name: np.asarray(x, float) for name, x in recording.columns.items()}
    return Voyage(name_of(recording.case), columns.pop("time_s"), columns)


def sail(cases: Sequence[SeaCase], folder: Path) -> None:
    """Sail these voyages and keep them; those that are there already are not sailed again."""
    folder.mkdir(parents=True, exist_ok=True)
    cases = [c for c in dict.fromkeys(cases) if not (folder / f"{name_of(c)}.npz").exists()]
    for recording in simulate(cases, batch=BATCH):
        path = folder / f"{name_of(recording.case)}.npz"
        columns = {name: x.astype(np.float32) for name, x in recording.columns.items() if name != "time_s"}
        with open(aside := path.with_suffix(".part"), "wb") as out:
            np.savez(out, time_s=recording.columns["time_s"], truth=json.dumps(recording.hidden), **columns)
        os.replace(aside, path)


def kept(case: SeaCase, folder: Path) -> tuple[Voyage, dict[str, Any]]:
    """A voyage that was sailed, and what was hidden in it."""
    with np.load(folder / f"{name_of(case)}.npz") as held:
        columns = {name: held[name].astype(float) for name in held.files if name != "truth"}
        truth = json.loads(str(held["truth"]))
    return Voyage(name_of(case), columns.pop("time_s"), columns), truth


def forget(cases: Sequence[SeaCase], folder: Path) -> None:
    for case in cases:
        (folder / f"{name_of(case)}.npz").unlink(missing_ok=True)

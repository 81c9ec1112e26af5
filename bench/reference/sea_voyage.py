"""Voyages: cases in, recordings out."""

from dataclasses import dataclass, field

import numpy as np

from bench.reference.sea import ORIGINS, TRUE, Sea, hull_of
from bench.reference.sensor_suite import COLUMNS

HALF_HOUR = 1800.0
AXES = ("X_N", "Y_N", "N_Nm")


@dataclass(frozen=True)
class Change:
    """From `at_s` on it is another `hull` of the same length, and the wind blows `wind` times as hard; all
    else goes on."""

    at_s: float
    hull: object = None  # as in SeaCase; None: the usual one
    wind: float = 1.0


@dataclass(frozen=True)
class SeaCase:
    """One voyage to sail. `hidden`: pairs (effect, strength); `decoys`: strong weather that is no riddle.

    `weather` is relative to the first heading, which the seed draws unless `heading_deg` fixes it.
    `sensors` is "ship" or "perfect". A `Sea` takes `duration_s=None` for a voyage without an end.
    """

    hull: object = "kvlcc2"  # a name of hulls.HULLS or a Hull
    manoeuvre: object = "mixed"  # a name of manoeuvres.MANOEUVRES or a tuple of Legs
    weather: object = "calm"  # a name of weather.WEATHERS or a Weather
    hidden: tuple = ()
    decoys: tuple = ()
    seed: int = 0
    duration_s: float | None = HALF_HOUR
    speed_fraction: float = 1.0
    heading_deg: float | None = None
    sensors: str = "ship"
    change: Change | None = None  # in the middle of the voyage


@dataclass
class Recording:
    """What was measured (`columns`), what was true (`truth`), what was hidden, and forces given as known."""

    case: SeaCase
    columns: dict = field(repr=False)
    truth: dict = field(repr=False)
    hidden: dict = field(default_factory=dict)
    known_forces: dict = field(default_factory=dict, repr=False)

    def write_csv(self, path):
        """The measured columns, empty where there was no sample."""
        table = np.column_stack([self.columns[name] for name in COLUMNS])
        with open(path, "w") as out:
            out.write(",".join(COLUMNS) + "\n")
            for row in table.tolist():
                out.write(",".join("" if x != x else f"{x:.10g}" for x in row) + "\n")


def simulate(cases, tick_s=0.1, batch=64) -> list[Recording]:
    """Sail all cases, many at a time; a ship's voyage does not depend on the ships that sail beside it."""
    cases, out = list(cases), {}
    sizes = {}
    for i, case in enumerate(cases):
        sizes.setdefault((hull_of(case).L < 20, case.duration_s), []).append(i)
    for members in sizes.values():
        for k in range(0, len(members), batch):
            chosen = members[k : k + batch]
            out.update(zip(chosen, _sail([cases[i] for i in chosen], tick_s), strict=True))
    return [out[i] for i in range(len(cases))]


def _sail(cases, tick_s):
    ships = cases if len(cases) > 1 else cases * 2
    sea, count = Sea(ships, tick_s), [round(c.duration_s / tick_s) + 1 for c in ships]
    rows = max(count)
    measured = np.empty((rows, len(COLUMNS), len(ships)))
    true, forces = (
        np.empty((rows, len(TRUE), len(ships))),
        np.empty((rows, len(ORIGINS), 3, len(ships)), np.float32),
    )
    for i in range(rows):
        if i:
            sea.step()
        np.concatenate([sea.row[name] for name in COLUMNS], out=measured[i].reshape(-1))
        np.concatenate(list(sea.true.values()), out=true[i].reshape(-1))
        forces[i] = sea.forces
    return [
        _recording(sea, k, cases[k], *(a[: count[k], ..., k].copy() for a in (measured, true, forces)))
        for k in range(len(cases))
    ]


def _recording(sea, k, case, measured, true, forces):
    columns = dict(zip(COLUMNS, np.ascontiguousarray(measured.T), strict=True))
    truth = dict(zip(TRUE, np.ascontiguousarray(true.T), strict=True))
    truth["forces"] = {
        origin: dict(zip(AXES, np.ascontiguousarray(forces[:, i].T), strict=True))
        for i, origin in enumerate(ORIGINS)
    }
    hidden = {name: dict(facts) for name, facts in sea.hidden[k].items()}
    for name in hidden:
        if name in sea.tally.squares:
            hidden[name]["typical_force"] = dict(zip(AXES, sea.tally.typical(name, k), strict=True))
    return Recording(case, columns, truth, hidden, truth["forces"]["known"])

"""Reference voyages through the loop that the service builds, each kept in a file of its own: a run that was
broken off goes on where it stopped."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np

from bench import bench_output
from bench.reference import SeaCase, Weather, simulate
from bench.reference.hulls import HULLS
from bench.reference.sea_voyage import Recording
from bench.sea_disturbance import HIGHEST
from bench.through_loop import through
from twin import whole
from twin.live.guard import INVALID
from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import Prediction
from twin.live.prediction.circumstances import Regressors
from twin.live.prediction.due_predictions import Watch
from twin.live.prediction.judge import Foretold, VerifiedPrediction
from twin.study.reference.foretold import Errors

HORIZONS_S = (10.0, 60.0, 120.0)
STEP_S = {"kvlcc2": 0.2, "container": 0.2, "kvlcc2_model": 0.1, "usv": 0.1}  # of the loop
SECONDS = {"kvlcc2": 600.0, "container": 600.0, "kvlcc2_model": 300.0, "usv": 300.0}
BATCH = 16
ROUNDS_PER_VERDICT = 3  # of the predictions on file, one in each round of 2 s, one in so many is judged


@dataclass(frozen=True)
class TubeVoyage:
    """Errors of the twin's predictions and of dead reckoning, with the helm held, and the wave height [m]."""

    hull: str
    number: int
    H_s: float
    model: Errors
    reckoning: Errors


def case(hull: str, k: int) -> SeaCase:
    """Voyage k: any sea up to the ship's highest, wind and current grow with it; any manoeuvre."""
    rng = np.random.default_rng([9000, k])
    scale = HULLS[hull].scale
    H_s = HIGHEST[hull] * rng.uniform(0.02, 1.0)
    full = H_s / scale  # the wave height of the full-sized ship
    weather = Weather(
        wind_mps=rng.uniform(6.0, 11.0) * full**0.5 * scale**0.5,
        wind_from_deg=rng.uniform(0.0, 360.0),
        wave_height_m=H_s,
        wave_period_s=max(rng.uniform(5.1, 7.5) * H_s**0.5, 3.0 * scale**0.5),
        wave_from_deg=rng.uniform(0.0, 360.0),
        current_mps=rng.uniform(0.1, 0.5) * full**0.5 * scale**0.5,
        current_to_deg=rng.uniform(0.0, 360.0),
        current_spread_mps=0.05 * full**0.5 * scale**0.5,
    )
    return SeaCase(hull, "mixed", weather, seed=9000 + k, duration_s=SECONDS[hull])


def voyages(hull: str, count: int, folder: Path) -> list[TubeVoyage]:
    """The first `count` voyages of a hull, those that are on file already and the others."""
    folder.mkdir(parents=True, exist_ok=True)
    missing = [k for k in range(count) if not _path(folder, hull, k).exists()]
    for first in range(0, len(missing), BATCH):
        batch = missing[first : first + BATCH]
        bench_output.tell(f"{hull}: sailing voyages {batch[0]} to {batch[-1]} of {count}")
        for k, r in zip(batch, simulate([case(hull, k) for k in batch], STEP_S[hull]), strict=True):
            whole.write(_path(folder, hull, k), json.dumps(looked_at(hull, r)))
            bench_output.tell(f"{hull} {k}")
    return [on_file(folder, hull, k) for k in range(count)]


def looked_at(hull: str, r: Recording) -> dict[str, Any]:
    """Model and dead reckoning on one voyage, as JSON."""
    found: dict[str, dict[str, list[Any]]] = {
        who: {f"{h:g}": [] for h in HORIZONS_S} for who in ("model", "reckoning")
    }
    watches: dict[str, Watch] = {}
    for _, _, loop in through(hull, r, STEP_S[hull]):
        seen = loop.last
        watches = watches or {who: Watch(loop.ship, HORIZONS_S) for who in found}
        good, e = seen.verdict.mode != INVALID, seen.estimate
        for who, ahead in (("model", seen.ahead), ("reckoning", [reckoned(e, p) for p in seen.ahead])):
            for h, j in watches[who].look(seen.instant.time_s, seen.measured, e, ahead, good):
                if j.held:
                    found[who][f"{h:g}"].append(_row(j))
    return {"H_s": r.case.weather.wave_height_m, **found}


def reckoned(e: Estimate, p: Prediction) -> Prediction:
    """The same by dead reckoning: speed over ground and rate of turn stay as they are."""
    t, r = p.horizon_s, e.r if abs(e.r) > 1e-7 else 1e-7
    psi = e.psi + r * t
    ahead, aside = (sin(psi) - sin(e.psi)) / r, (cos(e.psi) - cos(psi)) / r
    x, y = e.x + e.u * ahead - e.v * aside, e.y + e.u * aside + e.v * ahead
    return p._replace(state=(x, y, psi, e.u, e.v, e.r), age_s=0.0)


def on_file(folder: Path, hull: str, k: int) -> TubeVoyage:
    kept = json.loads(_path(folder, hull, k).read_text())
    model, reckoning = (
        {float(h): [_verified(row) for row in rows[::ROUNDS_PER_VERDICT]] for h, rows in kept[who].items()}
        for who in ("model", "reckoning")
    )
    return TubeVoyage(hull, k, kept["H_s"], model, reckoning)


def _row(j: VerifiedPrediction) -> list[Any]:
    f = j.foretold
    numbers = [f.said_s, j.along, j.across, j.heading, *f.known.place, *f.known.heading]
    return [f.known.helm, f.known.sea, *(round(float(x), 7) for x in numbers)]


def _verified(row: Sequence[Any]) -> VerifiedPrediction:
    helm, sea, said_s, along, across, heading, *phi = row
    n = len(phi) // 2
    known = Regressors(tuple(phi[:n]), tuple(phi[n:]), helm, sea)
    return VerifiedPrediction(Foretold(said_s, said_s, said_s, (), known), along, across, heading, True)


def _path(folder: Path, hull: str, k: int) -> Path:
    return folder / f"{hull}-{k:03d}.json"

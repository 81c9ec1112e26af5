"""A tanker's model in an open pond with measured wind: python -m bench.real.esso_osaka FOLDER --page PAGE.md

Runs of FRT-DS-ESSO (Wakita et al. 2022, doi 10.1007/s00773-021-00867-1; Miyauchi et al. 2022, doi
10.1007/s00773-022-00889-3). The model is calibrated on the calmest, and asked of each of the others: with the
wind hidden from it, with the wind, and with a known fault put into compass, rudder angle or receiver. Two
sets of references show what the answers owe to their choice. FOLDER keeps the ships and a line of JSON an
answer; what it holds already is not asked again."""

import argparse
import json
import os
import pickle
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bench.decisions.pond import begun_esso, pond_voyage
from bench.fleet.fleet_page import by_hand
from bench.real.esso_page import page
from bench.real.planted_faults import FAULTS, PlantedFault
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.calibration.core_fit import calibrate
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track

CALMEST = 5  # runs of zigzag and turning circle with the least wind for their speed
PLANTED = (
    "HeadingBias",
    "RudderOffset",
    "SensorDelay",
)  # the catalogue's names of what is put into the readings


@dataclass(frozen=True)
class ReferenceRuns:
    """Runs that the model is calibrated on: the calmest zigzags and circles, and `random` of random
    steering."""

    name: str
    random: int


REFERENCES = (ReferenceRuns("calmest five", 0), ReferenceRuns("calmest five and one of random steering", 1))


def windiness(v: Voyage) -> float:
    """Mean true wind over mean speed. [1]"""
    speed = np.hypot(v["surge_velocity_mps"], v["sway_velocity_mps"])
    return float(np.nanmean(v["true_wind_speed_mps"]) / np.nanmean(speed))


def chosen(runs: Sequence[Voyage], references: ReferenceRuns) -> list[Voyage]:
    """The reference runs: by their wind alone, before anything is asked."""
    calm = sorted((v for v in runs if "random" not in v.name), key=windiness)[:CALMEST]
    return [*calm, *sorted((v for v in runs if "random" in v.name), key=windiness)[: references.random]]


def calibrated(runs: Sequence[Voyage], references: ReferenceRuns, folder: Path) -> Ship:
    """The ship fitted to its references; the file that the folder keeps is taken if it is there."""
    path = folder / f"{references.name.replace(' ', '-')}.pickle"
    if not path.exists():
        start = begun_esso(folder / "start.toml")
        sailed = [Sailed(v, track(v, start), v.name) for v in chosen(runs, references)]
        path.write_bytes(pickle.dumps(calibrate(sailed, [(sailed[-1].track, 0)], start).ship))
    ship: Ship = pickle.loads(path.read_bytes())
    return ship


def without_wind(ship: Ship) -> Ship:
    return replace(ship, effects=tuple(e for e in ship.effects if type(e).__name__ != "Wind"))


@dataclass(frozen=True)
class PondQuestion:
    """One question: which voyages, what the ship knows, and the fault in their readings."""

    references: ReferenceRuns
    of: str
    voyages: tuple[Voyage, ...]
    wind: str  # hidden or given
    fault: PlantedFault

    def key(self) -> tuple[str, str, str, str]:
        return self.references.name, self.of, self.wind, self.fault.words


def questions(runs: Sequence[Voyage]) -> Iterator[PondQuestion]:
    """Every other run that is no reference of any set, each by itself, and all of a kind together."""
    taken = {v.name for r in REFERENCES for v in chosen(runs, r)}
    others = [v for v in runs if v.name not in taken and "random" not in v.name]
    together = [
        (f"all {kind}s", tuple(v for v in others if v.name.startswith(kind))) for kind in ("zigzag", "turn")
    ]
    nothing, planted = FAULTS[0], [f for f in FAULTS if f.effects in [(name,) for name in PLANTED]]
    for of, voyages in [*((v.name, (v,)) for v in others), *(g for g in together if len(g[1]) > 1)]:
        for references in REFERENCES:
            yield PondQuestion(references, of, voyages, "hidden", nothing)
            yield PondQuestion(references, of, voyages, "given", nothing)
        for fault in planted:
            yield PondQuestion(REFERENCES[-1], of, voyages, "given", fault)


def answered(asked: PondQuestion, ship: Ship) -> dict[str, Any]:
    """What the diagnosis says, with the facts that it was decided from."""
    knows = without_wind(ship) if asked.wind == "hidden" else ship
    L, U = float(knows.L_pp), float(knows.scale("speed"))
    began = time.process_time()
    found = diagnose([asked.fault.put(v, L, U) for v in asked.voyages], knows).result
    keys = (
        "verdict",
        "reason",
        "missing",
        "one_of",
        "probabilities",
        "candidates",
        "weather",
        "path",
        "facts",
    )
    references, of, wind, put = asked.key()
    row = {"references": references, "of": of, "wind": wind, "put": put, "effects": asked.fault.effects}
    row |= {"windiness": float(np.mean([windiness(v) for v in asked.voyages])), "runs": len(asked.voyages)}
    row |= {"cpu_s": time.process_time() - began}
    return dict(plain(row | {k: found[k] for k in keys}))


def rows_of(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m bench.real.esso_osaka", description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--data", metavar="DIR", default=os.environ.get("SHIPTWIN_DATA"))
    parser.add_argument("--page", type=Path, metavar="FILE.md")
    args = parser.parse_args()
    root = Path(args.data or ".") / "esso_osaka"
    if not args.data or not root.is_dir():
        parser.error(f"{root}: the runs are not there. Set SHIPTWIN_DATA to the folder above esso_osaka.")
    args.folder.mkdir(parents=True, exist_ok=True)
    runs = [pond_voyage(p) for p in sorted(root.glob("*.csv"))]
    out = args.folder / "rows.jsonl"
    done = {(r["references"], r["of"], r["wind"], r["put"]) for r in rows_of(out)}
    for asked in questions(runs):
        if asked.key() not in done:
            row = answered(asked, calibrated(runs, asked.references, args.folder))
            with out.open("a") as file:
                file.write(json.dumps(row) + "\n")
            print(*asked.key(), row["verdict"], row["missing"], file=sys.stderr, flush=True)
    if args.page:
        args.page.write_text(page(rows_of(out)) + by_hand(args.page))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())

"""The measured KVLCC2 manoeuvres of SIMMAN 2008: published coefficients, calibration, and what the diagnosis
says of them."""

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bench import bench_output
from bench.real import planted_faults
from bench.real.page import page
from twin.errors import SettingsError
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage
from twin.study.calibration.core_fit import calibrate
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.prediction.open_loop_comparison import compare
from twin.study.prediction.score import reckoned
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track
from twin.study.update import adding

MAPS = Path(__file__).parents[2] / "docs" / "maps"
HORIZONS_S = (10.0, 60.0, 120.0)
# of the catalogue, what could make one side differ
ASYMMETRIC = ("RudderOffset", "PropellerWalk", "TowForce")
# of each answer, the facts that it was decided from too
KEPT = (
    *("verdict", "reason", "missing", "probabilities", "candidates", "next_manoeuvre", "not_judged"),
    "facts",
)
EPILOG = """example:
  SHIPTWIN_DATA=DIR twin-bench real --out docs/results/real-kvlcc2.md

DIR/kvlcc2_simman holds hsva/*.dat and marin/*.dat (no licence is stated for the data, so it is not in the
project).
"""


class Basin(NamedTuple):
    """One towing tank's runs. `fitted`: words of file names that the calibration may see; the others judge
    it."""

    name: str
    folder: str
    ship: str
    fitted: tuple[str, ...]
    words: str


BASINS = (
    Basin(
        "HSVA",
        "hsva",
        "kvlcc2_model",
        ("Z_10_05", "Z_15_01", "Z_20_05", "Z_35_05", "Z_10_10_S"),
        "7 m model, at model scale",
    ),
    Basin("MARIN", "marin", "kvlcc2", ("zz_-10", "zz_20"), "as given, already scaled to the ship (320 m)"),
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument(
        "--data", metavar="DIR", default=os.environ.get("SHIPTWIN_DATA"), help="default: $SHIPTWIN_DATA"
    )
    bench_output.add_arguments(parser, "--out")


def run(args: argparse.Namespace) -> int:
    root = Path(args.data or ".") / "kvlcc2_simman"
    if not args.data or not root.is_dir():
        raise SettingsError(
            f"{root}: the SIMMAN files are not there. Set SHIPTWIN_DATA to the folder above kvlcc2_simman."
        )
    result = {"schema_version": 1, "basins": [basin_figures(basin, root) for basin in BASINS]}
    bench_output.give(args, result, page(result))
    return 0


def basin_figures(basin: Basin, root: Path) -> dict[str, Any]:
    """Everything about one basin's runs."""
    bench_output.tell(f"{basin.name}: reading")
    ship, runs = load(basin.ship), voyages(basin, root)
    fitted = [s for s in runs if any(w in s.voyage.name for w in basin.fitted)]
    others = [s for s in runs if s not in fitted]
    bench_output.tell(f"{basin.name}: calibrating")
    after = calibrate(fitted, [(s.track, 0) for s in others], ship)
    return {
        "basin": basin.name,
        "words": basin.words,
        "ship": basin.ship,
        "runs": [
            {"name": s.voyage.name, "fitted": s in fitted, "duration_s": s.voyage.duration_s} for s in runs
        ],
        "published": [of_run(s, ship) for s in runs],
        "published_on_others": by_horizon(others, ship),
        "calibrated_on_others": by_horizon(others, after.ship),
        "floor": after.result["floor"],
        "temper": after.result["temper"],
        "helm": [helm(s) for s in runs],
        "asked": [effect_gain(name, fitted, others, after.ship) for name in ASYMMETRIC],
        "diagnoses": [
            diagnosed("published coefficients, all runs", runs, ship),
            diagnosed("calibrated ship, the runs that it was not fitted to", others, after.ship),
        ],
        "faults": [faulty(fault, others, after.ship) for fault in planted_faults.FAULTS],
    }


def voyages(basin: Basin, root: Path) -> list[Sailed]:
    by, ship = read_map(MAPS / f"kvlcc2_{basin.folder}.toml"), load(basin.ship)
    read = [read_voyage(path, by) for path in sorted((root / basin.folder).glob("*.dat"))]
    return [Sailed(v, track(v, ship), "") for v in read]


def by_horizon(runs: Sequence[Sailed], ship: Ship) -> list[dict[str, Any]]:
    """Errors at each horizon over these runs, with dead reckoning (the motion at the start goes on) beside
    them."""
    done = compare(runs, Model.of(ship), HORIZONS_S)
    rows = done.result["horizons"]
    for row in rows:
        off = [reckoned(w)[w.at(row["horizon_s"])] for w in done.windows]
        row["reckoned_m"] = float(np.nanmean(np.concatenate([np.hypot(o[:, 0], o[:, 1]) for o in off])))
        row["reckoned_deg"] = float(np.degrees(np.nanmean(np.abs(np.concatenate([o[:, 2] for o in off])))))
    return list(rows)


def of_run(s: Sailed, ship: Ship) -> dict[str, Any]:
    return {"name": s.voyage.name, "horizons": by_horizon([s], ship)}


def helm(s: Sailed) -> dict[str, Any]:
    """Mean rudder over whole zigzag cycles [deg, starboard positive]: zero for a hull that is alike on both
    sides."""
    delta = np.degrees(s.track.delta)
    up = np.flatnonzero((delta[1:] > 0.0) & (delta[:-1] <= 0.0))
    whole = delta[up[0] : up[-1]] if up.size > 1 else delta[:0]
    return {
        "name": s.voyage.name,
        "cycles": max(int(up.size) - 1, 0),
        "mean_rudder_deg": float(whole.mean()) if whole.size else None,
    }


def effect_gain(name: str, fitted: Sequence[Sailed], others: Sequence[Sailed], ship: Ship) -> dict[str, Any]:
    """The effect as if it had been named: fitted on the calibration's runs, judged on the others at the
    longest horizon."""
    bench_output.tell(f"adding {name}")
    made = adding.fitted(ship, [find(name)], [s.track for s in fitted])
    before, after = (by_horizon(others, s)[-1] for s in (ship, ship.with_effects(*made.model.effects)))
    return {
        "effect": name,
        "numbers": [{"name": n.name, **n.entry()} for n in made.numbers],
        "before": before,
        "after": after,
    }


def faulty(fault: planted_faults.PlantedFault, runs: Sequence[Sailed], ship: Ship) -> dict[str, Any]:
    bench_output.tell(f"putting into the readings: {fault.words}")
    return planted_faults.answer(fault, [s.voyage for s in runs], ship)


def diagnosed(words: str, runs: Sequence[Sailed], ship: Ship) -> dict[str, Any]:
    bench_output.tell(f"diagnosing: {words}")
    found = diagnose([s.voyage for s in runs], ship).result
    return {"of": words} | {k: found[k] for k in KEPT}

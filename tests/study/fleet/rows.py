"""Rows of voyages as `ask` gives them, by hand, and a ship of the fleet that has them."""

import shutil
from dataclasses import replace
from pathlib import Path

import twin
from twin.commands.story import SHIP
from twin.study.fleet.listing import FleetShip, FleetVoyage

SHARED = {
    "failed": None, "reason": "", "sentence": "", "duration_s": 600.0, "p_value": None, "p_value_at_best": None,
    "references": 0, "score": None, "horizon_s": 120.0, "position_mae_m": 9.0, "position_expected_m": 5.0,
    "data_checks": [], "lasting": True, "probability": 0.9, "posterior": 0.95, "says": "", "X_N": 0.0,
    "Y_N": 0.0, "N_Nm": 0.0, "cannot_be_told_from": [], "belongs_to": "ship",
}  # fmt: skip


def copied(ship, to):
    """A ship file copied, with the file of its arrays."""
    shutil.copy(ship, to)
    for arrays in Path(ship).parent.glob(f"{Path(ship).stem}.*.json"):
        shutil.copy(arrays, Path(to).parent)


def size(value, half=0.1):
    return {"name": "size", "value": value, "low95": value - half, "high95": value + half, "unit": "-",
            "at_box_end": False, "in_ship_file": None}  # fmt: skip


def named(voyage, day, value=0.3, effect="HullFouling", with_it=4.0, **other):
    return [
        SHARED
        | {"voyage": voyage, "start_time_utc": day, "verdict": "missing", "effect": effect, "named": True}
        | {"parameters": [size(value)], "error_without_m": 10.0, "error_with_m": with_it}
        | other
    ]


def plainly(voyage, day, verdict="nothing_missing", **other):
    return [SHARED | {"voyage": voyage, "start_time_utc": day, "verdict": verdict, "effect": None} | other]


def of(name, *voyages, scores=()):
    """A ship with these rows, one list a voyage; `scores`: of its reference voyages."""
    ship = twin.Ship.load(SHIP)
    notes = {"structural": {**ship.notes["structural"], "left_out_scores": list(scores)}}
    files = tuple(FleetVoyage(Path(f"{name}-{i}.mcap")) for i in range(len(voyages)))
    return FleetShip(name, Path(f"{name}.toml"), name, replace(ship, notes=notes), files), list(voyages)

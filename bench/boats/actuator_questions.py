"""What is asked of each craft: reference voyages to calibrate on, voyages that the fit never saw, and a
voyage for each fault of one actuator."""

import sys
import time
from pathlib import Path
from typing import Any

import twin
from bench.reference.boats import CRAFT, BoatCase, sail
from bench.reference.boats.builders_sheet import actuators, particulars
from twin.physics.actuators.file import read
from twin.physics.ship import Ship, load, text, to_table
from twin.physics.ship_file import value_of
from twin.recording.voyage import Voyage
from twin.study.first_model.first_estimate import OPTIONS, first_model

FITTED, UNSEEN, FAULTY = (11, 12, 13), (21, 22), (31, 32, 33)  # seeds
LENGTHS, LEAST_S = 45.0, 90.0  # how long a voyage lasts: in L/U0, and at least
Question = tuple[
    str, tuple[tuple[str, float], ...], str
]  # what is put in, as the sea has it, who should be named

QUESTIONS: dict[str, list[Question]] = {
    "catamaran": [
        ("worn", (("worn.port", 0.18),), "ThrusterWear.port"),
        ("late", (("late.port", 0.3),), "ActuatorLag.port"),
        ("off", (("zero.port", 0.05),), "ThrusterZero.port"),
        ("lost", (("lost.port", 1.0),), "ThrusterWear.port"),
        ("nothing", (), ""),
    ],
    "ferry2": [
        ("worn", (("worn.port", 0.18),), "ThrusterWear.port"),
        ("late", (("late.port", 0.3),), "ActuatorLag.port"),
        ("off", (("turned.port", 6.0),), "AngleOffset.port"),
        ("lost", (("lost.bow", 1.0),), "ThrusterWear.bow"),
        ("nothing", (), ""),
        ("screw", (("screw.port", 0.18),), "ThrusterWear.port"),
    ],
    "ferry4": [
        ("worn", (("worn.aft_port", 0.18),), "ThrusterWear.aft_port"),
        ("late", (("late.aft_port", 0.3),), "ActuatorLag.aft_port"),
        ("off", (("turned.aft_port", 6.0),), "AngleOffset.aft_port"),
        ("lost", (("lost.aft_port", 1.0),), "ThrusterWear.aft_port"),
        ("nothing", (), ""),
    ],
    "jet": [
        ("worn", (("worn.port", 0.18),), "ThrusterWear.port"),
        ("late", (("late.port", 0.3),), "ActuatorLag.port"),
        ("off", (("turned.port", 6.0),), "AngleOffset.port"),
        ("lost", (("lost.port", 1.0),), "ThrusterWear.port"),
        ("nothing", (), ""),
    ],
}


def say(text: str) -> None:
    print(f"  {time.strftime('%H:%M:%S')} {text}", file=sys.stderr, flush=True)


def from_sheet(name: str) -> Ship:
    """The first model that `twin init` makes of a builder's sheet."""
    craft = CRAFT[name]
    given = {option: particulars(craft).get(option) for option, *_ in OPTIONS}
    parts, _ = read(actuators(craft), f"{name}: ", value_of)
    return first_model(name, given, parts)[0]


def voyage(name: str, seed: int, hidden: tuple[tuple[str, float], ...] = ()) -> Voyage:
    craft = CRAFT[name]
    seconds = max(LENGTHS * craft.L / craft.U0, LEAST_S)
    columns = sail(BoatCase(name, "mixed", hidden, seed), seconds)
    return Voyage(f"{name} {seed}", columns.pop("time_s"), columns)


def calibrated(name: str) -> tuple[dict[str, Any], str]:
    """Errors on voyages that were not fitted, before and after; and the calibrated ship file."""
    begin, first = time.time(), from_sheet(name)
    unseen = [voyage(name, seed) for seed in UNSEEN]
    found = twin.calibrate(first, [voyage(name, seed) for seed in FITTED], held_out=unseen, progress=say)
    numbers = [dict(row) for row in found.data["derivatives"] if "." in row["name"]]
    row = {
        "craft": name,
        "what": "calibrate",
        "errors": [dict(e) for e in found.data["held_out"]],
        "warnings": found.warnings,
        "of_actuators": numbers,
        "seconds": round(time.time() - begin),
    }
    return row, text(to_table(found.ship))


def diagnosed(name: str, asked: Question, ship_file: Path, seed: int) -> dict[str, Any]:
    """What a diagnosis of one voyage says."""
    what, hidden, wanted = asked
    begin, ship = time.time(), load(ship_file)
    found = twin.diagnose(ship, voyage(name, seed, hidden), progress=say)
    shown = [dict(c) for c in found.data["candidates"][:4]]
    return {
        "craft": name,
        "what": what,
        "seed": seed,
        "hidden": hidden,
        "wanted": wanted,
        "verdict": found.verdict,
        "reason": found.reason,
        "named": found.effects,
        "sentence": found.sentence,
        "probabilities": found.data["probabilities"],
        "candidates": [{k: c.get(k) for k in ("effect", "probability", "parameters")} for c in shown],
        "not_visible": found.data["not_visible"],
        "error_ratios": [found.data["facts"][k] for k in ("error_nothing", "error_best")],
        "next_manoeuvre": found.data["next_manoeuvre"],
        "seconds": round(time.time() - begin),
    }

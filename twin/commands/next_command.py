"""What to type after a verb: its `next:` line."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from twin.physics.ship import load


def after_import(voyage: str, ship: str | None) -> str:
    """A ship that was never calibrated is, on its reference voyages, before anything is compared with it;
    whether this is one, nobody knows."""
    if ship and "structural" not in load(ship, arrays=False).notes:
        better = Path(ship).with_name(f"{Path(ship).stem}-calibrated.toml")
        return (
            "its model was not calibrated yet. Import the voyages on which nothing was wrong (three or "
            f"more), then twin calibrate ref-1.mcap ref-2.mcap ... --ship {ship} -o {better}; after that, "
            f"twin diagnose LATER.mcap --ship {better}"
        )
    return f"twin compare {voyage} --ship {ship or 'SHIP.toml'}"


def after_map(files: Sequence[str], made: str | None) -> str:
    """A map that was proposed is confirmed by a person."""
    by = f"twin import {' '.join(files)} --map {made} -o VOYAGE.mcap"
    return f"next: read it, correct what is marked, then {by}"


def after_instruments(voyages: Sequence[str], ship: str | None, output: str | None, faults: bool) -> str:
    """The same with the ship file to be corrected; a comparison, where one was written or no fault seen."""
    if not faults or (ship and output):
        return f"twin compare {' '.join(voyages)} --ship {(faults and output) or ship or 'SHIP.toml'}"
    return f"twin instruments {' '.join(voyages)} --ship {ship or 'SHIP.toml'} -o corrected.toml"


def after_compare(voyages: Sequence[str], ship: str, result: Mapping[str, Any]) -> str:
    """The diagnosis; before it a calibration, where the ship never had one."""
    calibrated = result["horizons"][-1]["noise_floor"]["of"] != "sensors"
    by = ship if calibrated else "calibrated.toml"
    diagnose = f"twin diagnose {' '.join(voyages)} --ship {by} --report diagnose.html"
    return diagnose if calibrated else f"twin calibrate REFERENCE.mcap --ship {ship} -o {by}, then {diagnose}"


def after_diagnose(voyages: Sequence[str], ship: str, result: Mapping[str, Any]) -> str:
    """What to sail where the voyages cannot tell, or more voyages; and what to add where a lasting cause was
    named."""
    paths, sail = " ".join(voyages), ""
    if result["next_manoeuvre"]:
        sail = f"sail {result['next_manoeuvre']['manoeuvre']}, then twin diagnose with that voyage too"
    if lasting := result["answer"]["lasting"]:
        add = f"twin add {' '.join(lasting)} --ship {ship} --voyage {paths} -o better.toml"
        return f"{sail}; or now: {add}" if sail else add
    if sail or result["verdict"] not in ("undecided", "unknown"):
        return sail or f"twin compare {paths} --ship {ship} --report compare.html"
    more = f"twin diagnose {paths} ANOTHER-DAY.mcap --ship {ship}"
    return f"{more} (a voyage of another day and on other courses, asked together with this, tells more)"


def add_typed(args: argparse.Namespace) -> str:
    """What was typed, for the page."""
    command = f"twin add {' '.join(args.effects)} --ship {args.ship} --voyage {' '.join(args.voyage)}"
    held_out = f" --held-out {' '.join(args.held_out)}" * bool(args.held_out)
    return f"{command}{held_out}{' --cross-validated' * args.cross_validated} -o {args.output}"

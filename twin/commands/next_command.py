"""What to type after a verb: its `next:` line."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from twin.physics.ship import load


def after_import(voyage: str, ship: str | None) -> str:
    """The comparison; before it a calibration, where the ship never had one."""
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
    return f"next: read and correct it, then twin import {' '.join(files)} --map {made} -o VOYAGE.mcap"


def after_instruments(voyages: Sequence[str], ship: str | None, output: str | None, faults: bool) -> str:
    """The same with the ship file to be corrected; a comparison, where one was written or no fault seen."""
    if not faults or (ship and output):
        return f"twin compare {' '.join(voyages)} --ship {(faults and output) or ship or 'SHIP.toml'}"
    return f"twin instruments {' '.join(voyages)} --ship {ship or 'SHIP.toml'} -o corrected.toml"


def after_compare(voyages: Sequence[str], ship: str, result: Mapping[str, Any]) -> str:
    """The diagnosis; before it a calibration, where the ship never had one."""
    by = ship if result["horizons"][-1]["noise_floor"]["of"] != "sensors" else "calibrated.toml"
    diagnose = f"twin diagnose {' '.join(voyages)} --ship {by} --report diagnose.html"
    return diagnose if by == ship else f"twin calibrate REFERENCE.mcap --ship {ship} -o {by}, then {diagnose}"


def after_diagnose(voyages: Sequence[str], ship: str, result: Mapping[str, Any]) -> str:
    """What to sail, or to ask together, where voyages cannot tell; what to add where one may be."""
    paths, then = " ".join(voyages), result["next_manoeuvre"]
    sail = then and f"sail {then['manoeuvre']}, then twin diagnose with that voyage too"
    now = "" if sail else f"twin compare {paths} --ship {ship} --report compare.html"
    if lasting := result["answer"]["lasting"]:
        now = f"twin add {' '.join(lasting)} --ship {ship} --voyage {paths} -o better.toml"
    elif result["verdict"] in ("undecided", "unknown") and len(voyages) < 3:
        now = f"twin diagnose {paths} OTHER-DAY.mcap --ship {ship}: voyages together tell more than one"
    elif result["verdict"] == "nothing_missing":
        now = f"twin diagnose OTHER-DAY.mcap --ship {ship}; what sailed so is good for twin calibrate, too"
    return "; or now: ".join(filter(None, (sail, now)))


def add_typed(args: argparse.Namespace) -> str:
    """What was typed, for the page."""
    command = f"twin add {' '.join(args.effects)} --ship {args.ship} --voyage {' '.join(args.voyage)}"
    command += f" --held-out {' '.join(args.held_out)}" * bool(args.held_out)
    return f"{command}{' --cross-validated' * args.cross_validated} -o {args.output}"

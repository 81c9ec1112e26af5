"""What to type after a verb: its `next:` line."""

import argparse
from collections.abc import Mapping, Sequence
from typing import Any

from twin.commands.typed_again import given
from twin.commands.verb_output import typed
from twin.physics.ship import load


def after_import(voyage: str, ship: str | None) -> str:
    """The comparison; before it a calibration, where the ship never had one."""
    if not ship or "structural" in load(ship, arrays=False).notes:
        return typed("compare", voyage, "--ship", ship or "SHIP.toml")
    better = ship.removesuffix(".toml") + "-calibrated.toml"
    fit = typed("calibrate", "ref-1.mcap", "ref-2.mcap", "...", "--ship", ship, "-o", better)
    why = "its model was not calibrated yet. Import the voyages on which nothing was wrong (three or more)"
    return f"{why}, then {fit}; after that, {typed('diagnose', 'LATER.mcap', '--ship', better)}"


def after_map(files: Sequence[str], to: str | None) -> str:
    """A map that was proposed is confirmed by a person."""
    return f"next: read and correct it, then {typed('import', *files, '--map', str(to), '-o', 'VOYAGE.mcap')}"


def after_instruments(args: argparse.Namespace, seen: bool, distinct: bool) -> str:
    """A comparison, where a ship file was written or no fault seen; else what may write one."""
    if not seen or (distinct and args.ship and args.output):
        return typed("compare", *args.voyages, "--ship", (seen and args.output) or args.ship or "SHIP.toml")
    by = [*given("--map", args.map), *(w for name in args.source for w in given("--source", name))]
    by += given("--velocity-by", args.velocity_by)
    to = [*by, "--ship", args.ship or "SHIP.toml", "-o", (args.ship and args.output) or "corrected.toml"]
    return typed("instruments", *args.voyages, *([] if distinct else ["OTHER-DAY.mcap"]), *to)


def after_compare(voyages: Sequence[str], ship: str, result: Mapping[str, Any]) -> str:
    """The diagnosis; before it a calibration, where the ship never had one."""
    by = ship if result["horizons"][-1]["noise_floor"]["of"] != "sensors" else "calibrated.toml"
    fit = "" if by == ship else typed("calibrate", "REFERENCE.mcap", "--ship", ship, "-o", by) + ", then "
    return fit + typed("diagnose", *voyages, "--ship", by, "--report", "diagnose.html")


def after_diagnose(voyages: Sequence[str], ship: str, result: Mapping[str, Any], *references: str) -> str:
    """What to sail, to ask together or to add; a calibration before all, where the ship never had one."""
    if not result["calibrated"]:
        return after_import(voyages[0], ship)
    of, then = ("--ship", ship), result["next_manoeuvre"]
    again = (*of, *given("--reference", *references))
    sail = then and f"sail {then['manoeuvre']}, then twin diagnose with that voyage too"
    now = "" if sail else typed("compare", *voyages, *of, "--report", "compare.html")
    if lasting := result["answer"]["lasting"]:
        now = typed("add", *lasting, *of, "--voyage", *voyages, "-o", "better.toml")
    elif result["verdict"] in ("undecided", "unknown") and len(voyages) < 3:
        now = f"{typed('diagnose', *voyages, 'OTHER-DAY.mcap', *again)}: voyages together tell more than one"
    elif result["verdict"] == "nothing_missing":
        new = "" if result["calibrated_on"] else "; what sailed so is good for twin calibrate, too"
        now = typed("diagnose", "OTHER-DAY.mcap", *again) + new
    return "; or now: ".join(filter(None, (sail, now)))

"""`twin add`: put a named effect into a ship's model, fit it, and prove that the error falls where it was not fitted."""

import argparse
import datetime
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from twin.errors import DataError, SettingsError, ThresholdError
from twin.physics.effect import Effect
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import Ship, load, save

from .adding import OF_THE_DAY, UNTOUCHED, Found, ahead, can_be_judged, fitted, thirds
from .compare import plain
from .import_voyage import write_json
from .openloop import HORIZONS_S
from .proof import Fall, by_regime, fall, ladder
from .sailed import Sailed, floor_of, read_all
from .track import Track

SCHEMA_VERSION = 1
EPILOG = """example:
  twin add Wind --ship alma2.toml --voyage monday.mcap --held-out tuesday.mcap -o alma3.toml --report add.html

Only the numbers of the named effects are fitted; the core stays as it is. Without --held-out the last third of every
voyage is held back from the fit and used to judge it.
Exit code 3: the held-out error does not fall, nothing is written (--force writes all the same); 4: a voyage cannot be
used, or lacks what the effect needs; 5: no such effect, or the ship file is not valid.
"""


@dataclass(frozen=True)
class Added:
    """What was found: the new ship (with its history), the proof, and the JSON."""

    ship: Ship
    model: Model
    fall: Fall
    result: dict[str, Any]
    held: list[Track]


def add(ship: Ship, effects: Sequence[type[Effect]], sailed: Sequence[Sailed], held_out: Sequence[Sailed] = (), force: bool = False) -> Added:
    """Fit the effects to the voyages and judge them on the held-out ones (without any: on the last third of each)."""
    for effect in effects:
        effect.plausible(ship).check(ship)
    can_be_judged(effects, [s.track for s in (*sailed, *held_out)])
    used, held = ([s.track for s in sailed], [s.track for s in held_out]) if held_out else thirds([s.track for s in sailed])
    model, found = fitted(ship, effects, used)
    before, after = ahead(held, Model.of(ship), HORIZONS_S), ahead(held, model, HORIZONS_S)
    structural = floor_of(ship) is not None
    rows = ladder(before, after, HORIZONS_S, structural)
    if not rows:
        raise DataError(f"{', '.join(t.name for t in held)}: too short to judge by. Give another voyage with --held-out.")
    proof = fall(before, after, rows[-1]["horizon_s"])
    result = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "added": [e.__name__ for e in effects],
        "accepted": proof.proved or force,
        "forced": force and not proof.proved,
        "parameters": {n: {f.name: f.entry() for f in found if f.effect == n} for n in (e.__name__ for e in effects)},
        "judged_by": {"measure": proof.measure, "before": proof.before, "after": proof.after, "low95": proof.low95, "high95": proof.high95},
        "horizons": rows,
        "where": by_regime(before, after, rows[-1]["horizon_s"], ship, structural),
        "voyages": [s.provenance() for s in sailed],
        "held_out": [s.provenance() for s in held_out] or [s.provenance() | {"part": "last third"} for s in sailed],
        "notes": _notes(ship, found, sailed, held_out),
    }
    result["verdict"] = verdict(result, proof)
    result = plain(result)
    return Added(_written(ship, model, result), model, proof, result, held)


def verdict(result: dict[str, Any], proof: Fall) -> str:
    """The first sentence: did it fall, from what to what."""
    names, row = " and ".join(result["added"]), result["horizons"][-1]
    head = f"{proof.measure} on measurements not used for the fit: {proof.before:.3g} before {names}, {proof.after:.3g} after"
    floor = row["noise_floor"]
    tail = f" (noise floor {floor['position_mae_m']:.3g} m, {floor['of']})" if proof.measure.startswith("position") else ""
    if proof.proved:
        return f"{head}{tail}: the error falls by {100.0 * (1.0 - proof.after / proof.before):.0f} %."
    return f"{head}{tail}: the error does not fall beyond its noise (95 % of the change: {proof.low95:+.2g} to {proof.high95:+.2g})."


def _notes(ship: Ship, found: Sequence[Found], sailed: Sequence[Sailed], held_out: Sequence[Sailed]) -> list[str]:
    """What the owner must know to read the numbers."""
    notes = ["Only the added effect's numbers were fitted; the core and the effects already there stay as they were."]
    if not held_out:
        notes.append("No voyage was held out: the last third of each was kept from the fit and used to judge it.")
    present = {type(e).__name__ for e in ship.effects}
    notes += [f"{n} was in the model already: it was fitted anew." for n in sorted({f.effect for f in found} & present)]
    calm = [f"{f.effect}.{f.name}" for f in found if f.gained < UNTOUCHED]
    if calm:
        notes.append(f"The voyages say little about {', '.join(calm)}: kept near what was believed before.")
    notes += _of_the_day({f.effect for f in found}, sailed, held_out)
    return notes


def _of_the_day(names: set[str], sailed: Sequence[Sailed], held_out: Sequence[Sailed]) -> list[str]:
    """A warning when numbers that belong to a voyage are judged by a voyage of another day."""
    bound = sorted(names.intersection(OF_THE_DAY))
    days = [{str(s.voyage.meta.get("start_time_utc", "?"))[:10] for s in group} for group in (sailed, held_out)]
    if not bound or len(sailed) + len(held_out) == 1 or (len(days[0] | days[1]) == 1 and "?" not in days[0]):
        return []
    when = "on another day, as far as the files tell" if "?" in days[0] | days[1] else "on another day"
    return [f"The numbers of {', '.join(bound)} belong to a voyage; some of these voyages were sailed {when}, where they need not hold."]


def _written(ship: Ship, model: Model, result: dict[str, Any]) -> Ship:
    """The new ship: effects in, every number with its interval, and one more step of her history."""
    notes = dict(ship.notes)
    notes["effects"] = dict(notes.get("effects", {})) | result["parameters"]
    entry = {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(), "added": result["added"], "interval": "95 %",
        "voyages": result["voyages"], "held_out": result["held_out"], "judged_by": result["judged_by"],
        "errors": [
            {"horizon_s": r["horizon_s"], "before_m": r["before"]["position_mae_m"], "after_m": r["after"]["position_mae_m"],
             "before_deg": r["before"]["heading_mae_deg"], "after_deg": r["after"]["heading_mae_deg"],
             "noise_floor_m": r["noise_floor"]["position_mae_m"]}
            for r in result["horizons"]
        ],
        "forced": result["forced"],
    }  # fmt: skip
    notes["history"] = [*notes.get("history", []), entry]
    return replace(ship, effects=model.effects, notes=notes)


def told(result: dict[str, Any]) -> list[str]:
    """The answer on a terminal."""
    out = [result["verdict"], "", f"{'horizon':>8}{'before [m]':>13}{'after [m]':>12}{'noise [m]':>12}{'before [deg]':>15}{'after [deg]':>13}"]
    for r in result["horizons"]:
        b, a = r["before"], r["after"]
        out.append(
            f"{r['horizon_s']:>6g} s{b['position_mae_m']:>13.3g}{a['position_mae_m']:>12.3g}{r['noise_floor']['position_mae_m']:>12.2g}"
            f"{b['heading_mae_deg']:>15.2g}{a['heading_mae_deg']:>13.2g}"
        )
    out += ["", "what was fitted (95 %)"]
    for effect, numbers in result["parameters"].items():
        out += [f"  {effect}.{n} = {p['value']:.4g} {p['unit']}   {p['low95']:.3g} to {p['high95']:.3g}" for n, p in numbers.items()]
    out += ["", "by regime: before, after [m]"] + [f"  {w['before_m']:>8.3g}{w['after_m']:>9.3g}  {w['condition']}" for w in result["where"]]
    return out + ["", *result["notes"]]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument("effects", metavar="EFFECT", nargs="+", help="names from `twin effects`")
    parser.add_argument("--ship", metavar="SHIP.toml", required=True, help="the model it is added to")
    parser.add_argument("--voyage", metavar="VOYAGE", nargs="+", action="extend", required=True, help="voyages to fit it on")
    parser.add_argument("--held-out", metavar="VOYAGE", nargs="+", action="extend", default=[], help="voyages to judge it by")
    parser.add_argument("-o", "--output", metavar="SHIP2.toml", required=True, help="the better ship file")
    parser.add_argument("--force", action="store_true", help="write it although the held-out error does not fall")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--report", metavar="FILE.html", help="one self-contained page with the plots")


def run(args: argparse.Namespace) -> int:
    effects = [find(name) for name in dict.fromkeys(args.effects)]
    ship = load(args.ship)
    for path in (*args.voyage, *args.held_out):
        if os.path.exists(args.output) and os.path.exists(path) and os.path.samefile(path, args.output):
            raise SettingsError(f"-o {args.output}: is one of the voyages. Choose another name.")
    every = read_all([*args.voyage, *args.held_out], ship)
    sailed, held_out = every[: len(args.voyage)], every[len(args.voyage) :]
    print(f"fitting {', '.join(e.__name__ for e in effects)} ...", file=sys.stderr)
    made = add(ship, effects, sailed, held_out, args.force)
    command = f"twin add {' '.join(args.effects)} --ship {args.ship} --voyage {' '.join(args.voyage)}"
    command += f" --held-out {' '.join(args.held_out)}" * bool(args.held_out) + f" -o {args.output}"
    result = made.result | {"command": command, "output": args.output if made.result["accepted"] else None}
    page = sys.stderr if args.json == "-" or not result["accepted"] else sys.stdout
    print("\n".join(told(result)), file=page)
    if result["accepted"]:
        save(made.ship, args.output)
        print(f"\nwrote {args.output}", file=page)
    if args.json:
        write_json(result, args.json)
    if args.report:
        _report(args.report, made, ship, result, held_out or sailed)
        print(f"wrote {args.report}", file=page)
    if not result["accepted"]:
        raise ThresholdError(f"{made.fall.sentence()}: it does not fall beyond its noise; {args.output} was not written. --force writes it.")
    print(f"next: twin compare {' '.join(args.held_out or args.voyage)} --ship {args.output}", file=page)
    return 0


def _report(path: str, made: Added, ship: Ship, result: dict[str, Any], shown: Sequence[Sailed]) -> None:
    from . import report

    history = made.ship.notes["history"]
    report.write(path, "add", result | {"history": history}, made.held, made.model, before=Model.of(ship), voyages=[s.voyage for s in shown])

"""`twin import`: measurements in, checked; a file that a check proves wrong is refused."""

import argparse
import json
import os
import sys
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from twin import whole
from twin.errors import DataError, SettingsError, did_you_mean
from twin.physics.ship import load
from twin.recording.checks import CHECKS, Check, run_checks
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage

SCHEMA_VERSION = 1
EPILOG = """
Exit code 4: the data cannot be used, or a check proves a sign, unit or frame wrong. The message says what to
write in the map; --accept CHECK imports the file as it is. The format of a map: docs/import.md.
"""


class Imported(NamedTuple):
    """A voyage and what the checks say of it."""

    voyage: Voyage
    checks: list[Check]

    def refused(self, accept: Collection[str] = ()) -> list[Check]:
        """The checks that prove a mistake and are not accepted."""
        return [c for c in self.checks if c.unusable and c.name not in accept]

    def as_json(self) -> dict[str, Any]:
        v = self.voyage
        return {
            "schema_version": SCHEMA_VERSION,
            "voyage": v.name,
            "rows": len(v),
            "duration_s": v.duration_s,
            "step_s": v.step_s,
            "columns": [name for name in v.columns if v.has(name)],
            "absent": list(v.absent()),
            **{
                key: v.meta[key]
                for key in ("source", "map", "ship", "datum", "start_time_utc")
                if key in v.meta
            },
            "derived": dict(v.meta.get("derived", {})),
            "notes": list(v.meta.get("notes", ())),
            "data_checks": [c.as_json() for c in self.checks],
        }


def import_voyage(
    path: str | Path, map_path: str | Path | None = None, ship_path: str | Path | None = None
) -> Imported:
    """Reads a file, through a map if it has its own columns, and checks it, with a ship if one is given."""
    ship = load(ship_path) if ship_path else None
    voyage = read_voyage(path, read_map(Path(map_path)) if map_path else None)
    if ship:
        voyage = voyage.with_meta(ship=ship.name)
    return Imported(voyage, run_checks(voyage, ship))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = (parser.epilog or "") + EPILOG
    parser.add_argument("file", metavar="FILE", help="measurements: CSV, text columns, or an MCAP log")
    parser.add_argument("--map", metavar="MAP.toml", help="the file's own columns, units, signs and clock")
    parser.add_argument("--ship", metavar="SHIP.toml", help="her particulars let the checks say more")
    parser.add_argument(
        "--accept", metavar="CHECK", action="append", default=[], help="import although CHECK refuses"
    )
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("-o", "--output", metavar="VOYAGE.mcap", required=True, help="the checked voyage")


def run(args: argparse.Namespace) -> int:
    known_checks(args.accept)
    not_onto_itself(args.file, args.output)
    print(f"reading {args.file} ...", file=sys.stderr)
    found = import_voyage(args.file, args.map, args.ship)
    refused = found.refused(args.accept)
    page = sys.stderr if refused or args.json == "-" else sys.stdout
    print("\n".join(summary(found)), file=page)
    if not refused:
        write_voyage(found.voyage, args.output)
    if args.json:
        write_json(found.as_json() | {"output": None if refused else str(args.output)}, args.json)
    if refused:
        raise DataError(refusal(args.file, refused, args.map))
    print(f"wrote {args.output}\nnext: {_next(args.output, args.ship)}", file=page)
    return 0


def _next(voyage: str, ship: str | None) -> str:
    """A ship that was never calibrated is, on her reference voyages, before anything is compared with her;
    whether this is one, nobody knows."""
    if ship and "structural" not in load(ship).notes:
        better = Path(ship).with_name(f"{Path(ship).stem}-calibrated.toml")
        return (
            "her model was not calibrated yet. Import the voyages on which nothing was wrong (three or "
            "more), then "
            f"twin calibrate ref-1.mcap ref-2.mcap ... --ship {ship} -o {better}; after that, twin diagnose "
            f"LATER.mcap --ship {better}"
        )
    return f"twin compare {voyage} --ship {ship or 'SHIP.toml'}"


def summary(found: Imported) -> list[str]:
    """What was read and what the checks say, a line each."""
    v = found.voyage
    lines = [f"{v.name}: {len(v)} rows, {v.duration_s:.6g} s, a sample every {v.step_s:.6g} s"]
    lines += [f"  derived  {name}: {how}" for name, how in v.meta.get("derived", {}).items()]
    lines += [f"  note     {note}" for note in v.meta.get("notes", ())]
    return lines + [f"  {mark(c):8s} {c.name}: {c.text}" for c in found.checks]


def mark(check: Check) -> str:
    return "WRONG" if check.unusable else "look" if not check.ok else "ok" if check.told else "?"


def refusal(path: str, refused: Sequence[Check], map_path: str | None = None) -> str:
    """One line: what is wrong, and the two ways out."""
    mend = (
        f"Correct {map_path}"
        if map_path
        else ("Write that into a map (docs/import.md) and give it with --map")
    )
    accept = " ".join(f"--accept {c.name}" for c in refused)
    said = " ".join(f"{c.name}: {c.text}" for c in refused)
    return f"{path}: not imported. {said} {mend}, or import it as it is with {accept}."


def known_checks(names: Sequence[str]) -> None:
    known = [check.__name__ for check in CHECKS]
    for name in names:
        if name not in known:
            raise SettingsError(f"--accept: no check is called {name!r}.{did_you_mean(name, known)}")


def not_onto_itself(source: str, output: str) -> None:
    if os.path.exists(output) and os.path.exists(source) and os.path.samefile(source, output):
        raise SettingsError(f"-o {output}: is the file that is read. Choose another name.")


def write_json(result: dict[str, Any], path: str) -> None:
    """To standard output for '-', else aside and renamed."""
    text = json.dumps(result, indent=2)
    if path == "-":
        print(text)
        return
    whole.write(path, text + "\n", "--json")

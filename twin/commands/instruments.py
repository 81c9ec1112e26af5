"""`twin instruments`: what is wrong with the instruments, by how their readings go together: no rudder, no
shaft, no ship's model."""

import argparse
import sys
from pathlib import Path

from twin import whole
from twin.api.instruments import FRAMES, instruments
from twin.commands.answer import progress
from twin.errors import SettingsError
from twin.physics.ship import Ship, load
from twin.recording.import_voyage import write_json
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage
from twin.recording.ship_file import save
from twin.study.instruments.corrections import as_map, corrected
from twin.study.instruments.estimate import Instruments
from twin.study.instruments.told import amount, told

EPILOG = """A circle to each side or a figure eight of ten minutes or more says most; rudder and shaft need
not be recorded. -o: with --ship the ship file with what was seen as effects of its instruments; without, the
lines of a map. Exit code 4: a voyage cannot be used; 5: the ship file or map is not valid, or nothing was
found that could be written (docs/instruments.md).
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = f"{parser.epilog or ''}\n\n{EPILOG}"
    add = parser.add_argument
    add("voyages", metavar="VOYAGE", nargs="+", help="voyages of one ship: logs or tables")
    add("--map", metavar="MAP.toml", help="the files' own columns, units, signs and clock")
    add("--ship", metavar="SHIP.toml", help="its length bounds where antennas may be; -o writes into it")
    add("--velocity-by", choices=FRAMES, help="what turned the velocity over ground into the ship's axes "
        "(else: as recorded, or as the data say)")  # fmt: skip
    add("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    add("-o", "--output", metavar="FILE.toml", help="the corrections (see below)")


def run(args: argparse.Namespace) -> int:
    ship, by = load(args.ship) if args.ship else None, read_map(Path(args.map)) if args.map else None
    voyages = [read_voyage(path, by, controls=False) for path in args.voyages]
    done = instruments(ship, voyages, velocity_by=args.velocity_by, progress=progress)
    page, paths = sys.stderr if args.json == "-" else sys.stdout, " ".join(args.voyages)
    print("\n".join(told(done.found)), file=page)
    if args.output:
        _write(args, ship, done.found)
        print(f"\nwrote {args.output}", file=page)
    asked = f"twin instruments {paths}{f' --ship {args.ship}' if ship else ''}"
    if args.json:
        files = {"ship": args.ship, "voyages": args.voyages}
        write_json(done.to_dict() | {"command": asked, "files": files}, args.json)
    again = f"twin instruments {paths} --ship {args.ship or 'SHIP.toml'} -o corrected.toml"
    mended = f"twin compare {paths} --ship {args.output}"
    print(f"\nnext: {mended if ship and args.output else again}", file=page)
    return 0


def _write(args: argparse.Namespace, ship: Ship | None, found: Instruments) -> None:
    path = args.output
    if ship is None:
        whole.write(path, as_map(found))
        return
    if not found.faults:
        raise SettingsError(f"-o {path}: no fault of an instrument was seen: nothing to write. Leave out -o.")
    mended, left = corrected(ship, found)
    save(mended, path, args.ship)
    for e in left:
        size = amount(e.value, e.unknown.unit)
        print(f"not written, as no effect holds it: {e.unknown.meaning} ({size})", file=sys.stderr)

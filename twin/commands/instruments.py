"""`twin instruments`: what is wrong with the instruments, by how their readings go together."""

import argparse
import sys
from pathlib import Path

from twin import whole
from twin.api.instruments import FRAMES, InstrumentCheck, instruments
from twin.commands import arguments
from twin.commands.next_command import after_instruments
from twin.commands.typed_again import with_request
from twin.commands.verb_output import lines_to, progress, wrote
from twin.physics.ship import Ship, load
from twin.recording.formats.choose import sources_of
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage
from twin.recording.ship_file_writer import save

EPILOG = """A circle to each side or a figure eight of ten minutes or more says most; rudder and shaft need
not be recorded. -o: with --ship the ship file with what was seen as effects of its instruments; without, a
map. Exit code 3: no fault was seen but as the ship file has it, or none is told from others, and -o wrote no
file; 4: a voyage cannot be used; 5: ship file or map not valid, or a map can take off nothing of what was
seen (docs/instruments.md)."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.after(parser, EPILOG)
    arguments.voyages(parser, "voyages of one ship: logs or tables")
    add, turned = parser.add_argument, "what turned the velocity over ground into the ship's axes"
    add("--map", metavar="MAP.toml", help="the files' own columns, units, signs and clock")
    arguments.repeated(parser, "--source", "[CHANNEL=]NAME", "the instrument to ask of several")
    arguments.ship(parser, "its length bounds where antennas may be; -o writes into it", False)
    add("--velocity-by", choices=FRAMES, help=f"{turned} (else: as recorded, or as the data say)")
    arguments.as_json(parser)
    arguments.output(parser, "FILE.toml", "the corrections (see below)", required=False)


def run(args: argparse.Namespace) -> int:
    ship, by = load(args.ship) if args.ship else None, read_map(Path(args.map)) if args.map else None
    voyages = [read_voyage(p, by, sources_of(args.source), controls=False) for p in args.voyages]
    done, page = instruments(ship, voyages, velocity_by=args.velocity_by, progress=progress), lines_to(args)
    print("\n".join(done.text()), file=page)
    if (why := done.not_written(ship)) and args.output:
        print(f"\n{args.output} was not written: {why}.", file=page)
    elif args.output:
        _write(args, ship, done)
        print("", wrote(args.output), *done.ambiguous(), sep="\n", file=page)
    if args.json:
        answer = with_request(done, args, ship=args.ship, voyages=args.voyages)
        whole.write_json(answer.to_dict(), args.json)
    print("\nnext:", after_instruments(args, not why or bool(done.ambiguous()), not why), file=page)
    return 3 if args.output and why else 0


def _write(args: argparse.Namespace, ship: Ship | None, done: InstrumentCheck) -> None:
    if ship is None:
        return whole.write(args.output, done.as_map())
    save(done.corrected(ship), args.output, args.ship)
    for left in done.not_held(ship):
        print(f"not written, as no effect holds it: {left}", file=sys.stderr)

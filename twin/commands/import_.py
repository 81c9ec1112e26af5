"""`twin import`: measurements in, checked; a file that a check proves wrong is refused."""

import argparse
import sys

from twin import whole
from twin.commands.answer import progress
from twin.commands.next_command import after_import
from twin.errors import DataError, UsageError
from twin.recording.import_voyage import import_voyage, known_checks, refusal, suggest, summary, write_json
from twin.recording.write import write_voyage

EPILOG = """
Exit code 4: the data cannot be used, or a check proves a sign, unit or frame wrong. The message says what to
write in the map; --accept CHECK imports the file as it is. The format of a map: docs/import.md.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = (parser.epilog or "") + EPILOG
    parser.add_argument(
        "file",
        metavar="FILE",
        nargs="+",
        help="a log or a table of any known format; several tables are joined",
    )
    parser.add_argument("--map", metavar="MAP.toml", help="the file's own columns, units, signs and clock")
    parser.add_argument("--ship", metavar="SHIP.toml", help="its particulars let the checks say more")
    parser.add_argument(
        "--source",
        metavar="[CHANNEL=]NAME",
        action="append",
        default=[],
        help="the instrument to take of several",
    )
    parser.add_argument(
        "--without-controls", action="store_true", help="import although rudder or shaft were not recorded"
    )
    parser.add_argument(
        "--suggest-map", action="store_true", help="write the map of an unknown table, to be confirmed"
    )
    parser.add_argument(
        "--accept", metavar="CHECK", action="append", default=[], help="import although CHECK refuses"
    )
    parser.add_argument(
        "--every-check", action="store_true", help="what each check saw, those that are quiet too"
    )
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument(
        "-o", "--output", metavar="VOYAGE.mcap", help="the checked voyage (with --suggest-map: the map)"
    )


def run(args: argparse.Namespace) -> int:
    known_checks(args.accept)
    whole.not_onto(args.output or "", args.file, "the file that is read")
    progress(f"reading {' '.join(args.file)}")
    if args.suggest_map:
        return suggest(args)
    if not args.output:
        raise UsageError("-o VOYAGE.mcap is needed: where the checked voyage goes.")
    found = import_voyage(args.file, args.map, args.ship, args.source, not args.without_controls)
    refused = found.refused(args.accept)
    page = sys.stderr if refused or args.json == "-" else sys.stdout
    print("\n".join(summary(found, args.every_check)), file=page)
    if not refused:
        write_voyage(found.voyage, args.output)
    if args.json:
        write_json(found.as_json() | {"output": None if refused else str(args.output)}, args.json)
    if refused:
        raise DataError(refusal(args.file[0], refused, args.map))
    print(f"wrote {args.output}\nnext: {after_import(args.output, args.ship)}", file=page)
    return 0

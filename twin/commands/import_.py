"""`twin import`: measurements in, checked; a file that a check proves wrong is refused."""

import argparse
import sys

from twin import whole
from twin.api.voyage_check import import_file, suggest_map
from twin.commands import arguments
from twin.commands.next_command import after_import, after_map
from twin.commands.verb_output import files, lines_to, progress
from twin.errors import DataError, UsageError
from twin.recording.write import write_voyage

EPILOG = """
Exit code 4: the data cannot be used, or a check proves a sign, unit or frame wrong. The message says what to
write in the map; --accept CHECK imports the file as it is. The format of a map: docs/import.md.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = (parser.epilog or "") + EPILOG
    add = parser.add_argument
    joined = "a log or a table of any known format; several tables are joined"
    add("file", metavar="FILE", nargs="+", help=joined)
    add("--map", metavar="MAP.toml", help="the file's own columns, units, signs and clock")
    arguments.ship(parser, "its particulars let the checks say more", required=False)
    arguments.repeated(parser, "--source", "[CHANNEL=]NAME", "the instrument to take of several")
    arguments.flag(parser, "--without-controls", "import although rudder or shaft were not recorded")
    arguments.flag(parser, "--suggest-map", "write the map of an unknown table, to be confirmed")
    arguments.repeated(parser, "--accept", "CHECK", "import although CHECK refuses")
    arguments.flag(parser, "--every-check", "what each check saw, those that are quiet too")
    arguments.as_json(parser)
    arguments.report(parser)
    checked = "the checked voyage (with --suggest-map: the map)"
    arguments.output(parser, "VOYAGE.mcap", checked, required=False)


def run(args: argparse.Namespace) -> int:
    if args.suggest_map and (args.json or args.report or args.accept):
        raise UsageError("--suggest-map writes a map and imports nothing: no --json, --report or --accept.")
    progress(f"reading {' '.join(args.file)}")
    if args.suggest_map:
        text, confirmed = suggest_map(args.file, sources=args.source), after_map(args.file, args.output)
        whole.put(args.output or "-", text, "-o")
        print(f"wrote {args.output}\n{confirmed}" * bool(args.output), end="\n" * bool(args.output))
        return 0
    if not args.output:
        raise UsageError("-o VOYAGE.mcap is needed: where the checked voyage goes.")
    controls = not args.without_controls
    found = import_file(args.file, args.map, args.ship, args.source, controls, args.accept)
    refused = found.refused()
    page = sys.stderr if refused else lines_to(args)
    print("\n".join(found.text(args.every_check)), file=page)
    if not refused:
        write_voyage(found.voyage, args.output)
    files(args, found.with_keys(output=None if refused else str(args.output)), page)
    if refused:
        raise DataError(found.refusal(args.file[0], map=args.map))
    print(f"wrote {args.output}\nnext: {after_import(args.output, args.ship)}", file=page)
    return 0

"""What the verbs of the study answer alike: progress on standard error, lines, JSON and the page."""

import argparse
import shlex
import sys
from pathlib import Path
from typing import TextIO

from twin import whole
from twin.api.result import Result
from twin.physics import ship_arrays


def progress(text: str) -> None:
    """What is being done now."""
    print(f"{text} ...", file=sys.stderr)


def lines_to(args: argparse.Namespace) -> TextIO:
    """Where the lines go: standard output, unless the JSON goes there."""
    return sys.stderr if args.json == "-" else sys.stdout


def typed(*words: str) -> str:
    """A command of the twin as a shell takes it: each word is one, whatever stands in a file's name."""
    return shlex.join(["twin", *words])


def wrote(path: str) -> str:
    """That a ship file was written, and the file of arrays without which it is not read."""
    arrays = ship_arrays.arrays_file(Path(path))
    return f"wrote {path}" + f" and {arrays} beside it: keep the two together" * bool(arrays)


def files(args: argparse.Namespace, found: Result, page: TextIO) -> None:
    """JSON and page, as they were asked for."""
    if args.json:
        whole.write_json(found.to_dict(), args.json)
    if args.report:
        found.write_page(args.report)
        print(f"wrote {args.report}", file=page)


def answer(args: argparse.Namespace, found: Result) -> None:
    """JSON, lines and page, as they were asked for."""
    if args.json:
        whole.write_json(found.to_dict(), args.json)
    print("\n".join(found.text()), file=lines_to(args))
    if args.report:
        found.write_page(args.report)
        print(f"\nwrote {args.report}", file=lines_to(args))

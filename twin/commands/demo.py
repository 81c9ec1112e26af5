"""`twin demo`: the whole story in a minute or two: a twin alive on board, then an owner who finds what his
model lacks."""

import argparse
import importlib.util
from pathlib import Path

from twin.live import demonstration as alive


def add_arguments(parser: argparse.ArgumentParser) -> None:
    alive.add_arguments(parser)
    parser.add_argument("--no-study", action="store_true", help="only the part on board")


def run(args: argparse.Namespace) -> int:
    """The live twin first; the study's part where the extra `study` is installed."""
    code = alive.run(args)
    if code or args.no_study:
        return code
    if importlib.util.find_spec("scipy") is None:
        print("\nThe study's part of the story needs the extra `study`: pip install 'shiptwin[study]'.")
        return 0
    from twin.commands.story import story

    story(Path(args.logs))
    return 0

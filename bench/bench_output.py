"""How a benchmark answers: its page, the same numbers as JSON, and words on standard error while it works."""

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from twin import whole

HAND = "## What it says"  # from this line on a page is written by hand, and stays


def add_arguments(parser: argparse.ArgumentParser, option: str = "--markdown") -> None:
    """`option`: what this benchmark calls its page."""
    parser.add_argument(option, metavar="FILE.md", dest="page", type=Path, help="the result as a page")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.set_defaults(page_option=option)


def give(args: argparse.Namespace, result: dict[str, Any], text: str, more: str = "") -> None:
    """Print the text and write what was asked for; `more` stands below it on the page that is written."""
    text = text.rstrip("\n")
    print(text, file=sys.stderr if args.json == "-" else sys.stdout)
    if args.page:
        whole.write(args.page, f"{text}\n{more}", args.page_option)
    if args.json:
        whole.write_json(result, args.json)


def begun(title: str, done: str | None, *columns: str) -> list[str]:
    """A page's first lines: its title, what was done (a module's docstring), and the head of its table."""
    return [
        f"# {title}",
        "",
        (done or "").strip(),
        "",
        f"| {' | '.join(columns)} |",
        "|---" * len(columns) + "|",
    ]


def rows(args: argparse.Namespace, found: Sequence[Any], text: str) -> None:
    """`give` of a table's rows (named tuples), with what was written by hand on the page that is there."""
    give(args, {"rows": [row._asdict() for row in found]}, text, kept(args.page))


def kept(page: Path | None) -> str:
    """What was written by hand at the end of the page that is there."""
    old = page.read_text() if page and page.exists() else ""
    return f"\n{HAND}{old.split(HAND, 1)[1]}" if HAND in old else ""


def tell(text: str) -> None:
    print(time.strftime("%H:%M:%S"), text, file=sys.stderr, flush=True)

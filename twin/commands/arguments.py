"""The arguments that several verbs take alike, each in one place: how it is typed, and what its help says."""

import argparse

MODEL = "the model: a ship file, or a bundled ship's name"


def after(parser: argparse.ArgumentParser, text: str) -> None:
    """More below the help's example; a text that begins with an example of its own stands alone."""
    own = text.startswith("example:")
    parser.epilog = text if own else f"{parser.epilog or ''}\n\n{text}"


def voyages(parser: argparse.ArgumentParser, help: str) -> None:
    """One voyage or more, by position."""
    parser.add_argument("voyages", metavar="VOYAGE", nargs="+", help=help)


def more_voyages(
    parser: argparse.ArgumentParser, option: str, help: str, required: bool = False, again: bool = False
) -> None:
    """One voyage or more behind an option; `again`: which may be typed more than once."""
    action, default = "extend" if again else "store", None if required else list[str]()
    parser.add_argument(
        option, metavar="VOYAGE", nargs="+", action=action, required=required, default=default, help=help
    )


def ship(parser: argparse.ArgumentParser, help: str | None = MODEL, required: bool = True) -> None:
    parser.add_argument("--ship", metavar="SHIP.toml", required=required, help=help)


def output(parser: argparse.ArgumentParser, metavar: str, help: str, required: bool = True) -> None:
    parser.add_argument("-o", "--output", metavar=metavar, required=required, help=help)


def force(parser: argparse.ArgumentParser, help: str = "write over a file that is there") -> None:
    parser.add_argument("--force", action="store_true", help=help)


def as_json(parser: argparse.ArgumentParser, help: str = "the result as JSON ('-': standard output)") -> None:
    parser.add_argument("--json", metavar="FILE", help=help)


def report(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--report", metavar="FILE.html", help="one self-contained page with the plots")


def flag(parser: argparse.ArgumentParser, option: str, help: str) -> None:
    parser.add_argument(option, action="store_true", help=help)


def repeated(parser: argparse.ArgumentParser, option: str, metavar: str, help: str) -> None:
    """An option that may be typed more than once."""
    parser.add_argument(option, metavar=metavar, action="append", default=[], help=help)


def seconds(parser: argparse.ArgumentParser, option: str, dest: str, default: float, help: str) -> None:
    """A time [s]."""
    parser.add_argument(option, dest=dest, type=float, metavar="S", default=default, help=help)

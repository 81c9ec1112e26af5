"""`twin studio`: the workbench in a browser, on this computer, over a folder of plain files."""

import argparse

from twin.errors import TwinError, UsageError

NEEDED = ("starlette", "uvicorn", "anyio", "scipy")  # what the extra brings

EPILOG = """
The page is served on 127.0.0.1; the printed link opens it once. Nothing leaves this computer, and nothing is
loaded from elsewhere. Each action shows the command line that does the same; long work goes on when the page
is closed. docs/studio.md.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = (parser.epilog or "") + EPILOG
    parser.add_argument(
        "folder",
        nargs="?",
        default=".",
        metavar="FOLDER",
        help="the project: logs, maps and ship files (default: here)",
    )
    parser.add_argument(
        "--port", type=int, default=8480, help="of the page on 127.0.0.1, 0 for any free one (default: 8480)"
    )
    parser.add_argument("--no-browser", action="store_true", help="only print the link")
    parser.add_argument(
        "--read-only", action="store_true", help="show what is there; change and start nothing"
    )
    parser.add_argument(
        "--demo", action="store_true", help="copy the bundled tanker and its voyages into FOLDER first"
    )
    parser.add_argument("--report", metavar="FILE.html", help="write the project as one page, and stop")


def run(args: argparse.Namespace) -> int:
    if args.report:
        return _reported(args)
    try:
        from twin.studio.local_server import served
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in NEEDED:
            raise
        raise TwinError(
            f"`twin studio` needs the package {package}. Run: pip install 'shiptwin[studio]'"
        ) from None
    return served(args)


def _reported(args: argparse.Namespace) -> int:
    from twin.studio.project_report import write

    if args.demo:
        raise UsageError("--demo begins a project, --report tells of one: ask for one at a time.")
    write(args.folder, args.report)
    print(f"wrote {args.report}")
    return 0

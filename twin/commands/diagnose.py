"""`twin diagnose`: which physical effect is missing, in newtons, with its confidence, or an honest answer
that is none."""

import argparse
import sys
from typing import Any

from twin.physics.ship import Ship, load
from twin.recording.checks import losses
from twin.recording.import_voyage import write_json
from twin.recording.jsonable import plain
from twin.recording.read import read_voyage
from twin.study.diagnosis.diagnose import diagnose
from twin.study.diagnosis.tell_diagnosis import told
from twin.study.estimation import identifiability

EPILOG = """Verdicts: missing (named, lasting causes first, with size and interval, and with what cannot be
told from it), nothing_missing, unknown (something is there that no effect of the catalogue explains;
resembles: what it looks like, where that is known by its form), undecided (the voyages cannot tell; one_of:
the few of which one is surely there; next_manoeuvre: what to sail). JSON has the reason, the facts that
decided and the rivals (docs/diagnosis.md). Water and wind of the voyages stand beside every cause, in a part
of their own (weather). Reference voyages are those of the same ship on which nothing was wrong: they say what
an imperfect model leaves over anyway. Exit code 4: a voyage cannot be used; 5: the ship file is not valid.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = f"{parser.epilog or ''}\n\n{EPILOG}"
    parser.add_argument(
        "voyages", metavar="VOYAGE", nargs="+", help="voyages on which something may be wrong"
    )
    parser.add_argument(
        "--ship", metavar="SHIP.toml", required=True, help="the model: a ship file, or a bundled ship's name"
    )
    parser.add_argument(
        "--reference",
        metavar="VOYAGE",
        nargs="+",
        default=[],
        help="voyages of the same ship on which nothing was wrong",
    )
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--report", metavar="FILE.html", help="one self-contained page with the plots")
    parser.add_argument(
        "--identifiability",
        action="store_true",
        help="also say what the first of these voyages can tell at all",
    )
    parser.add_argument(
        "--residual", metavar="FILE.onnx", help="also say whether what was learned stands apart from the core"
    )


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    learned = _features(args.residual, ship)
    voyages, references = ([read_voyage(p) for p in paths] for paths in (args.voyages, args.reference))
    done = diagnose(voyages, ship, references, lambda text: print(f"{text} ...", file=sys.stderr))
    result = done.result | {
        "command": f"twin diagnose {' '.join(args.voyages)} --ship {args.ship}",
        "verdict_text": done.result["sentence"],
        "files": {"ship": args.ship, "voyages": args.voyages},
    }
    page = sys.stderr if args.json == "-" else sys.stdout
    page_lines = told(result) + losses(result["data_checks"])
    if args.identifiability or learned:
        result["identifiability"] = plain(identifiability.report(voyages[0], done.case.model, *learned))
        page_lines += ["", *identifiability.text(result["identifiability"])]
    if args.json:
        write_json(result, args.json)
    print("\n".join(page_lines), file=page)
    if args.report:
        from twin import report

        report.write(
            args.report, "diagnose", result, list(done.case.tracks), done.case.model, voyages=voyages
        )
        print(f"\nwrote {args.report}", file=page)
    print(f"\nnext: {_next_command(args, result)}", file=page)
    return 0


def _features(path: str | None, ship: Ship) -> tuple[Any, ...]:
    """What the residual is made of (twin/study/estimation/learned.py)."""
    if not path:
        return ()
    from twin.study.estimation.learned import features

    return features(path, ship)


def _next_command(args: argparse.Namespace, result: dict[str, Any]) -> str:
    voyages, sail = " ".join(args.voyages), ""
    if result["next_manoeuvre"]:
        sail = f"sail {result['next_manoeuvre']['manoeuvre']}, then twin diagnose with that voyage too"
    if lasting := result["answer"]["lasting"]:
        add = f"twin add {' '.join(lasting)} --ship {args.ship} --voyage {voyages} -o better.toml"
        return f"{sail}; or now: {add}" if sail else add
    return sail or f"twin compare {voyages} --ship {args.ship} --report compare.html"

"""The hidden-effect league: voyages of the reference sea with something hidden, and what the diagnosis makes
of them."""

import argparse
import os
import tempfile
from pathlib import Path

from bench import bench_output
from bench.league import league_score, plan
from bench.league.page import page
from bench.league.rounds import League
from bench.options import positive
from twin import whole
from twin.errors import SettingsError
from twin.physics.effects import catalogue

EPILOG = """example:
  twin-bench hidden-effects --quick --json -
  twin-bench hidden-effects --seeds 5 --jobs 2 --resume league --out docs/results/hidden-effects.md

Each ship is a bundled ship file, calibrated in memory on calm reference voyages of the reference sea. With
--resume a run that was stopped goes on where it ended (after a change of the twin begin a new folder: the
ships in it are calibrated); without it everything but the result is deleted. FILE.json goes beside FILE.md.
"""
PART = 60  # questions whose voyages are sailed before they are judged


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument(
        "--quick", action="store_true", help="one hull, one seed, strength 1, some 12 voyages"
    )
    parser.add_argument("--hull", nargs="+", choices=plan.HULLS, help="default: all")
    parser.add_argument("--seeds", type=positive, help="rounds; each is a fair sample (default 5)")
    parser.add_argument(
        "--first-seed",
        type=int,
        default=1,
        metavar="N",
        help="of the rounds: other voyages of the same questions (default 1)",
    )
    parser.add_argument("--strength", nargs="+", type=float, help="default: 1 and 0.5")
    parser.add_argument("--effect", nargs="+", default=[], help="hide only these of the catalogue")
    parser.add_argument(
        "--every",
        type=positive,
        default=1,
        metavar="N",
        help="one question in N, in turn over effects, hulls and seeds (default 1)",
    )
    parser.add_argument(
        "--kind", nargs="+", choices=plan.KINDS, default=plan.KINDS, help="only these questions"
    )
    parser.add_argument("--duration", type=float, metavar="S", help="of a voyage (default 1800, usv 1200)")
    parser.add_argument(
        "--references",
        type=positive,
        default=6,
        metavar="N",
        help="calm voyages that calibrate a ship (default 6)",
    )
    parser.add_argument("--minutes", type=float, help="begin no voyage after so many minutes")
    parser.add_argument("--jobs", type=positive, default=2, help="processes (default 2)")
    parser.add_argument("--resume", metavar="DIR", help="keep what is done here, and go on from it")
    bench_output.add_arguments(parser, "--out")


def run(args: argparse.Namespace) -> int:
    strange = [n for n in args.effect if n not in catalogue()]
    if strange:
        raise SettingsError(f"--effect {strange[0]}: no such effect. Known: {', '.join(catalogue())}.")
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # a voyage a process, a thread a process
    with tempfile.TemporaryDirectory() as spare:
        league = League(args, Path(args.resume or spare))
        rows = league.play()
        result = league_score.contract(rows) | {"run": {"command": command(args)} | league.facts(rows)}
        text = page(rows, result, league.calibrations())
    bench_output.give(args, result, text)
    if args.page:
        whole.write_json(result, str(args.page.with_suffix(".json")))
    return 0


def command(args: argparse.Namespace) -> str:
    """The command that makes this page again."""
    said = ["twin-bench hidden-effects"] + ["--quick"] * args.quick
    for name in ("hull", "strength", "effect"):
        said += [f"--{name} {' '.join(map(str, getattr(args, name)))}"] if getattr(args, name) else []
    said += [f"--seeds {args.seeds}"] if args.seeds else []
    said += [f"--first-seed {args.first_seed}"] if args.first_seed > 1 else []
    said += [f"--every {args.every}"] if args.every > 1 else []
    said += [f"--kind {' '.join(args.kind)}"] if args.kind is not plan.KINDS else []
    said += [f"--duration {args.duration:g}"] if args.duration else []
    said += [f"--out {args.page}"] if args.page else []
    return " ".join(said)

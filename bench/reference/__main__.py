"""python -m bench.reference list | run | check"""

import argparse
import json
from pathlib import Path

from bench.reference import sea_trials
from bench.reference.hidden_catalogue import CATALOGUE, DECOYS, OUTSIDE
from bench.reference.hulls import HULLS
from bench.reference.sea_voyage import SeaCase, simulate
from bench.reference.trial_legs import MANOEUVRES
from bench.reference.weather import WEATHERS


def show():
    for title, names in (
        ("hulls", HULLS),
        ("manoeuvres", MANOEUVRES),
        ("weathers", WEATHERS),
        ("hidden effects of the catalogue", CATALOGUE),
        ("hidden effects outside it", OUTSIDE),
        ("decoys", DECOYS),
    ):
        print(f"{title}: {', '.join(names)}")
    return 0


def effect(text):
    name, _, strength = text.partition(":")
    return name, float(strength or 1.0)


def run(args):
    cases = [
        SeaCase(
            args.hull, args.manoeuvre, args.weather, tuple(args.hide), tuple(args.decoy), seed, args.duration
        )
        for seed in range(args.seed, args.seed + args.count)
    ]
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    for recording in simulate(cases):
        name = "_".join([args.hull, args.manoeuvre, *(n for n, _ in args.hide), str(recording.case.seed)])
        recording.write_csv(folder / f"{name}.csv")
        (folder / f"{name}.truth.json").write_text(json.dumps(recording.hidden, indent=1))
        print(folder / f"{name}.csv")
    return 0


def main():
    parser = argparse.ArgumentParser(prog="python -m bench.reference", description="The reference sea.")
    verbs = parser.add_subparsers(dest="verb", required=True)
    verbs.add_parser("list", help="what can be sailed and hidden")
    verbs.add_parser("check", help="our KVLCC2 beside other people's")
    sail = verbs.add_parser(
        "run",
        help="sail voyages and write them as CSV, the truth beside them",
        epilog="example: python -m bench.reference run --hull usv --hide Wind:0.5 --count 3 -o voyages",
    )
    sail.add_argument("--hull", default="kvlcc2")
    sail.add_argument("--manoeuvre", default="mixed")
    sail.add_argument("--weather", default="calm")
    sail.add_argument("--hide", type=effect, action="append", default=[], metavar="EFFECT[:STRENGTH]")
    sail.add_argument("--decoy", action="append", default=[])
    sail.add_argument("--seed", type=int, default=0)
    sail.add_argument("--count", type=int, default=1)
    sail.add_argument("--duration", type=float, default=1800.0, metavar="S")
    sail.add_argument("-o", "--output", default="voyages")
    args = parser.parse_args()
    return {"list": show, "check": sea_trials.main, "run": lambda: run(args)}[args.verb]()


if __name__ == "__main__":
    raise SystemExit(main())

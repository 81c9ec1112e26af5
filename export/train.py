"""`twin train`: learns from voyages what the ship's physics leaves over, proves on held-out free runs that it
helps, exports it."""

import argparse
import sys
from collections import Counter
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from export.data import leg, model_of, split
from twin import whole
from twin.errors import DataError, SettingsError, ThresholdError, TwinError
from twin.num import num
from twin.physics.ship import Ship, load
from twin.recording.jsonable import plain
from twin.report.training_page import training_page
from twin.study.reference.sailed import Sailed, read_all
from twin.study.track.track import Track, track

SCHEMA_VERSION = 1
NEEDS = "`twin train` needs {!r}. Run: pip install 'shiptwin[train]'"
EPILOG = """example:
  twin train v*.mcap --ship alma3.toml -o residual.onnx

Voyages are taken in the order of time: the first 60 % teach, the next 20 % say when to stop, the last 20 %
judge. With fewer than five voyages each is cut in time instead. Interrupted, it goes on where it was when the
same command is given again. Exit code 3: the residual does not help on the held-out part, nothing is written
(--force writes all the same); 4: a voyage cannot be used; 5: the ship file is not valid.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of `twin train`."""
    parser.epilog = EPILOG
    parser.add_argument(
        "voyages",
        metavar="VOYAGE",
        nargs="+",
        help="what to learn from: the more manoeuvres and weathers, the better",
    )
    parser.add_argument(
        "--ship",
        metavar="SHIP.toml",
        required=True,
        help="its model: calibrate it first, the network then has less to do",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="RESIDUAL.onnx",
        required=True,
        help="the trunk; its manifest goes beside it (.json)",
    )
    parser.add_argument(
        "--seeds",
        metavar="N",
        nargs="+",
        type=int,
        default=[42],
        help="several: the best on validation is kept (42 123 256 512 1024 is the paper's)",
    )
    parser.add_argument(
        "--loss",
        choices=("rollout", "acceleration", "paper"),
        default="rollout",
        help="default: acceleration matching, then roll-outs",
    )
    parser.add_argument(
        "--epochs", metavar="N", type=int, default=150, help="of single moments, at most (150)"
    )
    parser.add_argument(
        "--rollout-epochs", metavar="N", type=int, default=40, help="of roll-outs, at most (40)"
    )
    parser.add_argument(
        "--lambda-data", metavar="X", type=float, default=1.0, help="weight of the data in --loss paper (1)"
    )
    parser.add_argument(
        "--lambda-phys", metavar="X", type=float, default=0.1, help="weight of R in --loss paper (0.1)"
    )
    parser.add_argument(
        "--orthogonality",
        metavar="X",
        type=float,
        default=0.0,
        help="penalty on what the core could say itself (0; try 0.01)",
    )
    parser.add_argument(
        "--mirror",
        metavar="X",
        type=float,
        default=0.0,
        help="penalty on asymmetry, for twin-screw hulls (0; try 0.1)",
    )
    parser.add_argument("--force", action="store_true", help="write it although it does not help")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--report", metavar="FILE.html", help="one self-contained page with the curves")


def tell(text: str) -> None:
    """What is being done now."""
    print(f"{text} ...", file=sys.stderr)


def run(args: argparse.Namespace) -> int:
    """Train, judge and write; the exit code. TwinError: the output cannot be written, or a library is not
    there. SettingsError: the ship lists actuators. ThresholdError: the residual is not worth having."""
    ship = load(args.ship)
    if ship.actuators:
        raise SettingsError(
            f"--ship {args.ship}: a network looks at one rudder and one shaft, and this ship lists "
            "[[actuators]]: it has no learned residual. twin add gives it effects of its actuators."
        )
    output = Path(args.output)
    manifest = output.with_suffix(".json")
    if output.suffix != ".onnx":
        raise TwinError(f"-o {output}: the name must end with .onnx (the manifest goes beside it as .json).")
    if not output.parent.is_dir():
        raise TwinError(f"-o {output}: there is no folder {output.parent}. Make it first.")
    if manifest.exists() and not output.exists():
        raise TwinError(
            f"-o {output}: its manifest would take the place of {manifest}, which is there. "
            "Choose another name."
        )
    try:
        result = learn(
            ship, read_all(args.voyages, ship, tell), settings_of(args), args.seeds, output, args.force
        )
    except ModuleNotFoundError as error:
        raise TwinError(NEEDS.format(error.name)) from None
    if args.json:
        whole.write_json(result, args.json)
    page = sys.stderr if args.json == "-" else sys.stdout
    if args.report:
        whole.write(args.report, training_page(result), "--report")
        print(f"wrote {args.report}", file=page)
    if not result["written"]:
        raise ThresholdError(f"{result['verdict']}; {output} was not written. Give more voyages, or --force.")
    print(f"{result['verdict']}\nwrote {output} and {manifest}", file=page)
    print(
        f'next: put residual.file = "{output}" into twin.toml, then twin run (or twin replay VOYAGE.mcap)',
        file=page,
    )
    return 0


def settings_of(args: argparse.Namespace) -> Any:
    """The training's settings, from the command line."""
    from export.settings import TrainingSettings

    named = {f.name for f in fields(TrainingSettings)}
    return TrainingSettings(**{name: value for name, value in vars(args).items() if name in named})


def learn(
    ship: Ship, sailed: list[Sailed], settings: Any, seeds: list[int], output: Path, force: bool = False
) -> dict[str, Any]:
    """Train for every seed, keep the best on validation, judge it on the test part, write it when it is
    worth having. DataError: too little was recorded."""
    from export import check, to_onnx
    from export.teach import teach, zeta_of
    from export.worth import share, worth

    sailed = sorted(sailed, key=lambda s: str(s.voyage.meta.get("start_time_utc") or ""))
    tracks = on_one_grid(sailed, ship)
    model = model_of(ship, tracks)
    parts = split([leg(t, model) for t in tracks])
    if not all(any(len(one) for one in legs) for legs in parts.values()):
        raise DataError("too little was recorded to train, validate and test. Give more voyages.")
    taught = []
    for seed in seeds:
        keep = output.with_name(f".{output.name}.{seed}.part.pt")
        taught.append(teach(parts, model, replace(settings, seed=seed), bar(f"seed {seed} "), keep))
    best = min(taught, key=lambda t: t.validation)
    judged = worth(best.network, model, parts["test"])
    samples = best.samples
    result = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "loss": settings.loss,
        "seeds": seeds,
        "seed": seeds[taught.index(best)],
        "held_out": judged.as_json(),
        "verdict": judged.sentence(),
        "learned_share": share(best.network, model, samples.situation(slice(None))),
        "inputs": list(best.network.names),
        "seconds": sum(t.seconds for t in taught),
        "epochs": dict(Counter(stage for stage, *_ in best.curve)),
        "voyages": [s.provenance() for s in sailed],
        "parts": {part: [one.name for one in legs] for part, legs in parts.items()},
        "written": judged.proved or force,
        "forced": force and not judged.proved,
    }
    if result["written"]:
        network = to_onnx.trunk(best.network)
        result["torch_onnx_difference"] = check.agree(best.network, network)
        to_onnx.write(
            output,
            network,
            to_onnx.manifest(best.network, network, zeta_of(best.network, samples), plain(result)),
        )
    for seed in seeds:
        output.with_name(f".{output.name}.{seed}.part.pt").unlink(missing_ok=True)
    return plain(result | {"curve": best.curve, "bounds": to_onnx.bounds(best.network)})


def on_one_grid(sailed: list[Sailed], ship: Ship) -> list[Track]:
    """The tracks, all with the step of the slowest recording, so that free runs of all can go side by
    side."""
    h = max(s.track.h for s in sailed)
    per_length = float(ship.scale("time")) / h
    return [s.track if abs(s.track.h - h) < 1e-3 * h else track(s.voyage, ship, per_length) for s in sailed]


def bar(label: str) -> Any:
    """A line on standard error that grows: stage, epoch, loss, validation loss."""

    def show(stage: str, epoch: int, epochs: int, loss: float, validation: float) -> None:
        filled = round(20 * epoch / epochs)
        text = (
            f"{label}{stage:<12} [{'#' * filled}{'.' * (20 - filled)}] {epoch:>3}/{epochs}  loss "
            f"{num(loss, 4)}  validation {num(validation, 4)}"
        )
        end = "\r" if sys.stderr.isatty() else "\n"
        if sys.stderr.isatty() or epoch % 10 == 0 or epoch == epochs:
            print(text, end=end if epoch < epochs else "\n", file=sys.stderr, flush=True)

    return show

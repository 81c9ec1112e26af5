"""`twin compare`: model against measurement, open loop from the measured state: how wrong, and where."""

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from twin.errors import DataError, ThresholdError
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.recording.import_voyage import write_json
from twin.recording.jsonable import plain
from twin.study.estimation.start import waves_on
from twin.study.prediction import locate, score
from twin.study.prediction.openloop import HORIZONS_S, Windows, predict
from twin.study.prediction.tell import told
from twin.study.prediction.thresholds import passed, positive, threshold
from twin.study.prediction.unexplained import Energy, energy
from twin.study.reference.sailed import Sailed, fed, read_all, switched_off
from twin.study.reference.structure import floor_of

SCHEMA_VERSION = 1
CLEARLY = 1.5  # times its floor, from which an error is more than it may be
EPILOG = """example:
  twin compare monday.mcap tuesday.mcap --ship alma.toml --report compare.html
  twin compare monday.mcap --ship alma.toml --fail-above position_mae_m=50 --json -

Metrics of --fail-above: position_mae_m, lateral_mae_m, heading_mae_deg (at the longest horizon, or at one:
position_mae_m@60), noise_units (position error over its floor), unexplained_force.surge|sway|yaw,
learned_share, channels.COLUMN.mae. Exit code 3: a threshold is passed; 4: a voyage cannot be used; 5: the
ship file is not valid.
"""


@dataclass(frozen=True)
class Compared:
    """What compare found (`result` is the contract's JSON), and what a report draws it from."""

    result: dict[str, Any]
    sailed: tuple[Sailed, ...]
    models: tuple[Model, ...]  # one for each voyage: without the effects that it cannot feed
    windows: tuple[Windows, ...]


def compare(sailed: Sequence[Sailed], model: Model, horizons_s: Sequence[float] = HORIZONS_S) -> Compared:
    """Predict every voyage open loop and judge the errors together."""
    ship, floor = model.ship, floor_of(model.ship)
    models = [fed(model, s.track)[0] for s in sailed]
    windows = [
        predict(s.track, m, horizons_s, floor=floor, seed=i)
        for i, (s, m) in enumerate(zip(sailed, models, strict=True))
    ]
    rows = score.horizons(windows, horizons_s, floor is not None)
    if not rows:
        raise DataError(
            f"{', '.join(s.track.name for s in sailed)}: no stretch of {min(horizons_s):g} s with controls "
            "and position "
            "throughout. Give a longer voyage, or shorter horizons with --horizon."
        )
    longest = rows[-1]["horizon_s"]
    judged = energy([s.track for s in sailed], models)
    where = locate.regimes(windows, _locating(rows), ship, floor is not None)
    result = _result(ship, model, sailed, rows, judged)
    result |= {
        "channels": score.channels(windows, floor is not None),
        "where": [{k: v for k, v in w.items() if k != "mask"} for w in where],
        "worst_windows": locate.worst(windows, longest),
        "switched_off": switched_off(model, [s.track for s in sailed]),
        "waves": waves_on([s.track for s in sailed]),
    }
    result["verdict"] = verdict(result)
    return Compared(plain(result), tuple(sailed), tuple(models), tuple(windows))


def _result(
    ship: Ship, model: Model, sailed: Sequence[Sailed], rows: list[dict[str, Any]], judged: Energy
) -> dict[str, Any]:
    from twin.live.learning.residual import ship_hash
    from twin.recording.checks import run_checks

    checks = [(s.track.name, c) for s in sailed for c in run_checks(s.voyage, ship)]
    names = {name for name, _ in checks}
    return {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "model": {
            "effects": [type(e).__name__ for e in model.effects],
            "hash": ship_hash(ship),
            "residual": model.residual is not None,
        },
        "voyages": [s.provenance() | {"duration_s": s.voyage.duration_s} for s in sailed],
        "horizons": rows,
        "unexplained_force": judged.unexplained(),
        "learned_share": judged.learned_share(),
        "data_checks": [c.as_json() | ({"voyage": name} if len(names) > 1 else {}) for name, c in checks],
    }


def _locating(rows: list[dict[str, Any]]) -> float:
    """The horizon at which errors are located: one below the longest, since a shorter window says better when
    it happened."""
    return float(rows[max(len(rows) - 2, 0)]["horizon_s"])


def verdict(result: dict[str, Any]) -> str:
    """The sentence that an engineer reads first: of the longest horizon, or, where that one is no worse than
    it may be, of the one that stands out most."""
    keys, rows = ("position_mae_m", "heading_mae_deg"), result["horizons"]
    most = [max(score.in_noise(row, k) for k in keys) for row in rows]
    row = rows[-1 if most[-1] >= CLEARLY or max(most) < CLEARLY else most.index(max(most))]
    floor, times = row["noise_floor"], [score.in_noise(row, k) for k in keys]
    best = (
        ("a model as good as its calibration") if row["noise_floor"]["of"] != "sensors" else "a perfect model"
    )
    head = f"After {row['horizon_s']:g} s the model is {row[keys[0]]:.3g} m and {row[keys[1]]:.2g} deg off"
    would = f"{best} would look through these instruments ({floor[keys[0]]:.2g} m, {floor[keys[1]]:.2g} deg)"
    if max(times) < CLEARLY:
        return f"{head}: no worse than {would}."
    tail = f", {times[0]:.2g} and {times[1]:.2g} times what {would}"
    where = result["where"][:1]
    return (
        head
        + tail
        + "".join(
            f"; it is {w['error_ratio']:.2g} times larger with {w['condition']} than elsewhere" for w in where
        )
        + "."
    )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument(
        "voyages",
        metavar="VOYAGE",
        nargs="+",
        help="voyages: MCAP logs or CSV files with the contract's columns",
    )
    parser.add_argument(
        "--ship", metavar="SHIP.toml", required=True, help="the model: a ship file, or a bundled ship's name"
    )
    parser.add_argument(
        "--horizon",
        metavar="S",
        type=positive,
        action="append",
        help="seconds ahead (repeat; default 10, 60, 120)",
    )
    parser.add_argument("--residual", metavar="FILE.onnx", help="what was learned, added as the loop adds it")
    parser.add_argument(
        "--fail-above",
        metavar="METRIC=VALUE",
        type=threshold,
        action="append",
        default=[],
        help="exit 3 above VALUE",
    )
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--report", metavar="FILE.html", help="one self-contained page with the plots")


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    model = Model.of(ship)
    if args.residual:
        model = replace(model, residual=_learned(args.residual, ship))
    sailed = read_all(args.voyages, ship)
    print("predicting ...", file=sys.stderr)
    found = compare(sailed, model, sorted(set(args.horizon or HORIZONS_S)))
    result = found.result | {
        "command": f"twin compare {' '.join(args.voyages)} --ship {args.ship}",
        "files": {"ship": args.ship, "voyages": args.voyages},
    }
    if args.json:
        write_json(result, args.json)
    page = sys.stderr if args.json == "-" else sys.stdout
    print("\n".join(told(result)), file=page)
    if args.report:
        _report(args.report, found, model, result)
        print(f"\nwrote {args.report}", file=page)
    print(f"\nnext: {_next(args, result)}", file=page)
    if unmet := passed(result, args.fail_above):
        raise ThresholdError(f"{'; '.join(unmet)}.")
    return 0


def _learned(path: str, ship: Ship) -> Callable:
    from twin.study.estimation.learned import learned_force

    return learned_force(path, ship)


def _report(path: str, found: Compared, model: Model, result: dict[str, Any]) -> None:
    from twin import report

    report.write(
        path,
        "compare",
        result,
        [s.track for s in found.sailed],
        model,
        voyages=[s.voyage for s in found.sailed],
    )


def _next(args: argparse.Namespace, result: dict[str, Any]) -> str:
    rest = f"{' '.join(args.voyages)} --ship {args.ship}"
    if result["horizons"][-1]["noise_floor"]["of"] == "sensors":
        first = f"twin calibrate REFERENCE.mcap --ship {args.ship} -o calibrated.toml, or "
        return f"{first}twin diagnose {rest} --report diagnose.html"
    return f"twin diagnose {rest} --report diagnose.html"

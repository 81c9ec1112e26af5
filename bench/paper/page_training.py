"""What the page says of learning: amount of data, validation against test, how each model was tuned."""

from statistics import mean, stdev
from typing import Any

from bench.paper.models import ROWS


def spread(rows: Any) -> str:
    """Mean and spread of [heading, lateral] errors, and each of them."""
    told = []
    for x, unit, digits in zip(zip(*rows, strict=True), ("deg", "m"), (3, 2), strict=True):
        each = ", ".join(f"{y:.{digits}f}" for y in x)
        told.append(
            f"{mean(x):.{digits}f} +- {stdev(x):.{digits}f} {unit} ({100 * stdev(x) / mean(x):.1f} %; {each})"
        )
    return "; ".join(told)


def meeting(models: dict[str, Any]) -> list[str]:
    """Do learned features and the core's columns meet?"""
    lines = [
        "",
        "## Do F_D and F_theta meet?",
        "",
        "The paper says that they do not. Along the test runs (medians): the smallest angle between the span "
        "of the 64 features and that of the "
        "core's columns, and how much of the learned force the core's own columns could give.",
        "",
        "| network on | surge | sway | yaw |",
        "|---|---|---|---|",
    ]
    for name, words in (
        ("hybrid", "the nominal core"),
        ("physics_added_hybrid", "the calibrated core with named effects"),
    ):
        cells = [
            f"{a['smallest_deg']:.2f} deg, {100 * a['force_inside_core']:.0f} %"
            for a in models[name]["apart"].values()
        ]
        lines.append(f"| {words} | {' | '.join(cells)} |")
    return lines


def over_data(t: dict[str, Any]) -> list[str]:
    names = ("hybrid", "physics_added_hybrid", "lstm")
    lines = [
        "",
        "## Error over amount of data",
        "",
        "Heading MAE deg / lateral MAE m of the same unseen zigzags.",
        "",
        "| runs of 900 s that teach | hybrid | calibrated + named + network, from these runs alone | LSTM |",
        "|---|---|---|---|",
    ]
    for x in t["data"]:
        lines.append(
            f"| {x['runs']} | "
            + " | ".join(f"{x[n]['heading_mae_deg']:.3f} / {x[n]['lateral_mae_m']:.2f}" for n in names)
            + " |"
        )
    three = t["3"]
    whole = [f"{three['heading_mae_deg'][n]:.3f} / {three['lateral_mae_m'][n]:.2f}" for n in names]
    lines += [f"| all | {' | '.join(whole)} |"]
    for x in t["data"]:
        if len(x["by_seed"]) > 1:
            lines += [
                "",
                f"{ROWS['physics_added_hybrid']}, from {x['runs']} run(s), over "
                f"{len(x['by_seed'])} seeds: {spread(x['by_seed'])}.",
            ]
    return lines


def validation_and_test(told: dict[str, Any]) -> list[str]:
    gap = told["gap"]
    lines = [
        "",
        "## From validation to test",
        "",
        f"{gap['runs']['validation']} runs that said when to stop and {gap['runs']['test']} that never did, "
        "manoeuvres, seas and speeds alike; "
        "windows every minute. The nominal model was never trained: what it changes by, the voyages change "
        "by. Paper: at most 4.5 %.",
        "",
        "| model | heading deg, validation and test | change | 95 % by voyage | lateral m | change | 95 % by "
        "voyage |",
        "|---" * 7 + "|",
    ]
    for name in ("hybrid", "analytic_current"):
        cells = []
        for short, digits in (("heading", 3), ("lateral", 2)):
            x = gap[name][short]
            low, high = x["by_voyage_95"]
            cells += [
                f"{x['validation']:.{digits}f}, {x['test']:.{digits}f}",
                f"{x['change_percent']:+.1f} %",
                f"{low:+.0f} to {high:+.0f} %",
            ]
        lines.append(f"| {ROWS[name]} | {' | '.join(cells)} |")
    return lines


def tuning(r: dict[str, Any]) -> list[str]:
    ekf = r["models"]["ekf"]
    kept = "kept" if ekf["disturbance_kept_in_prediction"] else "dropped"
    f = r["models"]["hybrid"]["filter"]
    return [
        "",
        "## How each was tuned",
        "",
        "* Nominal: literature coefficients, off by 4 to 20 % (bench/paper/nominal_ship.py), fixed before "
        "any result was seen.",
        "* EKF: three sizes of the disturbance's walk, disturbance kept or dropped in the prediction; best "
        "on the validation runs: "
        f"walk {ekf['walk']:g}, {kept}.",
        "* LSTM: one layer of 64, 30 s to warm up, trained by 60 s free runs, averaged weights and early "
        "stop on the validation runs; as ONNX it "
        f"says the same to {r['models']['lstm']['torch_onnx_difference']:.0e}.",
        f"* Hybrid: docs/training.md's settings, {r['models']['hybrid']['epochs']} epochs; averaged weights "
        "and early stop on the validation runs.",
        f"* Its filter (bench/paper/filter.py): walks {f['walk']:g} and {f['current']:g}, noise x "
        f"{f['noise']:g}, best on the validation "
        "runs; the same search for every row that begins in its own filter.",
        "* Calibrated: the study's fit on TS-01 training runs; Wind and WaveDrift on the others.",
    ]

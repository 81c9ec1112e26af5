"""The page of `twin-bench paper`: every table, the paper's number beside ours, and what is not done."""

from statistics import mean, stdev
from typing import Any

from bench.paper import claims as paper_claims
from bench.paper.claims import GOALS_7
from bench.paper.models import ROWS


def page(r: dict[str, Any]) -> list[str]:
    """Markdown."""
    three, counts = r["tables"]["3"], r["counts"]
    lines = [
        "# The paper's tables on open voyages",
        "",
        f"`twin-bench paper {'--quick' if r['quick'] else '--full'}`: {counts['lessons']} runs of 900 s to "
        "learn from, "
        f"{counts['zigzags']} zigzags of 900 s that nothing was trained or tuned on ({three['windows']} "
        "windows of 120 s), "
        f"{three['seeds']['count']} seed(s), {r['cpu_seconds']:.0f} s of CPU.",
        *paper_claims.lines(r),
        "",
        "## Table 3: zigzag, 120 s",
        "",
        "| model | heading MAE deg | lateral MAE m | R2 heading | R2 lateral |",
        "|---|---|---|---|---|",
    ]
    lines += [f"| {words} | {_three(three, name)} |" for name, words in ROWS.items()]
    lines += _seeds(three["by_seed"])
    return (
        lines
        + _ratios(r)
        + _scenarios(three)
        + _four_to_six(r["tables"])
        + _seven(r["tables"]["7"])
        + _eight(r["tables"]["8"])
        + _nine(r["tables"])
        + _five(r["tables"]["fig5"])
        + _data(r["tables"])
        + _gap(r["models"])
        + _apart(r["models"])
        + _end(r)
        + _figures(r["tables"])
    )


def _seeds(by_seed: dict[str, Any]) -> list[str]:
    """The hybrids over all seeds."""
    many = {name: rows for name, rows in by_seed.items() if len(rows) > 1}
    return [
        x
        for name, rows in many.items()
        for x in ("", f"Over {len(rows)} seeds, {ROWS[name].replace('**', '')}: {_spread(rows)}.")
    ]


def _spread(rows: Any) -> str:
    """Mean and spread of [heading, lateral] errors, and each of them."""
    told = []
    for x, unit, digits in zip(zip(*rows, strict=True), ("deg", "m"), (3, 2), strict=True):
        each = ", ".join(f"{y:.{digits}f}" for y in x)
        told.append(
            f"{mean(x):.{digits}f} +- {stdev(x):.{digits}f} {unit} ({100 * stdev(x) / mean(x):.1f} %; {each})"
        )
    return "; ".join(told)


def _apart(models: dict[str, Any]) -> list[str]:
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


def _three(t: dict[str, Any], name: str) -> str:
    cells = []
    for measure, digits in (
        ("heading_mae_deg", 3),
        ("lateral_mae_m", 2),
        ("r2_heading", 3),
        ("r2_lateral", 3),
    ):
        paper = t[measure]["paper"].get(name)
        cells.append(f"{t[measure][name]:.{digits}f}" + (f" (paper {paper:g})" if paper is not None else ""))
    return " | ".join(cells)


def _ratios(r: dict[str, Any]) -> list[str]:
    paper = {"analytic": (14.0, 12.7), "ekf": (3.2, 3.1)}
    lines = [
        "",
        "How many times smaller the hybrid's errors are:",
        "",
        "| than | heading | lateral | the paper's |",
        "|---|---|---|---|",
    ]
    for name in ("analytic", "ekf", "lstm", "calibrated", "physics_added"):
        said = "{:g}, {:g}".format(*paper[name]) if name in paper else ""
        lines.append(
            f"| {ROWS[name]} | {r['ratios'][f'heading_vs_{name}']:.2f} | "
            f"{r['ratios'][f'lateral_vs_{name}']:.2f} | {said} |"
        )
    h, a = r["models"]["hybrid"], r["models"]["physics_added_hybrid"]
    lines += [
        "",
        f"The network's share of all force is {100 * h['share_of_force']:.1f} % on the nominal core and "
        f"{100 * a['share_of_force']:.1f} % on the calibrated core with named effects.",
    ]
    return lines


def _scenarios(t: dict[str, Any]) -> list[str]:
    names = list(t["by_scenario"])
    lines = ["", f"| heading deg / lateral m | {' | '.join(names)} |", "|---" * (1 + len(names)) + "|"]
    return lines + [
        f"| {w} | " + " | ".join("{:.2f} / {:.2f}".format(*t["by_scenario"][s][n]) for s in names) + " |"
        for n, w in ROWS.items()
    ]


def _four_to_six(t: dict[str, Any]) -> list[str]:
    lines = [
        "",
        "## Tables 4 to 6: lateral, how sure",
        "",
        "The five windows of one voyage share ship, weather and sea, so that their errors are not "
        "independent: intervals by voyage are the "
        "honest ones. The paper gives 34.7 m to the EKF in its Table 3 and to the LSTM in its Table 4; here "
        "each has its own.",
        "",
        "| model | MAE m | 95 % by voyage | 95 % by window | R2 | 95 % by voyage | hybrid smaller: Cliff | p "
        "by voyage | p by window |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, words in ROWS.items():
        four, six, five = t["4"][name], t["6"][name], t["5"].get(name)
        paper = (
            (f" (paper {four['paper'][0]:g} [{four['paper'][1]:g}, {four['paper'][2]:g}])")
            if four["paper"]
            else ""
        )
        r2 = f" (paper {six['paper'][0]:g})" if six["paper"] else ""
        size = (
            f"{five['cliff']:.2f}"
            + (f" (paper {five['paper']:g})" if five["paper"] else "")
            + f" | {five['p_by_voyage']:.2g} | {five['p_by_window']:.2g}"
            if five
            else "| |"
        )
        lines.append(
            f"| {words} | {four['mae_m']:.2f}{paper} | {_range(four['by_voyage_95'])} | "
            f"{_range(four['by_window_95'])} "
            f"| {six['r2']:.3f}{r2} | {_range(six['by_voyage_95'], 3)} | {size} |"
        )
    return lines


def _range(x: Any, digits: int = 2) -> str:
    return f"[{x[0]:.{digits}f}, {x[1]:.{digits}f}]"


def _seven(t: dict[str, Any]) -> list[str]:
    names = ("analytic", "hybrid", "hybrid_adapted", "physics_added_hybrid")
    lines = [
        "",
        "## Table 7: a ship that is not the one of the models",
        "",
        "No model is told. Heading MAE deg / lateral MAE m. A change in % of a model's own error is not well "
        "posed when that error is "
        "small, nor when the nominal is wrong the other way, so the change in % of the nominal analytic "
        "error stands below it.",
        "",
        "| ship | analytic | hybrid | hybrid, learning on | calibrated + named + network |",
        "|---|---|---|---|---|",
    ]
    for case, row in t.items():
        cells = [
            f"{row['absolute'][n]['heading_mae_deg']:.3f} / {row['absolute'][n]['lateral_mae_m']:.2f}"
            for n in names
        ]
        lines.append(
            f"| {case if case != 'GNSS sensor noise (0.5 m)' else 'GNSS noise (as it is; before: none)'} | "
            f"{' | '.join(cells)} |"
        )
    lines += [
        "",
        "| change, lateral (heading) | analytic, own % | paper | hybrid learning on, own % | of the "
        "nominal analytic error % | paper's hybrid "
        "| within |",
        "|---|---|---|---|---|---|---|",
    ]
    for case, goal in GOALS_7.items():
        row, me = t[case], "hybrid_adapted"
        own, of = row["lateral_own_change_percent"], row["lateral_change_percent_of_analytic"][me]
        turn = row["heading_change_percent_of_analytic"][me]
        lines.append(
            f"| {case} | {own['analytic']:+.1f} | {row['paper']['analytic']:+g} | {own[me]:+.1f} "
            f"| {of:+.1f} ({turn:+.1f}) | {row['paper']['hybrid']:+g} | {_within(of, goal)} "
            f"({_within(turn, goal)}) |"
        )
    return lines


def _within(change: float, goal: float) -> str:
    return "yes" if change <= goal else "no"


def _eight(t: dict[str, Any]) -> list[str]:
    names = ("ekf", "hybrid", "physics_added_hybrid", "analytic")
    lines = [
        "",
        "## Table 8: by speed",
        "",
        "5, 10.5 and 14.5 knots: this ship does 15.5, there are no 20. Heading MAE deg / lateral MAE m; the "
        "paper gives the lateral one.",
        "",
        "| regime | EKF (paper) | hybrid (paper) | calibrated + named + network | analytic |",
        "|---|---|---|---|---|",
    ]
    for regime, x in t.items():
        said = {n: f" ({m:g})" for n, m in x["paper"].items()}
        lines.append(
            f"| {regime} | "
            + " | ".join(f"{x['heading_deg'][n]:.3f} / {x[n]:.2f}{said.get(n, '')}" for n in names)
            + " |"
        )
    return lines


PAPER_9 = {"analytic": (8.0, 12), "lstm": (34.0, 215)}  # ms, MB


def _nine(t: dict[str, Any]) -> list[str]:
    """Table 9, from `twin-bench --json`."""
    lines = ["", "## Table 9: cost of a step", ""]
    if "9" not in t:
        return [
            *lines,
            "`twin-bench` measures it: [tick.md](tick.md); `--tick FILE.json` brings its figures here.",
        ]
    r, board = t["9"], t["9"]["cortex_a72"]
    lines += [
        "From `twin-bench --json` on this machine; the paper's are a Cortex-A72's. The loop's step holds "
        "everything on board (sensors, observer, "
        "guard, certificate, log), the others one step of the "
        "model.",
        "",
        "| | here us, median | paper ms | paper MB |",
        "|---|---|---|---|",
    ]
    for name, (ms, mb) in PAPER_9.items():
        lines.append(f"| {name} | {r['peers'][name]['median_us']:.0f} | {ms:g} | {mb} |")
    loop, peak = r["step_us"], r["rss_peak_mb"]
    return [
        *lines,
        f"| EKF | {r['peers']['ekf']['median_us']:.0f} | | |",
        f"| the whole loop | {loop['median']:.0f} (p99.9 {loop['p999']:.0f}) | 12 | 48 (here {peak:.1f} at "
        "the peak) |",
        "",
        f"On a Cortex-A72, by published ratios and not measured: {board['step_ms_median']:.2f} ms, p99.9 "
        f"{board['step_ms_p999']:.1f} ms.",
    ]


def _five(rows: list[dict[str, Any]]) -> list[str]:
    lines = [
        "",
        "## Fig. 5: the closed loop",
        "",
        "+15 deg through a reference of third order, gust of 10 m/s from abeam at 7 L/U for one L/U, rudder "
        "by the inverse of the model "
        "with tau_corr (bench/paper/closed.py). Worst of the seeds unless it says mean. Goals: settled "
        "within 5 L/U, overshoot at most "
        "8 %, steady error at most 0.02 of the step, rudder short of 35 deg. The paper settles in 20 to 25 "
        "s: at a Froude scale of 1:64, "
        "not with a ship of 320 m.",
        "",
        "| controller | sea | runs | settled L/U, mean (worst) | full scale s | 1:64 s (paper 20-25) | "
        "overshoot % (8) | steady error (0.02) "
        "| gust deg | rudder deg | deg/s | met |",
        "|---" * 12 + "|",
    ]
    return lines + [
        f"| {x['mode']} | {x['scenario']} | {x['runs']} | {x['settle_lengths_mean']:.2f} "
        f"({x['settle_lengths_max']:.2f}) "
        f"| {x['settle_s_full_scale']:.0f} | {x['settle_s_model_1_64']:.1f} | {x['overshoot_percent']:.1f} | "
        f"{x['steady_error_max']:.4f} "
        f"| {x['gust_deg']:.2f} | {x['rudder_deg']:.1f} | {x['rudder_degps']:.2f} | "
        f"{'yes' if x['met'] else 'no'} |"
        for x in rows
    ]


def _data(t: dict[str, Any]) -> list[str]:
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
                f"{len(x['by_seed'])} seeds: {_spread(x['by_seed'])}.",
            ]
    return lines


def _gap(told: dict[str, Any]) -> list[str]:
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


def _end(r: dict[str, Any]) -> list[str]:
    ekf = r["models"]["ekf"]
    kept = "kept" if ekf["disturbance_kept_in_prediction"] else "dropped"
    f = r["models"]["hybrid"]["filter"]
    return [
        "",
        "## How each was tuned",
        "",
        "* Nominal: literature coefficients, off by 4 to 20 % (bench/paper/ship.py), fixed before any result "
        "was seen.",
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


def _figures(t: dict[str, Any]) -> list[str]:
    """Those that were drawn beside the page."""
    files = ("2-learning", "3-zigzag", "4-errors", "5-closed-loop", "6-horizon", "7-data")
    return ["", *(f"![Fig. {name[0]}](fig-{name}.png)" for name in files)] if "fig6_ms" in t else []

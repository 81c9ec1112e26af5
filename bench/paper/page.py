"""The page of `twin-bench paper`: every table, the paper's number beside ours, and what is not done."""

from typing import Any

from bench.paper import claims as paper_claims
from bench.paper.models import ROWS
from bench.paper.page_certainty import eight, four_to_six, seven
from bench.paper.page_costs import five, nine
from bench.paper.page_training import meeting, over_data, spread, tuning, validation_and_test


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
        + four_to_six(r["tables"])
        + seven(r["tables"]["7"])
        + eight(r["tables"]["8"])
        + nine(r["tables"])
        + five(r["tables"]["fig5"])
        + over_data(r["tables"])
        + validation_and_test(r["models"])
        + meeting(r["models"])
        + tuning(r)
        + _figures(r["tables"])
    )


def _seeds(by_seed: dict[str, Any]) -> list[str]:
    """The hybrids over all seeds."""
    many = {name: rows for name, rows in by_seed.items() if len(rows) > 1}
    return [
        x
        for name, rows in many.items()
        for x in ("", f"Over {len(rows)} seeds, {ROWS[name].replace('**', '')}: {spread(rows)}.")
    ]


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


def _figures(t: dict[str, Any]) -> list[str]:
    """Those that were drawn beside the page."""
    files = ("2-learning", "3-zigzag", "4-errors", "5-closed-loop", "6-horizon", "7-data")
    return ["", *(f"![Fig. {name[0]}](fig-{name}.png)" for name in files)] if "fig6_ms" in t else []

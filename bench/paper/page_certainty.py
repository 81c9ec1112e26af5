"""How sure the errors are, and what another ship or speed does to them: Tables 4 to 8."""

from typing import Any

from bench.paper.claims import GOALS_7
from bench.paper.models import ROWS


def four_to_six(t: dict[str, Any]) -> list[str]:
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


def seven(t: dict[str, Any]) -> list[str]:
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


def eight(t: dict[str, Any]) -> list[str]:
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

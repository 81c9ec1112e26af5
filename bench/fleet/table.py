"""The figures of a fleet as a page, from its rows: `python -m bench.fleet table FOLDER --page FILE.md`."""

import argparse
import json
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bench.fleet import judged
from bench.fleet.hidden import OF_THE_VOYAGE
from bench.fleet.judged import Row, Share, share
from bench.fleet.run import ROWS, read

BINS = (0.0, 0.2, 0.5, 0.8, 0.9, 0.95, 1.0)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="+", help="folders with rows.jsonl")
    parser.add_argument("--page", type=Path, metavar="FILE.md")
    parser.add_argument("--json", type=Path, metavar="FILE.json")
    parser.add_argument(
        "--fit", type=Path, metavar="FILE.json", help="what `fit` wrote, told on the same page"
    )


def rows_of(folders: Sequence[Path]) -> list[dict[str, Any]]:
    """Rows of several folders, each key once, those that failed left out."""
    found = {row["key"]: row for folder in folders for row in read(folder / ROWS)}
    return [row for row in found.values() if "failed" not in row]


FIGURES: dict[str, tuple[str, Callable[[Row], bool], Callable[[Row], bool]]] = {  # goal, which rows, what is counted
    "single cause named, alone and right": ("", lambda r: r["kind"] == "single", judged.right),
    "the same where its oracle gains 10 % or more": (
        ">= 90 %", lambda r: r["kind"] == "single" and judged.gains(r), judged.right,
    ),
    "a wrong name beside or in its place": ("", lambda r: r["kind"] == "single", lambda r: bool(judged.wrong_names(r))),
    "healthy voyages with an alarm (a cause named, or `unknown`)": (
        "<= 2 %", lambda r: r["kind"] == "nothing", judged.alarm,
    ),
    "healthy voyages on which a cause is named": (
        "", lambda r: r["kind"] == "nothing", lambda r: bool(judged.causes(r["missing"])),
    ),
    "two causes, both named": (">= 85 %", lambda r: r["kind"] == "pair", judged.right),
    "two causes, both named, where their oracle gains 10 %": (
        "", lambda r: r["kind"] == "pair" and judged.gains(r), judged.right,
    ),
    "three causes, all named": (">= 70 %", lambda r: r["kind"] == "triple", judged.right),
    "outside the catalogue: `unknown`, or undecided without a name": (
        ">= 85 %", lambda r: r["kind"] == "outside", judged.right,
    ),
    "the same where the model ends clearly astray": (
        "", lambda r: r["kind"] == "outside" and judged.astray(r), judged.right,
    ),
    "outside the catalogue: a name is given": (
        "<= 15 %", lambda r: r["kind"] == "outside", lambda r: bool(judged.causes(r["missing"])),
    ),
}  # fmt: skip


def figures(rows: Sequence[Row]) -> dict[str, Share]:
    return {name: share([what(r) for r in rows if which(r)]) for name, (_, which, what) in FIGURES.items()}


def page(rows: Sequence[Row], fit: dict[str, Any] | None = None) -> str:
    """The whole page."""
    families = sorted({r["family"] for r in rows})
    ships = len({(r["family"], r["seed"]) for r in rows})
    out = [
        "# The decision on ships of many forms", "",
        f"{len(rows)} voyages of {ships} random ships of {len(families)} families (`bench/fleet`): wind, stream and swell on",
        "every voyage, instruments with faults of their own, two to six reference voyages, none of it in the twin's",
        "form. Weather that is named or told as today's is never counted against an answer. Intervals: 95 %, Wilson.",
        "No ship of these was looked at while the decision was made, except where this page says so.", "",
        "```sh", "python -m bench.fleet run FOLDER --seeds 0-7 --voyages 8 --workers 16", "python -m bench.fleet table FOLDER --page docs/results/judgement.md", "```", "",
        "## Figures", "", "| | goal | measured |", "|---|---|---|",
    ]  # fmt: skip
    out += [f"| {n} | {FIGURES[n][0]} | {s} |" for n, s in figures(rows).items()]
    p90 = [(p, t) for r in rows for p, t in judged.told_probabilities(r) if 0.85 <= p < 0.95]
    held = [inside for r in rows for _, inside in judged.intervals(r)]
    out += [
        f"| of the causes told with a probability near 0.9 (0.85 to 0.95), there | 85 to 95 % | {share([t for _, t in p90])} |",
        f"| 95 % intervals of rightly named causes that hold the truth | 90 to 98 % | {share(held)} |",
        "", "## By family", "", "| family | ships | " + " | ".join(SHORT) + " |", "|---|---|" + "---|" * len(SHORT),
    ]  # fmt: skip
    for family in families:
        own = [r for r in rows if r["family"] == family]
        told = figures(own)
        out.append(
            f"| {family} | {len({r['seed'] for r in own})} | "
            + " | ".join(_short(told[n]) for n in SHORT.values())
            + " |"
        )
    out += _by_effect(rows) + _reliability(rows) + _answers(rows) + _conformal(rows)
    if fit:
        out += fit["page"]
    seconds = [r["cpu_s"] for r in rows]
    out += [
        "", "## Cost", "",
        f"Processor seconds of a diagnosis: {np.median(seconds):.0f} in the median, {np.percentile(seconds, 90):.0f} at the 90th percentile, "
        f"{max(seconds):.0f} at most; of a calibration: {np.median([r['calibration_s'] for r in rows]):.0f} in the median.",
    ]  # fmt: skip
    return "\n".join(out) + "\n"


SHORT = {
    "single, gains": "the same where its oracle gains 10 % or more",
    "single, all": "single cause named, alone and right",
    "healthy, alarm": "healthy voyages with an alarm (a cause named, or `unknown`)",
    "pair": "two causes, both named",
    "outside": "outside the catalogue: `unknown`, or undecided without a name",
}


def _short(s: Share) -> str:
    return f"{s.k}/{s.n}" if s.n else "-"


def _by_effect(rows: Sequence[Row]) -> list[str]:
    """Single effects: how often right, and what is said otherwise."""
    out = [
        "",
        "## By effect (singles)",
        "",
        "| hidden | right | right where the oracle gains | said otherwise |",
        "|---|---|---|---|",
    ]
    for name in sorted({n for r in rows if r["kind"] in ("single", "outside") for n in r["hidden"]}):
        own = [r for r in rows if list(r["hidden"]) == [name]]
        said = Counter(_said(r) for r in own if not judged.right(r))
        gain = share([judged.right(r) for r in own if judged.gains(r)])
        out.append(
            f"| {name} | {_short(share([judged.right(r) for r in own]))} | {_short(gain)} | {', '.join(f'{w} {k}' if k > 1 else w for w, k in said.most_common(5))} |"
        )
    return out


def _said(r: Row) -> str:
    named = [n for n in r["missing"] if n not in OF_THE_VOYAGE]
    return "+".join(named) if named else f"`{r['reason']}`"


def _reliability(rows: Sequence[Row]) -> list[str]:
    told = [x for r in rows for x in judged.told_probabilities(r)]
    out = [
        "",
        "## Reliability",
        "",
        "Each probability that an answer tells of a cause of ship or instruments (5 % or more), and how often the cause is there.",
        "",
        "| told | mean told | there |",
        "|---|---|---|",
    ]
    for lo, hi in zip(BINS, BINS[1:], strict=False):
        own = [(p, t) for p, t in told if lo <= p < hi or (hi == 1.0 and p == 1.0)]
        if own:
            out.append(
                f"| {lo:.2f} to {hi:.2f} | {np.mean([p for p, _ in own]):.2f} | {share([t for _, t in own])} |"
            )
    return out


def _answers(rows: Sequence[Row]) -> list[str]:
    """Reasons by what is hidden."""
    kinds = ("nothing", "single", "pair", "triple", "outside")
    reasons = [r for r, _ in Counter(r["reason"] for r in rows).most_common()]
    out = ["", "## Reasons", "", "| reason | " + " | ".join(kinds) + " |", "|---|" + "---|" * len(kinds)]
    return out + [
        f"| `{reason}` | "
        + " | ".join(str(sum(r["kind"] == k and r["reason"] == reason for r in rows)) for k in kinds)
        + " |"
        for reason in reasons
    ]


def _conformal(rows: Sequence[Row]) -> list[str]:
    """The p-value on healthy voyages, where the ship file had the scores of its references."""
    with_p = [r for r in rows if r.get("p_value") is not None]
    if not with_p:
        return []
    out = [
        "",
        "## Conformal p-value",
        "",
        "Share of voyages whose p is at the least that the references can show, which may happen on that share of healthy voyages.",
        "",
        "| references | least p | healthy at it | something hidden at it |",
        "|---|---|---|---|",
    ]
    for n in sorted({r["p_value_at_best"] for r in with_p}, reverse=True):
        own = [r for r in with_p if r["p_value_at_best"] == n]
        at = lambda healthy, own=own: share(
            [r["p_value"] <= r["p_value_at_best"] for r in own if (r["kind"] == "nothing") == healthy]
        )
        out.append(f"| {round(1 / n) - 1} | {n:.2f} | {at(True)} | {at(False)} |")
    return out


def run(args: argparse.Namespace) -> int:
    rows = rows_of(args.folder)
    text = page(rows, json.loads(args.fit.read_text()) if args.fit else None)
    if args.page:
        args.page.write_text(text)
    else:
        print(text)
    if args.json:
        args.json.write_text(
            json.dumps({n: [s.k, s.n, *s.interval()] for n, s in figures(rows).items()}, indent=1)
        )
    return 0

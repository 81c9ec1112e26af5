"""The figures of a fleet as a page, from its rows: `python -m bench.fleet table FOLDER --page FILE.md`."""

import argparse
import json
import sys
from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np

from bench.fleet import answer_score
from bench.fleet.answer_score import Row, Share, share
from bench.fleet.decided_again import decided
from bench.fleet.fleet_figures import FIGURES, SHORT, figures
from bench.fleet.hidden_causes import OF_THE_VOYAGE
from bench.fleet.run import ROWS, read
from bench.fleet.voyage_plan import practice
from twin.errors import DataError

RIGHT = (
    "**Right**: every hidden cause of ship and instruments is named and no other; hidden weather is named or "
    "told; no cause is named on a healthy ship. **Its oracle gains**: the truth, fitted by the twin's own "
    "form of it, brings the open-loop error down by a tenth. Hidden weather is held against the best other "
    "weather of the day."
)
BY_HAND = "## What it says"  # from this title on
BINS = (0.05, 0.2, 0.5, 0.8, 0.9, 0.95, 1.0)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="+", help="folders with rows.jsonl")
    parser.add_argument("--page", type=Path, metavar="FILE.md")
    parser.add_argument("--json", type=Path, metavar="FILE.json")
    parser.add_argument(
        "--fit", type=Path, metavar="FILE.json", help="what `fit` wrote, told on the same page"
    )


def rows_of(folders: Sequence[Path]) -> list[dict[str, Any]]:
    """Rows of several folders, each key once; those that failed are left out, and told. DataError: a folder
    has none."""
    for folder in folders:
        if not (folder / ROWS).exists():
            raise DataError(f"{folder}: no {ROWS} in it. Make it: python -m bench.fleet run {folder}")
    found = {row["key"]: row for folder in folders for row in read(folder / ROWS)}
    failed = sorted(key for key, row in found.items() if "failed" in row)
    if failed:
        print(f"{len(failed)} voyages could not be asked: {', '.join(failed)}", file=sys.stderr)
    return [row for row in found.values() if "failed" not in row]


def page(rows: Sequence[Row], fit: dict[str, Any] | None = None) -> str:
    """The whole page."""
    fitted = fit["page"] if fit else []
    return "\n".join([*head(rows), *_figures(rows), *in_detail(rows), *fitted, *cost(rows)]) + "\n"


def in_detail(rows: Sequence[Row]) -> list[str]:
    """The sections by family, effect, posterior, reason and p-value, of the answers that the table of today
    gives."""
    again, out = [decided(r) for r in rows], []
    for part in (_families, _effects, _reliability, _reasons, _conformal):
        out += part(again)
    return out


def lines(title: str, text: str, head: Sequence[str], body: Sequence[Sequence[object]]) -> list[str]:
    """A section with a table."""
    out = ["", f"## {title}", "", *([text, ""] if text else [])]
    out += [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    return out + [f"| {' | '.join(str(cell) for cell in row)} |" for row in body]


def head(rows: Sequence[Row]) -> list[str]:
    """The title, how many ships and voyages there are, and what counts as right."""
    ships, families = len({(r["family"], r["seed"]) for r in rows}), len({r["family"] for r in rows})
    about = (
        f"{len(rows)} voyages of {ships} random ships of {families} families (`bench/fleet`). Wind and a "
        "stream on every voyage, swell on three of five; a third of the ships do not record the wind, "
        "half do not record the sea, none records the stream; instruments with faults of their own; two "
        "to six reference voyages. The hulls' forces are written apart from the twin's, but three forms "
        "are among what the twin can fit: `modulus` is Norrbin's like its core, `strip` is that with "
        "cross-flow drag in strips, and the cubic terms of `mmg` are what its core allows to be missed; "
        "`memory` and `heeling` add to `modulus` and `mmg`, and are left out of a fit together with "
        "them. Weather that is named or told as today's never counts against an answer. Intervals: 95 % "
        "(Wilson). The rows, an answer each, are in [fleet.csv](fleet.csv) and "
        "[new-ships.csv](new-ships.csv), with the facts of each in a file beside it; the last command "
        "makes the page of them:"
    )
    return [
        "# The decision on ships of many forms",
        "",
        *wrap(about, 108),
        "",
        "```sh",
        "python -m bench.fleet run FOLDER --seeds 0-2 --voyages 8 --workers 2     # 80 minutes of two cores",
        "python -m bench.fleet keep FOLDER",
        "python -m bench.fleet run OTHER --seeds 16-18 --voyages 8 --workers 2",
        "python -m bench.fleet keep OTHER --new",
        "python docs/results_page.py",
        "```",
        "",
        *wrap(RIGHT, 108),
    ]


def _figures(rows: Sequence[Row]) -> list[str]:
    near = [there for r in rows for p, there in answer_score.answered_posteriors(r) if 0.85 <= p < 0.95]
    held = [inside for r in rows for _, inside in answer_score.intervals(r)]
    now = figures([decided(r) for r in rows])
    then = {n: s for n, s in figures(rows).items() if s.n}
    body: list[tuple[object, ...]] = [(n, FIGURES[n][0], s, now[n]) for n, s in then.items()]
    body.append(("causes with a posterior of 0.85 to 0.95 that are there", "85 to 95 %", share(near), ""))
    body.append(("95 % intervals of rightly named causes that hold the truth", "90 to 98 %", share(held), ""))
    text = (
        "As answered when they were asked, with the thresholds that were conventions; and decided again from "
        "the same facts by the table of today, three thresholds of which were fitted to these ships. What "
        "that is worth on families left out of the fit stands below."
    )
    return lines("Figures", text, ("", "goal", "as answered", "decided again"), body)


def in_short(s: Share) -> str:
    """k/n; a dash where nothing was asked."""
    return f"{s.k}/{s.n}" if s.n else "-"


def _families(rows: Sequence[Row]) -> list[str]:
    body = []
    for family in sorted({r["family"] for r in rows}):
        own = [r for r in rows if r["family"] == family]
        told, ships = figures(own), len({r["seed"] for r in own})
        body.append([family, ships, *(in_short(told[name]) for name in SHORT.values())])
    return lines("By family", "", ("family", "ships", *SHORT), body)


def _effects(rows: Sequence[Row]) -> list[str]:
    """Single effects: how often right, and what is said otherwise."""
    body = []
    for name in sorted({n for r in rows if r["kind"] in ("single", "outside") for n in r["hidden"]}):
        own = [r for r in rows if list(r["hidden"]) == [name] and r["kind"] in ("single", "outside")]
        marks = share([answer_score.right(r) for r in own])
        gain = share([answer_score.right(r) for r in own if answer_score.gains(r)])
        said = Counter(_said(r) for r in own if not answer_score.right(r)).most_common(5)
        body.append((name, in_short(marks), in_short(gain), ", ".join(f"{w} {k}" for w, k in said)))
    head = ("hidden alone", "right", "right where its oracle gains 10 %", "said otherwise")
    return lines("By effect", "", head, body)


def _said(r: Row) -> str:
    named = [n for n in r["missing"] if n not in OF_THE_VOYAGE]
    return "+".join(named) if named else f"`{r['reason']}`"


def _reliability(rows: Sequence[Row]) -> list[str]:
    told, body = [x for r in rows for x in answer_score.answered_posteriors(r)], []
    for lo, hi in pairwise(BINS):
        own = [(p, there) for p, there in told if lo <= p < hi]
        if own:
            mean = float(np.mean([p for p, _ in own]))
            body.append((f"{lo:.2f} to {hi:.2f}", f"{mean:.2f}", share([there for _, there in own])))
    text = "The posterior of each cause that an answer tells, from 5 % on, and how often the cause is there."
    return lines("Reliability", text, ("told", "mean told", "there"), body)


def _reasons(rows: Sequence[Row]) -> list[str]:
    """Reasons by what is hidden."""
    kinds = ("nothing", "single", "pair", "triple", "outside")
    count = Counter((r["reason"], r["kind"]) for r in rows)
    reasons = [reason for reason, _ in Counter(r["reason"] for r in rows).most_common()]
    body = [(f"`{reason}`", *(count[reason, kind] for kind in kinds)) for reason in reasons]
    return lines("Reasons", "", ("reason", *kinds), body)


def _conformal(rows: Sequence[Row]) -> list[str]:
    """The p-value on healthy voyages, where the ship file had the scores of its references."""
    known, body = [r for r in rows if r.get("p_value") is not None], []
    for calm in (False, True):
        own = [r for r in known if practice(r["family"], r["seed"])[1] == calm]
        healthy = [r for r in own if r["kind"] == "nothing"]
        may = f"{np.mean([r['p_value_at_best'] for r in healthy]):.0%}" if healthy else "-"
        others = _at_least([r for r in own if r["kind"] != "nothing"])
        body.append(("calm days chosen" if calm else "days as they come", may, _at_least(healthy), others))
    text = (
        "Voyages whose p is the least that the ship's two to six references can show. `May be`: how often on "
        "healthy ones, where references and voyage could have come in any order. Days that were chosen for "
        "being calm break that order, and p is then too small."
    )
    head = ("reference voyages", "may be", "healthy voyages", "voyages with something hidden")
    return lines("Conformal p-value", text, head, body) if known else []


def _at_least(rows: Sequence[Row]) -> Share:
    """How often p is the least that the references can show."""
    return share([r["p_value"] <= r["p_value_at_best"] for r in rows])


def cost(rows: Sequence[Row]) -> list[str]:
    """The section on processor time."""
    own, first = [r["cpu_s"] for r in rows], [r["calibration_s"] for r in rows]
    return [
        "",
        "## Cost",
        "",
        f"Processor seconds of a diagnosis: {np.median(own):.0f} in the median, "
        f"{np.percentile(own, 90):.0f} at the 90th percentile, {max(own):.0f} at most; of a calibration: "
        f"{np.median(first):.0f} in the median.",
    ]


def by_hand(path: Path) -> str:
    """What was written by hand at the end of a page that is there: kept when the page is made again."""
    before = path.read_text() if path.exists() else ""
    place = before.find(f"\n{BY_HAND}\n")
    return before[place:] if place >= 0 else ""


def run(args: argparse.Namespace) -> int:
    rows = rows_of(args.folder)
    text = page(rows, json.loads(args.fit.read_text()) if args.fit else None)
    if args.page:
        args.page.write_text(text + by_hand(args.page))
    else:
        print(text)
    if args.json:
        args.json.write_text(
            json.dumps({n: [s.k, s.n, *s.interval()] for n, s in figures(rows).items()}, indent=1)
        )
    return 0

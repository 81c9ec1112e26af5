"""`python -m bench.fleet add FOLDER`: what the owner of each answered voyage does next, `twin add`, and
whether its error falls.

The lasting causes that an answer named are fitted to that voyage and proved on two more voyages of the ship,
with what is hidden in it as it was, on other days and other courses; and, as an owner does who has no more
voyages, on every third of the same voyage in turn. Beside the errors before and after stands that of the same
model on the same two voyages with nothing hidden. A row a voyage is added to FOLDER/additions.jsonl, so that
a run that was ended goes on."""

import argparse
import json
import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

import twin
from bench.fleet.answer_score import causes, share, wrong_names
from bench.fleet.fact_rows import voyage
from bench.fleet.keep_answers import RESULTS
from bench.fleet.kept_rows import digits
from bench.fleet.kept_ships import Job, add_arguments, ask_again, opened
from bench.fleet.voyage_plan import sailed as as_asked
from bench.fleet.voyage_plan import sailed_again
from twin.errors import TwinError
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.study.reference.sailed import sailed
from twin.study.update.adding import ahead, lasting

__all__ = ["add_arguments", "run"]

ADDITIONS = "additions.jsonl"
KEPT_ADDITIONS = RESULTS / "fleet_additions.jsonl"
HELD_OUT = 2  # voyages
PAYS = 0.8  # error of the healthy ship over that before, below which a right name should be accepted


def run(args: argparse.Namespace) -> int:
    """A row a voyage whose answer named a lasting cause; then the table of all that are there."""
    rows = [*ask_again(args.folder, ADDITIONS, _names_a_cause, _of_voyage, args.workers)]
    print("\n".join(table(rows)))
    if args.keep:
        KEPT_ADDITIONS.write_text("".join(json.dumps(_kept(r)) + "\n" for r in rows))
    return 0


def _kept(row: Mapping[str, Any]) -> dict[str, Any]:
    """The row without the numbers of the fit, rounded."""
    short = {k: v for k, v in row.items() if k not in ("numbers", "beside", "cpu_s", "by_thirds")}
    thirds = {k: row["by_thirds"][k] for k in ("accepted", "log_ratio", "failed") if k in row["by_thirds"]}
    kept: dict[str, Any] = digits(short | {"by_thirds": thirds}, 4)
    return kept


def _names_a_cause(row: Mapping[str, Any]) -> bool:
    return bool(causes(lasting(row["missing"])))


def _of_voyage(job: Job) -> dict[str, Any]:
    """What `add` makes of the lasting causes that were named on this voyage."""
    ship, case, model = opened(job)
    row, began = job[1], time.process_time()
    names = lasting(row["missing"])
    out = {
        "key": row["key"],
        "kind": row["kind"],
        "hidden": row["hidden"],
        "names": names,
        "right": not wrong_names({**row, "missing": names}),
    }
    asked = voyage(as_asked(ship, case))
    further, healthy = (
        [voyage(sailed_again(ship, case, k, well)) for k in range(HELD_OUT)] for well in (False, True)
    )
    try:
        proved = twin.add(model, names, asked, held_out=further)
        horizon = proved.data["horizons"][-1]["horizon_s"]
        out |= _said(proved) | {"horizon_s": horizon, "healthy_m": _error(model, healthy, horizon)}
    except TwinError as error:
        out["failed"] = str(error)
    try:
        out["by_thirds"] = _said(twin.add(model, names, asked, cross_validated=True))
    except TwinError as error:
        out["by_thirds"] = {"failed": str(error)}
    return out | {"cpu_s": time.process_time() - began}


def _said(made: twin.Update) -> dict[str, Any]:
    proof = made.data["proof"]
    return {
        "accepted": made.accepted,
        "log_ratio": [proof[k] for k in ("log_likelihood_ratio", "low95", "high95")],
        "before_m": made.error_before_m,
        "after_m": made.error_after_m,
        "numbers": made.data["parameters"],
        "beside": made.data["beside"],
    }


def _error(model: Ship, voyages: Sequence[Any], horizon_s: float) -> float:
    """Mean open-loop position error [m]."""
    windows = ahead([sailed(v, model).track for v in voyages], Model.of(model), [horizon_s])
    return float(np.nanmean(np.concatenate([w.errors()["position"][w.at(horizon_s)] for w in windows])))


def table(rows: Sequence[dict[str, Any]]) -> list[str]:
    """Right and wrong names: how many were accepted, and what became of the error."""
    done = [r for r in rows if "accepted" in r]
    lines = [
        "| names | voyages | accepted | by thirds of one voyage | error after / before | after / healthy |"
    ]
    lines.append("|---|---|---|---|---|---|")
    kinds = {
        "right, a healthy ship is nearer than 0.8 of the error": [r for r in done if r["right"] and _pays(r)],
        "right, else": [r for r in done if r["right"] and not _pays(r)],
        "a name is wrong": [r for r in done if not r["right"] and r["kind"] != "outside"],
        "what is hidden is outside the catalogue": [
            r for r in done if not r["right"] and r["kind"] == "outside"
        ],
    }
    for what, some in kinds.items():
        thirds = [r["by_thirds"]["accepted"] for r in some if "accepted" in r["by_thirds"]]
        fell, near = ([r["after_m"] / r[k] for r in some] for k in ("before_m", "healthy_m"))
        lines.append(
            f"| {what} | {len(some)} | {share([r['accepted'] for r in some])} | {share(thirds)} "
            f"| {_middle(fell)} | {_middle(near)} |"
        )
    failed = [r for r in rows if "failed" in r]
    return [*lines, "", f"Could not be asked: {len(failed)}."]


def _pays(row: dict[str, Any]) -> bool:
    return bool(row["healthy_m"] < PAYS * row["before_m"])


def _middle(ratios: Sequence[float]) -> str:
    if not ratios:
        return "-"
    low, mid, high = np.quantile(ratios, (0.1, 0.5, 0.9))
    return f"{mid:.2f} ({low:.2f} to {high:.2f})"

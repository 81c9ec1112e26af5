"""One ship over its voyages: what is wrong now, since when, and where its size goes."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.special import stdtrit

from twin.recording.timebase import moment_of
from twin.study.estimation.rarity import P95
from twin.study.fleet.ask import Row

MONTH_S = 30.4375 * 86400.0
LEAST_SIZES = 3  # sizes that make a trend
UNANSWERED = "not asked yet"


def voyages_of(asked: Sequence[tuple[str, Mapping[str, str], Sequence[Row]]]) -> list[dict[str, Any]]:
    """A ship's voyages (file, tags and rows each) in the order in which they were sailed, where the files
    tell; else in the order of the list."""
    found = [_voyage(file, tags, rows) for file, tags, rows in asked]
    known = all(v["start_time_utc"] for v in found if not v["failed"])
    when = lambda v: (bool(v["failed"]), moment_of(v["start_time_utc"]))  # noqa: E731
    return sorted(found, key=when) if known else found


def _voyage(file: str, tags: Mapping[str, str], rows: Sequence[Row]) -> dict[str, Any]:
    first = rows[0] if rows else {"failed": UNANSWERED}
    keys = (
        "voyage", "start_time_utc", "duration_s", "verdict", "reason", "sentence", "failed", "p_value",
        "p_value_at_best", "references", "score", "horizon_s", "position_mae_m", "position_expected_m",
    )  # fmt: skip
    causes = [_cause(r) for r in rows if r["effect"] is not None]
    told = {k: first.get(k) for k in keys} | {"data_checks": first.get("data_checks") or []}
    return {"file": file, "tags": dict(tags)} | told | {"causes": causes}


def _cause(row: Row) -> dict[str, Any]:
    keys = ("effect", "named", "lasting", "belongs_to", "probability", "posterior", "says")
    without, with_it = row["error_without_m"], row["error_with_m"]
    share = None if with_it is None or not without else 1.0 - with_it / without
    return {k: row[k] for k in keys} | {
        "share_of_error": share,
        "parameters": row["parameters"],
        "typical_force": {k: row[k] for k in ("X_N", "Y_N", "N_Nm")},
        "cannot_be_told_from": row["cannot_be_told_from"],
    }


def causes_of(voyages: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """What is named on the latest voyage that was judged, each with the voyage since which it is and with its
    sizes over all voyages that weighed it."""
    judged = [v for v in voyages if v["verdict"] not in (None, "reference")]
    named = [c for c in judged[-1]["causes"] if c["named"]] if judged else []
    return [_over_time(c, judged) for c in named]


def _over_time(now: Mapping[str, Any], judged: Sequence[dict[str, Any]]) -> dict[str, Any]:
    effect, number = now["effect"], _telling(now["parameters"])
    weighed = [(i, v, c) for i, v in enumerate(judged) for c in v["causes"] if c["effect"] == effect]
    healthy = max((i for i, v in enumerate(judged) if v["verdict"] == "nothing_missing"), default=-1)
    since = next(v for i, v, c in weighed if i > healthy and c["named"])
    found = [(i, v, c, p) for i, v, c in weighed for p in c["parameters"] if p["name"] == number.get("name")]
    sizes = [{**dated(v), "named": c["named"], **p} for _, v, c, p in found]
    return {k: v for k, v in now.items() if k not in ("parameters", "named")} | {
        "number": number or None,
        "since": dated(since),
        "named_on": sum(c["named"] for *_, c in weighed),
        "of_voyages": len(judged),
        "sizes": sizes,
        "trend": trend(sizes, [i for i, *_ in found]),
    }


def dated(voyage: Mapping[str, Any]) -> dict[str, Any]:
    """Which voyage, and when."""
    return {k: voyage[k] for k in ("voyage", "file", "start_time_utc")}


def _telling(parameters: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The number that stands farthest from "not there" by its own interval."""
    clear = lambda p: abs(p["value"] - (p.get("in_ship_file") or 0.0)) / _sd(p)  # noqa: E731
    return dict(max(parameters, key=clear)) if parameters else {}


def _sd(p: Mapping[str, Any]) -> float:
    """Standard error; the end of a box may cut the interval on one side."""
    return max(p["high95"] - p["value"], p["value"] - p["low95"], 1e-12) / P95


def trend(sizes: Sequence[Mapping[str, Any]], voyages: Sequence[int]) -> dict[str, Any] | None:
    """Slope of a size by weighted least squares with its 95 % interval: a month where the dates span one,
    else a voyage; None of fewer than three sizes. `voyages`: the place of each size's voyage among all of the
    ship.

    Where the sizes scatter more than their intervals, the interval is wider by as much (Birge 1932), by
    Student's t.
    """
    if len(sizes) < LEAST_SIZES:
        return None
    when = np.array([moment_of(s["start_time_utc"]) / MONTH_S for s in sizes])
    dated = all(s["start_time_utc"] for s in sizes) and np.ptp(when) >= 1.0
    x = when if dated else np.array(voyages, float)
    y, w = np.array([s["value"] for s in sizes]), np.array([_sd(s) for s in sizes]) ** -2
    x = x - np.sum(w * x) / np.sum(w)
    spread, mean = float(np.sum(w * x**2)), float(np.sum(w * y) / np.sum(w))
    slope = float(np.sum(w * x * y)) / spread
    birge = float(np.sqrt(np.sum(w * (y - mean - slope * x) ** 2) / (len(sizes) - 2)))
    half = max(1.0, birge) * float(stdtrit(len(sizes) - 2, 0.975)) / spread**0.5
    per = "month" if dated else "voyage"
    return {"slope": slope, "low95": slope - half, "high95": slope + half, "per": per, "voyages": len(sizes)}

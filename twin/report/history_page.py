"""The page of `twin history`: from the calibration to today's ship file, with the error of each step
and what it rests on."""

from collections.abc import Mapping, Sequence
from typing import Any

from twin.num import as_given, num
from twin.physics.ship import Ship
from twin.report.result_page import Bars, PageTable, result_page
from twin.study.update.ladder import ladder

Step = Mapping[str, Any]


def history_page(ship: Ship) -> str:
    """One self-contained HTML page."""
    steps = steps_of(ship)
    errors = [row | {"step": _called(s)} for s in steps for row in s.get("errors", [])]
    last = [_rung(s) for s in steps if s.get("errors")]
    ahead = {row["horizon_s"] for row in last}
    at = f", {as_given(ahead.pop())} s ahead" if len(ahead) == 1 else " at the longest horizon"
    return result_page(
        f"{ship.name}: history of the model",
        sentence(ship),
        _heed(steps),
        (
            Bars(f"Held-out position error{at}", "m", "step", RUNG, last),
            PageTable("Every step", DONE, [_done(s) for s in steps]),
            PageTable("Error of every step, by horizon", ERRORS, errors, given=("horizon_s",)),
            PageTable("Evidence", EVIDENCE, [_evidence(s) for s in steps if "evidence" in s]),
            PageTable("Voyages behind it", VOYAGES, [row for s in steps for row in _voyages(s)]),
        ),
    )


RUNG = {"before_m": "before", "after_m": "after", "noise_floor_m": "expected"}
DONE = {"date": "date", "done": "step", "forced": "forced", "bound": "belongs to a voyage"}
ERRORS = {
    "step": "step",
    "horizon_s": "ahead [s]",
    "before_m": "before [m]",
    "after_m": "after [m]",
    "noise_floor_m": "expected [m]",
    "before_deg": "before [deg]",
    "after_deg": "after [deg]",
}
EVIDENCE = {
    "step": "step",
    "kind": "proof",
    "log_likelihood_ratio": "log likelihood ratio",
    "low95": "95 %, low",
    "high95": "high",
    "needed": "needed",
}
VOYAGES = {"step": "step", "for": "used for", "name": "voyage", "began": "began", "sha256": "sha256"}


def steps_of(ship: Ship) -> list[Step]:
    """The calibration, where there was one, and every step after it, the oldest first."""
    found = ship.notes.get("structural") or {}
    if not found.get("date"):
        return [*ladder(ship)]
    errors = [
        {
            "horizon_s": row["horizon_s"],
            "before_m": row.get("before_m"),
            "after_m": row["position_m"],
            "before_deg": row.get("before_deg"),
            "after_deg": row["heading_deg"],
        }
        for row in found.get("held_out", [])
        if row.get("position_m") is not None
    ]
    calibrated = {"date": found["date"], "calibrated": True, "voyages": found.get("voyages", [])}
    steps: list[Step] = [calibrated | {"errors": errors}, *ladder(ship)]
    return sorted(steps, key=lambda step: str(step.get("date", "")))


def sentence(ship: Ship) -> str:
    """What has become of the error, by the last step that has one."""
    done = ladder(ship)
    if not done:
        return f"{ship.name}: nothing was added or removed yet; the core stands alone."
    many = f"{len(done)} step{'s' * (len(done) > 1)}"
    last = max((k for k, step in enumerate(done) if step.get("errors")), default=None)
    if last is None:
        return f"{ship.name}: {many}, none of which was judged on held-out voyages."
    gone = ", ".join(dict.fromkeys(name for step in done[last + 1 :] for name in step.get("removed", [])))
    e, since = done[last]["errors"][-1], f"{gone} was removed since the last step that was judged: "
    return (
        f"{ship.name}: {many}; {since * bool(gone)}{_called(done[last], dated=False)} brought the error "
        f"{as_given(e['horizon_s'])} s ahead from {num(e['before_m'], 3)} m to {num(e['after_m'], 3)} m, "
        f"where {num(e['noise_floor_m'], 2)} m is expected."
    )


def _heed(steps: Sequence[Step]) -> list[str]:
    if sum(bool(s.get("errors")) for s in steps) < 2:
        return []
    return ["Each step was judged on its own held-out voyages: compare the bars of one step with each other."]


def _called(step: Step, dated: bool = True) -> str:
    """A step in a few words."""
    parts = [
        f"{sign} {', '.join(step[key])}" for sign, key in (("+", "added"), ("−", "removed")) if step.get(key)
    ]
    words = "calibration" if step.get("calibrated") else " and ".join(parts) or str(step.get("what", "?"))
    return f"{step.get('date', '')} {words}".strip() if dated else words


def _rung(step: Step) -> dict[str, Any]:
    return dict(step["errors"][-1]) | {"step": _called(step)}


def _done(step: Step) -> dict[str, Any]:
    bound = ", ".join(step.get("of_this_voyage", []))
    return {
        "date": step.get("date", ""),
        "done": _called(step, dated=False),
        "forced": "yes, without proof" if step.get("forced") else "no",
        "bound": bound or "no",
    }


def _evidence(step: Step) -> dict[str, Any]:
    return dict(step["evidence"]) | {"step": _called(step), "kind": step.get("proof", "")}


def _voyages(step: Step) -> list[dict[str, Any]]:
    return [
        {
            "step": _called(step),
            "for": use,
            "name": str(v.get("name", "")) + (f" ({v['part']})" if v.get("part") else ""),
            "began": v.get("start_time_utc") or "",
            "sha256": str(v.get("sha256") or "")[:16] or "not recorded",
        }
        for use, key in (("fitted on", "voyages"), ("judged on", "held_out"))
        for v in step.get(key, [])
    ]

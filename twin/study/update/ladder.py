"""`twin history`: the ladder of what was added to a ship's model, and how far the error fell each time."""

from typing import Any

from twin.num import as_given, num
from twin.physics.ship import Ship

SCHEMA_VERSION = 1


def ladder(ship: Ship) -> list[dict[str, Any]]:
    """Its steps, the oldest first."""
    return [dict(step) for step in ship.notes.get("history", []) if isinstance(step, dict)]


def terminal_lines(ship: Ship) -> list[str]:
    """The ladder on a terminal."""
    steps = ladder(ship)
    if not steps:
        return [f"{ship.name}: nothing was added or removed yet; the core stands alone."]
    out = [f"{ship.name}: held-out position error [m], before -> after (expected error)"]
    for step in steps:
        done = " and ".join(
            f"{verb} {', '.join(step[key])}"
            for verb, key in (("+", "added"), ("-", "removed"))
            if step.get(key)
        )
        out.append(
            f"{step.get('date', ''):<12}{done or step.get('what', '?')}"
            f"{'   (forced)' * bool(step.get('forced'))}"
        )
        for e in step.get("errors", []):
            out.append(
                f"{'':>12}{as_given(e['horizon_s']):>6} s{num(e['before_m'], 3):>9} -> "
                f"{num(e['after_m'], 3)}  ({num(e['noise_floor_m'], 2)})"
            )
        if step.get("voyages"):
            out.append(
                f"{'':>12}fitted on {_names(step['voyages'])}, judged on {_names(step.get('held_out', []))}"
            )
        if "evidence" in step:
            e = step["evidence"]
            sizes = (
                f"{num(e['log_likelihood_ratio'], 3, sign=True)} ({num(e['low95'], 3)} to "
                f"{num(e['high95'], 3)})"
            )
            out.append(f"{'':>12}proof: {step['proof']}, log likelihood ratio {sizes}")
    return out


def _names(voyages: list[dict[str, Any]]) -> str:
    return ", ".join(
        f"{v['name']}{' (' + v['part'] + ')' if 'part' in v else ''} {str(v.get('sha256', ''))[:8]}"
        for v in voyages
    )

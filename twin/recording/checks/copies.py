"""Two channels that hold the same numbers: one of them was not measured."""

from itertools import combinations

import numpy as np

from twin.live.signals.channels import BY_NAME
from twin.recording.checks.check_result import Check, doubtful, good, wrong
from twin.recording.checks.undo import by_heading
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.units import unit_of

NAME = "copies"
SAME = 0.95  # share of the rows that are alike
LEAST_COPIES = 30
LEAST_TURN_DEG = 20.0
SAME_DEG = 0.03  # course and heading that were rounded apart
MAY_BE = frozenset(("bank_distance_port_m", "bank_distance_starboard_m"))


def copies(view: VoyageView) -> Check:
    """Whether two channels hold the same numbers, or the heading is the course over ground."""
    if text := course_as_heading(view):
        return wrong(NAME, text)
    found = [pair for pair in pairs(view) if identical(view, *pair)]
    if not found:
        return good(NAME, "no two channels hold the same numbers.")
    said = "; ".join(f"{a} and {b}" for a, b in found)
    text = (
        f"{said} hold the same numbers: one of them was copied, not measured. Was one column named twice "
        "in the map?"
    )
    calm = all("through_water" in a + b for a, b in found)  # a simulated ship in no stream
    return doubtful(NAME, text) if calm else wrong(NAME, text)


def pairs(view: VoyageView) -> list[tuple[str, str]]:
    """Two channels of one unit each, both given in the file, that could be copies."""
    derived = view.voyage.meta.get("derived", {})
    constant = view.voyage.meta.get("constant", ())
    names = [
        n
        for n in view.voyage.columns
        if n not in derived and n not in constant and n not in MAY_BE and "." not in n
    ]
    return [(a, b) for a, b in combinations(names, 2) if unit_of(a) == unit_of(b)]


def identical(view: VoyageView, a: str, b: str) -> bool:
    """Whether two channels are alike to the last digit wherever both were read, and both vary."""
    x, y = view.voyage[a], view.voyage[b]
    both = np.isfinite(x) & np.isfinite(y)
    if np.count_nonzero(both) < LEAST_COPIES or np.unique(x[both]).size < 10:
        return False
    apart = np.abs(x[both] - y[both])
    apart = np.minimum(apart, np.abs(apart - 360.0)) if BY_NAME[a].wraps else apart
    return float(np.mean(apart <= 1e-9 * np.maximum(np.abs(x[both]), 1e-9))) > SAME


def course_as_heading(view: VoyageView) -> str:
    """Under way and turning the heading is the course over ground to the last digit: no ship turns without
    drift."""
    v = view.voyage
    if view.derived("surge_velocity_mps") or not by_heading(v) or not view.way_on:
        return ""
    u, w = v["surge_velocity_mps"], v["sway_velocity_mps"]
    moving = np.isfinite(u) & np.isfinite(w) & (np.hypot(u, w) > 0.4 * view.speed)
    swung = np.degrees(np.ptp(view.psi[np.isfinite(view.psi)]))
    if np.count_nonzero(moving) < LEAST_COPIES or swung < LEAST_TURN_DEG:
        return ""
    drift = np.abs(np.degrees(np.arctan2(w[moving], u[moving])))
    if float(np.mean(drift < SAME_DEG)) < SAME:
        return ""
    return (
        f"the heading is the course over ground in {100 * np.mean(drift < SAME_DEG):.0f} % of the rows, "
        f"to the last digit, while it turns by {swung:.0f} deg: "
        "the column holds the course, no compass. Give the compass, or the voyage has no heading."
    )

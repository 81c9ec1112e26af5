"""When a cause acted that was not there all the time, in words."""

from collections.abc import Sequence
from typing import Any

from twin.num import clock
from twin.study.diagnosis.overtime import changes

ACTS = 0.5  # share of its greatest size from which it counts as acting


def acting(parts: Sequence[dict[str, Any]]) -> str:
    """Of one voyage, part by part (`overtime.over_time`): whether it began, ended, or did both. "comes and
    goes" where it did so more than once, or where no part shows clearly less than another."""
    acts = [p["share"] >= ACTS * max(q["share"] for q in parts) for p in parts]
    runs = sum(b and not a for a, b in zip([False, *acts], acts, strict=False))
    if runs != 1 or all(acts) or len({p["voyage"] for p in parts}) > 1 or not changes(parts):
        return "comes and goes"
    first, last = acts.index(True), len(acts) - 1 - acts[::-1].index(True)
    begins, ends = (clock(parts[i][key]) for i, key in ((first, "start_s"), (last, "end_s")))
    if first == 0:
        return f"acts until about {ends}, and no longer after it"
    if last == len(parts) - 1:
        return f"acts from about {begins} on, and not before"
    return f"acts from about {begins} to {ends}, and not before or after"

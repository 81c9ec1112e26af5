"""Why a cause is named although none of its numbers is sure, and why one that is likely is not: the words of
each reason of the decision."""

from typing import Any

from twin.num import num, percent
from twin.study.diagnosis.criteria import CERTAIN, SIGNIFICANT, USUAL

Result = dict[str, Any]
ROUGHLY = "in weather like this, whose force is known only roughly, that may be the weather's effect"


def why_not(c: Result, reason: str) -> str:
    """Why what is likely is not named: the words of each reason of the decision."""
    none = "what the ship file has" if any("in_ship_file" in p for p in c["parameters"]) else "none"
    with_it = (
        f"{num(c['error_with'], 3)} m with it, {num(c['error_without'], 3)} m without"
        if c["error_with"] is not None
        else "not computed"
    )
    return {
        "not_in_explanation": "the likeliest explanation of where the ship went does without it, or there "
        "is none",
        "as_on_references": "single causes explained as much of healthy reference voyages of this ship"
        if (c.get("on_references") or 0.0) < USUAL
        else "the instruments, held against each other without the ship, show no more of it than on the "
        "reference voyages (twin instruments tells what they show)",
        "unlikely": f"such an answer was true on {percent(c['probability'])} of random ships, not often "
        "enough to name it",
        "not_significant": f"all its numbers together are less than {num(SIGNIFICANT, 1)} standard "
        f"deviations from {none}, as those of sound instruments are now and then",
        "change_within_form": "what changed is no clear gain by itself, or no more than the form that the "
        "ship file has of it may be wrong by",
        "no_nearer": "with the other effects alone, or with fewer of them, the open-loop error is as small "
        f"({num(c['error_with'], 3)} m with it)"
        if nearer(c)
        else f"adding it does not reduce the open-loop error ({with_it})",
        "weather_may_mislead": ROUGHLY,
        "comes_and_goes": "what acts like it comes and goes, and it would act all the time",
        "second_not_sure": f"a second cause needs {100.0 * CERTAIN:.0f} %: it may only be correcting an "
        "error in the form of the first",
    }[reason]


def only_together(c: Result) -> str:
    """Why a cause is named although none of its numbers is sure by itself."""
    same = "what the ship file has" if any("in_ship_file" in p for p in c["parameters"]) else "none"
    return (
        f"each of its numbers alone may be {same}, for its 95 % interval holds that; all together are "
        f"{num(c['together_sd'])} standard deviations from it, so that it is named"
    )


def nearer(candidate: Result) -> bool:
    """Whether the open-loop error is smaller with this effect than without any."""
    return candidate["error_with"] is not None and bool(candidate["error_with"] < candidate["error_without"])

"""What the p-value of a diagnosis means, in words an owner can act on (the number: reference/healthy.py)."""

from collections.abc import Sequence
from typing import Any

from twin.num import num
from twin.study.reference.healthy import Healthy

UNCALIBRATED = (
    "careful: this ship was never calibrated, so that what is missing may be no more than its first "
    "estimates, and every size is rough. Calibrate it first."
)
ONE_IN = 20  # healthy voyages, one of which is rare: the 95 % of every interval


def rarity(found: Healthy | None) -> dict[str, Any]:
    """How rare the voyages would be in health, as JSON has it."""
    return {
        "p_value": found.p if found else None,
        "p_value_at_best": found.at_best if found else None,
        "p_value_references": found.references if found else 0,
        "p_value_score": found.score if found else None,
    }


def since_in_words(causes: Sequence[str]) -> list[str]:
    """That the ship file is older than these causes or some of their numbers, and what that means."""
    if not causes:
        return []
    were, them, are = ("was", "it", "it is") if len(causes) == 1 else ("were", "them", "they are")
    return [
        f"The ship file was calibrated when {', '.join(causes)} {were} not known, or not with all numbers: "
        f"what healthy voyages of this ship show of {them} is not in it, and {are} named less surely. "
        "Calibrate again."
    ]


def healthy_in_words(result: dict[str, Any]) -> str:
    """Whether the voyages are more unusual than this ship's healthy ones, and how many more of these would be
    needed to tell."""
    if result.get("p_value") is None:
        if not result["calibrated"]:
            return UNCALIBRATED
        return (
            "Against healthy voyages: not computed, for the ship file has no scores of reference voyages: "
            "twin calibrate keeps them, of two or more."
        )
    count, asked = result["p_value_references"], len(result["voyages"])
    reach, p = round(count * result["facts"]["reached"]), num(result["p_value"])
    this = "this one" if asked == 1 else f"the most unusual of these {asked}"
    if reach:
        return (
            f"Against healthy voyages: {reach} of this ship's {count} reference voyages, with nothing wrong, "
            f"{'was' if reach == 1 else 'were'} as unusual as {this} (p = {p})."
        )
    return (
        f"Against healthy voyages: {this} is more unusual than each of this ship's {count} reference voyages "
        f"(p = {p}). {_by_chance(count, asked)}"
    )


def _by_chance(count: int, asked: int) -> str:
    """How often healthy voyages are so, and how many more references could show that these are not."""
    often = f"one healthy voyage in {count + 1} is so by chance"
    if asked > 1:
        most = min(asked, count + 1)
        often = f"of {asked} healthy voyages one is so by chance in up to {most} of {count + 1} cases"
    more = ONE_IN * asked - 1 - count
    if more <= 0:
        return f"At most {often}." if asked == 1 else f"{often.capitalize()}."
    return (
        f"With {count} of them that shows little: {often}. {more} more reference "
        f"voyage{'s' * (more > 1)} could show that it is as rare as one in {ONE_IN}."
    )

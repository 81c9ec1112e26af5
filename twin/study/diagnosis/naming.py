"""Which effects may be named, and why another is not: one ordered table of rules over the facts of a cause,
first hit wins."""

from collections.abc import Callable
from dataclasses import dataclass

from twin.num import num, percent
from twin.study.diagnosis import criteria
from twin.study.diagnosis.facts import Cause, Facts


@dataclass(frozen=True)
class CauseRule:
    """One row: if the condition holds, this cause is not named, for this reason (in words: reasons.py)."""

    reason: str
    condition: Callable[[Facts, Cause], bool]
    when: str  # the condition in words


def missed(f: Facts) -> bool:
    """Whether the model with the day's weather leads the ship clearly farther from where it went than
    expected."""
    return f.error_nothing > criteria.NEARLY


def weather_named(f: Facts) -> tuple[str, ...]:
    """Water and weather that the model lacks: clearly there, beyond what the references felt, and the path
    is nearer with it. (What the model has is never lacking: another day's wind shows what its form misses,
    and is told as today's.)"""
    ones = (c for c in f.weather if c.effect not in f.as_before and not c.in_ship_file)
    return tuple(c.effect for c in ones if c.sea_force or not c.in_explanation or _nearer(c))


FITFUL = "comes_and_goes"  # of what acts like a cause, but not all the time
CAUSE_RULES: tuple[CauseRule, ...] = (  # why an effect is not named, first hit wins
    CauseRule(
        "not_in_explanation",
        lambda f, c: not c.in_explanation and not _by_readings_alone(f, c),
        "it is no part of the explanation; where nothing explains where the ship went, an instrument of the "
        "likeliest hypothesis may be named all the same, for it disagrees with the others wherever that is",
    ),
    CauseRule(
        "as_on_references",
        lambda f, c: max(f.reached or 0.0, c.reached or 0.0) >= criteria.USUAL,
        f"{percent(criteria.USUAL)} or more of the reference voyages, each left out in turn, were "
        "explained as much by a single cause or, of an instrument, are as far from the others by kinematics "
        "(section 5)",
    ),
    CauseRule(
        "unlikely",
        lambda f, c: (
            c.probability < criteria.LOST
            or (c.probability < criteria.NAMED and c.with_rivals < criteria.CERTAIN)
        ),
        f"its probability is below {percent(criteria.NAMED)}, and the probability that it is there, or "
        f"one of those which these voyages cannot tell from it, is below {percent(criteria.CERTAIN)}; or it "
        f"is not likelier than not ({percent(criteria.LOST)})",
    ),
    CauseRule(
        "change_within_form",
        lambda f, c: c.in_ship_file and (c.alone <= criteria.CLEAR or c.change <= criteria.CHANGED),
        "the ship file has it, and a change of it alone is no clear gain (log odds, those beforehand among "
        f"them, at most {num(criteria.CLEAR)}), or changes none of its numbers by more than "
        f"{num(criteria.CHANGED)} standard deviations of its form",
    ),
    CauseRule(
        "not_significant",
        lambda f, c: c.belongs_to == "instrument" and c.significance <= criteria.SIGNIFICANT,
        f"it belongs to an instrument, and its numbers are within {num(criteria.SIGNIFICANT)} standard "
        "deviations of none",
    ),
    CauseRule(
        "no_nearer",
        lambda f, c: c.belongs_to != "instrument" and not _nearer(c) and not _too_small(f, c),
        "it belongs to no instrument and reduces the open-loop error by less than "
        f"{percent(criteria.BETTER)}; "
        f"this is not asked of a single cause with a probability of {percent(criteria.SURE)} or more "
        "that is too "
        "small to show there (the error is no more than expected without it, and with it)",
    ),
    CauseRule(
        "weather_may_mislead",
        lambda f, c: c.belongs_to != "instrument" and f.sea and not missed(f),
        "it belongs to no instrument, a sea was measured that may move the ship, and without any cause the "
        f"model leaves no more than {num(criteria.NEARLY, 3)} times the expected error",
    ),
    CauseRule(
        FITFUL,
        lambda f, c: 1.0 - f.lasts(c) >= criteria.CERTAIN,
        "it belongs to the ship, and with a probability of "
        f"{percent(criteria.CERTAIN)} or more the force of such causes of the explanation comes and goes, or "
        "its size is another in each part of a voyage",
    ),
)
SECOND_NOT_SURE = "second_not_sure"  # of what might be named were it the only one
SECOND_WHEN = (
    "none of these holds, but another cause that may be named explains more alone, and the probability of "
    f"this one is below {percent(criteria.CERTAIN)}"
)


def _by_readings_alone(f: Facts, c: Cause) -> bool:
    """Whether nothing explains where the ship went, and this is an instrument that disagrees with the others:
    what moves the ship does not speak against it."""
    return not f.explanation and c.belongs_to == "instrument" and c.effect in f.likeliest


def _nearer(c: Cause) -> bool:
    return c.error_gain is None or c.error_gain >= criteria.BETTER


def _too_small(f: Facts, c: Cause) -> bool:
    """Whether a single effect cannot show in where it went, for the model ends there with it and without:
    then the readings decide."""
    alone = f.explanation == f.likeliest and [x.effect for x in f.causes if x.in_explanation] == [c.effect]
    return (
        alone
        and f.error_nothing <= 1.0
        and f.left.error is not None
        and f.left.error <= 1.0
        and c.probability >= criteria.SURE
    )


def why_not(f: Facts, c: Cause) -> str | None:
    """Why a cause may not be named: the first rule that applies; None where none does."""
    return next((rule.reason for rule in CAUSE_RULES if rule.condition(f, c)), None)


def fitful(f: Facts) -> bool:
    """Whether a cause is not named for this alone, that its force comes and goes."""
    return any(why_not(f, c) == FITFUL for c in f.causes)


def named(f: Facts) -> tuple[str, ...]:
    """The effects that may be named: the one that explains most alone first, a second only if it is nearly
    certain."""
    ones = sorted((c for c in f.causes if why_not(f, c) is None), key=lambda c: -c.alone)
    return tuple(c.effect for i, c in enumerate(ones) if i == 0 or c.probability >= criteria.CERTAIN)

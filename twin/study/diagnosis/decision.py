"""The decision: one ordered table of rules over the facts (facts.py), first hit wins. The sentence stands in
the rule that decided.

Which effects it may name: naming.py. Every number that decides: criteria.py. Each row says in words when it
holds; the tables in docs/diagnosis.md are made of that (docs/decision_page.py).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from twin.num import num, percent
from twin.study.diagnosis import criteria
from twin.study.diagnosis import sentences as say
from twin.study.diagnosis.facts import Facts, Left
from twin.study.diagnosis.naming import FITFUL, SECOND_NOT_SURE, fitful, missed, named, weather_named, why_not


@dataclass(frozen=True)
class Rule:
    """One row: if the condition holds, this is the verdict, for this reason, in this sentence."""

    reason: str
    condition: Callable[[Facts], bool]
    verdict: str
    sentence: Callable[[dict[str, Any]], str]
    when: str  # the condition in words


@dataclass(frozen=True)
class Decision:
    """Verdict, reason, the effects to name (the one that explains most first), and why each other likely one
    is not named."""

    verdict: str
    reason: str
    missing: tuple[str, ...]
    not_named: dict[str, str]
    more: bool  # whether something more is missing: the answer leaves clearly more than is expected of it
    sentence: Callable[[dict[str, Any]], str]


def explained(left: Left) -> bool:
    """Whether no clearly larger error is left than a true hypothesis would leave, or less than half of what
    there was without it."""
    if left.error is None or left.share is None:
        return False
    return left.error <= criteria.NEARLY or left.share <= criteria.MOSTLY


def is_explained(f: Facts) -> bool:
    """Whether nothing is left to be explained: no cause and no weather is asked for, or what is asked for
    leaves no more than it may."""
    return not f.likeliest or (bool(f.explanation) and explained(f.left))


def nameless(f: Facts) -> bool:
    """Whether something is at work that has no name, or that the best explanation leaves over; beside an
    instrument that is named it is said to be missing, too (`Decision.more`)."""
    return likely_without_name(f) or not (is_explained(f) or instrument_alone(f))


def likely_without_name(f: Facts) -> bool:
    """Whether it is likelier than not that something without a name acts."""
    return f.unknown >= criteria.LOST


def instrument_alone(f: Facts) -> bool:
    """Whether an instrument is named although nothing explains where the ship went."""
    return not f.explanation and bool(named(f))


def lacks_weather(f: Facts) -> bool:
    """Whether the model lacks water or weather of these voyages, and no cause can be named."""
    return bool(weather_named(f)) and not named(f)


def in_order(f: Facts) -> bool:
    """Whether no cause of ship and instruments is missing, on voyages that would have shown most and were no
    rougher than the references."""
    return f.nothing >= criteria.SURE and f.power >= criteria.POWER and not missed(f) and not restless(f)


def restless(f: Facts) -> bool:
    """Whether these voyages hold clearly more that no effect explains than the references did."""
    return f.left.restless >= criteria.CLEAR


def pushed(f: Facts) -> bool:
    """Whether something pushed the ship for a while, and not before or after."""
    return f.transient > 0.0


VERDICTS = {  # and what each says
    "missing": "The model lacks the named effects, or what it has of them has changed.",
    "nothing_missing": "The voyages would have shown most causes at a plausible size, and show none.",
    "unknown": "Something is missing, and no effect of the catalogue that could be named explains it.",
    "undecided": "These voyages cannot tell; the reason says why, and often what to sail next.",
}
UNEXPLAINED, PUSH, FITS, SEA = (
    "something is unexplained",
    "a stretch had a push of its own",
    "what acts like a cause comes and goes, and no cause may be named",
    "a sea was measured that may move the ship",
)
RULES: tuple[Rule, ...] = (
    Rule(
        "no_manoeuvre",
        lambda f: not f.manoeuvre,
        "undecided",
        say.no_manoeuvre,
        "no voyage holds a manoeuvre",
    ),
    Rule(
        "weather_may_mislead",
        lambda f: nameless(f) and f.sea,
        "undecided",
        say.weather,
        f"{UNEXPLAINED}, and {SEA}",
    ),
    Rule(
        "resembles",
        lambda f: nameless(f) and bool(f.resembles),
        "unknown",
        say.resembles,
        f"{UNEXPLAINED}, and an effect that is known by its form alone is likely",
    ),
    Rule(
        "as_near_as_usual",
        lambda f: nameless(f) and not missed(f),
        "undecided",
        say.as_near,
        f"{UNEXPLAINED}, but the model with the day's weather leaves no more than {num(criteria.NEARLY, 3)} "
        "times the expected error",
    ),
    Rule(
        "pushed",
        lambda f: nameless(f) and pushed(f),
        "unknown",
        say.pushed,
        f"{UNEXPLAINED}, and {PUSH}",
    ),
    Rule(
        "unexplained",
        lambda f: nameless(f) and likely_without_name(f),
        "unknown",
        say.unexplained,
        f"{UNEXPLAINED}, and something without a name is likelier than not",
    ),
    Rule(
        "still_astray",
        nameless,
        "undecided",
        say.still_astray,
        f"{UNEXPLAINED}, and nothing says that it has no name",
    ),
    Rule(
        "pushed_in_weather",
        lambda f: pushed(f) and not named(f) and f.sea,
        "undecided",
        say.pushed_in_weather,
        f"{PUSH}, no cause may be named, and {SEA}",
    ),
    Rule(
        "pushed",
        lambda f: pushed(f) and not named(f),
        "unknown",
        say.pushed,
        f"{PUSH}, and no cause may be named",
    ),
    Rule(
        "weather_may_mislead",
        lambda f: fitful(f) and not named(f) and f.sea,
        "undecided",
        say.weather,
        f"{FITS}, and {SEA}",
    ),
    Rule(
        FITFUL,
        lambda f: fitful(f) and not named(f),
        "unknown",
        say.comes_and_goes,
        FITS,
    ),
    Rule(
        "weather_only",
        lambda f: in_order(f) and lacks_weather(f),
        "missing",
        say.weather_only,
        "ship and instruments are in order, and the model lacks water or weather of these voyages",
    ),
    Rule(
        "weather",
        lambda f: lacks_weather(f),
        "missing",
        say.weather_at_least,
        "the model lacks water or weather of these voyages, and no cause may be named",
    ),
    Rule(
        "nothing",
        lambda f: in_order(f),
        "nothing_missing",
        say.nothing,
        "ship and instruments are in order",
    ),
    Rule("named", lambda f: bool(named(f)), "missing", say.named, "a cause may be named"),
    Rule(
        "one_of",
        lambda f: bool(f.one_of),
        "undecided",
        say.one_of,
        f"one of a few causes is there (probability {percent(criteria.CERTAIN)} or more), none of them "
        "likely "
        "enough to be named",
    ),
    Rule(
        "not_named",
        lambda f: any(c.probability >= criteria.SURE for c in f.causes),
        "undecided",
        say.not_named,
        f"a cause has a probability of {percent(criteria.SURE)} or more, but may not be named: "
        "`answer.not_named`",
    ),
    Rule(
        "astray",
        lambda f: f.nothing >= criteria.SURE and missed(f),
        "undecided",
        say.astray,
        f"no cause is missing (probability {percent(criteria.SURE)} or more), but the model leaves more than "
        f"{num(criteria.NEARLY, 3)} times the expected error",
    ),
    Rule(
        "restless",
        lambda f: f.nothing >= criteria.SURE and restless(f),
        "undecided",
        say.restless,
        f"no cause is missing (probability {percent(criteria.SURE)} or more), but the voyages hold more that "
        f"no effect explains than the references did (log odds {num(criteria.CLEAR)} or more)",
    ),
    Rule(
        "no_power",
        lambda f: f.nothing >= criteria.SURE,
        "undecided",
        say.no_power,
        f"no cause is missing (probability {percent(criteria.SURE)} or more), but fewer than "
        f"{percent(criteria.POWER)} of the causes would have shown",
    ),
    Rule("cannot_tell", lambda f: True, "undecided", say.cannot_tell, "none of these"),
)


def decide(f: Facts) -> Decision:
    """The first rule whose condition holds."""
    rule = next(r for r in RULES if r.condition(f))
    missing = (*named(f), *weather_named(f)) if rule.verdict == "missing" else ()
    why = {c.effect: why_not(f, c) for c in f.causes if c.effect not in missing}
    others = {
        c.effect: why[c.effect] or SECOND_NOT_SURE
        for c in f.causes
        if c.effect in why and (c.probability >= criteria.SURE or why[c.effect] == FITFUL)
    }
    more = rule.verdict == "missing" and f.left.error is not None and f.left.error > criteria.NEARLY
    return Decision(rule.verdict, rule.reason, missing, others, more, rule.sentence)

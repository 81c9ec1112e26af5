"""The decision: one ordered table of rules over the facts (facts.py), first hit wins. The sentence stands in
the rule that decided.

Every number that decides stands in the table of constants below, with its unit and the question it answers.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from twin.study.diagnosis import sentences as say
from twin.study.diagnosis.facts import Cause, Facts, Left

# probabilities [1]: NAMED, SIGNIFICANT and USUAL were fitted with families of ships held out (bench/fleet,
# docs/results/judgement.md); the others are conventions that no family asked to move
NAMED = 0.9  # from which a cause is named
SURE = 0.8  # from which weather is told, a likely cause is asked about, or nothing said to be missing
CERTAIN = 0.9  # of a second cause, or of one of a group: of two rough forms one may mend the other
LOST = 0.5  # of something without a name, from which no name is given: likelier than not
# log Bayes factor
CLEAR = 3.0  # 20 to 1 (Kass & Raftery 1995): a change is asked for, two effects are told apart
# ratios of open-loop errors [1]
NEARLY = 1.5  # over the expected one: healthy voyages of one ship scatter by 40 %
MOSTLY = 0.5  # of the error without it: what takes away more than half explains, though more is missing
BETTER = 0.05  # share by which a force must bring the ship nearer to where it went; less is scatter
# others
SIGNIFICANT = 5.0  # standard deviations of an instrument's clearest number from none (fitted: 4 to 6)
CHANGED = (
    2.0  # standard deviations of its form by which a number must differ from what the ship's file has (95 %)
)
# share of the reference voyages that reach a voyage's score, or an instrument's distance by kinematics, from
# which it is no news
USUAL = 0.25
POWER = 0.75  # share of the causes that must have shown before nothing is said to be missing


@dataclass(frozen=True)
class Rule:
    """One row: if the condition holds, this is the verdict, for this reason, in this sentence."""

    reason: str
    condition: Callable[[Facts], bool]
    verdict: str
    sentence: Callable[[dict[str, Any]], str]


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
    return (
        left.error is not None and left.share is not None and (left.error <= NEARLY or left.share <= MOSTLY)
    )


def is_explained(f: Facts) -> bool:
    """Whether nothing is left to be explained: no cause and no weather is asked for, or what is asked for
    leaves no more than it may."""
    return not f.likeliest or (bool(f.explanation) and explained(f.left))


def missed(f: Facts) -> bool:
    """Whether the model with the day's weather leads the ship clearly farther from where it went than
    expected."""
    return f.error_nothing > NEARLY


def nameless(f: Facts) -> bool:
    """Whether something is at work that has no name, or that the best explanation leaves over."""
    return f.unknown >= LOST or not is_explained(f)


def weather_named(f: Facts) -> tuple[str, ...]:
    """Water and weather that the model lacks: clearly there, beyond what the references felt, and the path
    is nearer with it. (What the model has is never lacking: another day's wind shows what its form misses,
    and is told as today's.)"""
    ones = (c for c in f.weather if c.effect not in f.as_before and not c.in_ship_file)
    return tuple(c.effect for c in ones if c.sea_force or not c.in_explanation or _nearer(c))


def lacks_weather(f: Facts) -> bool:
    """Whether the model lacks water or weather of these voyages, and no cause can be named."""
    return bool(weather_named(f)) and not named(f)


def in_order(f: Facts) -> bool:
    """Whether no cause of ship and instruments is missing, on voyages that would have shown most."""
    return f.nothing >= SURE and f.power >= POWER and not missed(f)


def pushed(f: Facts) -> bool:
    return f.transient > 0.0


CAUSE_RULES: tuple[
    tuple[str, Callable[[Facts, Cause], bool]], ...
] = (  # why an effect is not named, first hit wins
    ("not_in_explanation", lambda f, c: not c.in_explanation),
    ("as_on_references", lambda f, c: max(f.reached or 0.0, c.reached or 0.0) >= USUAL),
    ("unlikely", lambda f, c: c.probability < NAMED and c.with_rivals < CERTAIN),
    ("change_within_form", lambda f, c: c.in_ship_file and (c.alone <= CLEAR or c.change <= CHANGED)),
    ("not_significant", lambda f, c: c.belongs_to == "instrument" and c.significance <= SIGNIFICANT),
    ("no_nearer", lambda f, c: c.belongs_to != "instrument" and not _nearer(c) and not _too_small(f, c)),
    ("weather_may_mislead", lambda f, c: c.belongs_to != "instrument" and f.sea and not missed(f)),
)


def _nearer(c: Cause) -> bool:
    return c.error_gain is None or c.error_gain >= BETTER


def _too_small(f: Facts, c: Cause) -> bool:
    """Whether a single effect cannot show in where it went, for it is led there with it and without: then
    the readings decide."""
    alone = f.explanation == f.likeliest and [x.effect for x in f.causes if x.in_explanation] == [c.effect]
    return (
        alone
        and f.error_nothing <= 1.0
        and f.left.error is not None
        and f.left.error <= 1.0
        and c.probability >= SURE
    )


def why_not(f: Facts, c: Cause) -> str | None:
    return next((reason for reason, holds in CAUSE_RULES if holds(f, c)), None)


def named(f: Facts) -> tuple[str, ...]:
    """The effects that may be named: the one that explains most alone first, a second only if it is nearly
    certain."""
    ones = sorted((c for c in f.causes if why_not(f, c) is None), key=lambda c: -c.alone)
    return tuple(c.effect for i, c in enumerate(ones) if i == 0 or c.probability >= CERTAIN)


RULES: tuple[Rule, ...] = (
    Rule("no_manoeuvre", lambda f: not f.manoeuvre, "undecided", say.no_manoeuvre),
    Rule("weather_may_mislead", lambda f: nameless(f) and f.sea, "undecided", say.weather),
    Rule("resembles", lambda f: nameless(f) and bool(f.resembles), "unknown", say.resembles),
    Rule("as_near_as_usual", lambda f: nameless(f) and not missed(f), "undecided", say.as_near),
    Rule("pushed", lambda f: nameless(f) and pushed(f), "unknown", say.pushed),
    Rule("unexplained", nameless, "unknown", say.unexplained),
    Rule(
        "pushed_in_weather",
        lambda f: pushed(f) and not named(f) and f.sea,
        "undecided",
        say.pushed_in_weather,
    ),
    Rule("pushed", lambda f: pushed(f) and not named(f), "unknown", say.pushed),
    Rule("weather_only", lambda f: in_order(f) and lacks_weather(f), "missing", say.weather_only),
    Rule("weather", lambda f: lacks_weather(f), "missing", say.weather_at_least),
    Rule("nothing", lambda f: in_order(f), "nothing_missing", say.nothing),
    Rule("named", lambda f: bool(named(f)), "missing", say.named),
    Rule("one_of", lambda f: bool(f.one_of), "undecided", say.one_of),
    Rule("not_named", lambda f: any(c.probability >= SURE for c in f.causes), "undecided", say.not_named),
    Rule("astray", lambda f: f.nothing >= SURE and missed(f), "undecided", say.astray),
    Rule("no_power", lambda f: f.nothing >= SURE, "undecided", say.no_power),
    Rule("cannot_tell", lambda f: True, "undecided", say.cannot_tell),
)


def decide(f: Facts) -> Decision:
    """The first rule whose condition holds."""
    rule = next(r for r in RULES if r.condition(f))
    missing = (*named(f), *weather_named(f)) if rule.verdict == "missing" else ()
    others = {
        c.effect: why_not(f, c) or "second_not_sure"
        for c in f.causes
        if c.effect not in missing and c.probability >= SURE
    }
    more = rule.verdict == "missing" and f.left.error is not None and f.left.error > NEARLY
    return Decision(rule.verdict, rule.reason, missing, others, more, rule.sentence)

"""The figures of a fleet's answers: of which voyages, and what is counted."""

from collections.abc import Callable, Sequence

from bench.fleet import answer_score
from bench.fleet.answer_score import Row, Share, share


def _of(*kinds: str) -> Callable[[Row], bool]:
    """Which rows are of these kinds (answer_score.kind)."""
    return lambda r: answer_score.kind(r) in kinds


def _named(r: Row) -> bool:
    return bool(answer_score.causes(r["missing"]))


def _wrong(r: Row) -> bool:
    return bool(answer_score.wrong_names(r))


def _single(of_weather: bool) -> Callable[[Row], bool]:
    """Which single causes that gain are weather, or none."""
    return lambda r: (
        r["kind"] == "single" and answer_score.gains(r) and answer_score.of_weather(r) == of_weather
    )


SINGLE, SINGLE_GAINS = "single cause named, alone and right", "the same where its oracle gains 10 % or more"
ALARM, PAIR = "healthy voyages with an alarm (a cause named, or `unknown`)", "two causes, both named"
OUTSIDE = "outside the catalogue: `unknown`, or undecided without a name"
FIGURES: dict[
    str, tuple[str, Callable[[Row], bool], Callable[[Row], bool]]
] = {  # goal, which rows, what is counted
    SINGLE: ("", _of("single"), answer_score.right),
    SINGLE_GAINS: (
        ">= 90 %",
        lambda r: r["kind"] == "single" and answer_score.gains(r),
        answer_score.right,
    ),
    "of these, causes of ship and instruments": ("", _single(of_weather=False), answer_score.right),
    "of these, water and weather, named or told as today's": (
        "",
        _single(of_weather=True),
        answer_score.right,
    ),
    "a wrong name beside or in its place": ("", _of("single"), _wrong),
    ALARM: ("<= 2 %", _of("nothing"), answer_score.alarm),
    "healthy voyages on which a cause is named": ("", _of("nothing"), _named),
    PAIR: (">= 85 %", _of("pair"), answer_score.right),
    "two causes, both named, where their oracle gains 10 %": (
        "",
        lambda r: r["kind"] == "pair" and answer_score.gains(r),
        answer_score.right,
    ),
    "two causes of ship and instruments, each of which gains 10 %, the other known": (
        "",
        lambda r: r["kind"] == "pair" and answer_score.each_gains(r),
        answer_score.right,
    ),
    "three causes, all named": (">= 70 %", _of("triple"), answer_score.right),
    "three causes of ship and instruments, each of which gains 10 %, the others known": (
        "",
        lambda r: r["kind"] == "triple" and answer_score.each_gains(r),
        answer_score.right,
    ),
    OUTSIDE: (">= 85 %", _of("outside"), answer_score.right),
    "the same where the model ends clearly astray": (
        "",
        lambda r: answer_score.kind(r) == "outside" and answer_score.astray(r),
        answer_score.right,
    ),
    "outside the catalogue: a name is given": ("<= 15 %", _of("outside"), _named),
    "outside the catalogue when the fleet was made, by now in it: named right": (
        "",
        _of("by now"),
        answer_score.right,
    ),
}


def figures(rows: Sequence[Row]) -> dict[str, Share]:
    return {name: share([what(r) for r in rows if which(r)]) for name, (_, which, what) in FIGURES.items()}


SHORT = {
    "single, gains": SINGLE_GAINS,
    "single, all": SINGLE,
    "healthy, alarm": ALARM,
    "pair": PAIR,
    "outside": OUTSIDE,
}

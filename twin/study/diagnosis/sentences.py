"""The sentence of each rule of the decision, from the result as JSON has it: what one would say on the
bridge."""

from typing import Any

from twin.num import clock, num, percent
from twin.study.diagnosis.acting import acting
from twin.study.diagnosis.criteria import POWER
from twin.study.diagnosis.force_in_words import force
from twin.study.diagnosis.reasons import ROUGHLY, nearer, why_not

Result = dict[str, Any]
SMALL = "The open-loop error of these voyages does not fall with it: `twin add` may ask for more voyages."
ANY_NEARER = 0.9  # share of an open-loop error above which it is said to have hardly fallen
PROBABLY = 0.75  # probability below which a cause is said to be missing probably


def named(result: Result) -> str:
    """Effects are named, with their force and what cannot be told from them."""
    names = [n for n in result["missing"] if not _is_weather(result, n)]
    first, said = by_name(result)[names[0]], [_said(result, n) for n in names]
    what = said[0] if len(said) == 1 else " ".join(f"{n}: {s}" for n, s in zip(names, said, strict=True))
    small = f" {SMALL}" if force(first["typical_force"]) and len(names) == 1 and not nearer(first) else ""
    more = "".join(
        f" Something like {c['effect']} ({percent(c['probability'])}) may act beside it, or it acts in "
        "another form than the catalogue's."
        for c in result["resembles"]
    )
    return (
        f"{_how_likely(result, names)}: {' and '.join(likely(result, n) for n in names)}. "
        f"{what}{small}{further_in_words(result, names)}{more}{_more(result)}"
    )


def _how_likely(result: Result, names: list[str]) -> str:
    """How such an answer is begun, by the least likely of the names."""
    least = min(by_name(result)[n]["probability"] for n in names)
    return "Missing" if least >= PROBABLY else "Probably missing" if least >= 0.5 else "Perhaps missing"


def _said(result: Result, name: str) -> str:
    """What a named effect does, its force, and what it cannot be told from."""
    cause = by_name(result)[name]
    size = f" Typically {force(cause['typical_force'])}." if force(cause["typical_force"]) else ""
    rivals = [likely(result, n) for n in cause["cannot_be_told_from"]]
    return (
        cause["says"]
        + size
        + (f" These voyages cannot tell it from {' or '.join(rivals)}." if rivals else "")
    )


def weather_only(result: Result) -> str:
    """The model lacks water or weather, and no more."""
    names = " and ".join(likely(result, n) for n in result["missing"])
    return (
        "Of ship and instruments nothing is missing. What the model lacks is water and weather of these "
        f"voyages: {names}.{_more(result)}"
    )


def weather_at_least(result: Result) -> str:
    """The same, where the voyages cannot tell whether there is more."""
    names = " and ".join(likely(result, n) for n in result["missing"])
    besides = "Whether something of ship or instruments is missing besides, these voyages cannot tell."
    if result["one_of"]:
        besides = f"Beside it {' or '.join(result['one_of'])}: these voyages cannot tell which."
    return f"The model lacks water and weather of these voyages: {names}. {besides}{_more(result)}"


def nothing(result: Result) -> str:
    """Nothing is missing."""
    return (
        "Nothing is missing: what the model cannot explain is no more than it left unexplained on good "
        "voyages."
    )


def resembles(result: Result) -> str:
    """Something is missing that resembles an effect."""
    near = _near(result)
    resembling = [
        f" It resembles {like['effect']}: {like['says']}{_no_nearer(like)}"
        for like in result["resembles"][:1]
    ]
    beside = [f" Beside it: {' with '.join(near)}."] if near else []
    return "".join(["Something is missing that is not in the catalogue of effects.", *resembling, *beside])


def _no_nearer(c: Result) -> str:
    """Where an effect brings the model hardly nearer to where the ship went, and not near enough: that."""
    without, with_it, usual = c["error_without"], c["error_with"], c["error_floor"]
    if None in (without, with_it, usual) or with_it <= usual or with_it < ANY_NEARER * without:
        return ""
    return (
        f" But with it the model comes hardly nearer to where the ship went ({num(with_it, 3)} m, "
        f"{num(without, 3)} m without; {num(usual, 3)} m are expected): something else acts, too, or instead."
    )


def pushed(result: Result) -> str:
    """Something is missing that acted for a while."""
    return (
        "Something is missing that no known effect explains: a force pushed the ship "
        f"{when(result['moments'][0])}, and not before or after."
    )


def comes_and_goes(result: Result) -> str:
    """Something is missing that does not act all the time."""
    fitful = _fitful(result)
    told = [c for c in result["candidates"] if c["effect"] in fitful]
    says = [f"{c['effect']}, which would last: {c['says']}" for c in told]
    when = next((acting(c["over_time"]) for c in told if c.get("over_time")), "comes and goes")
    return (
        f"Something is missing that {when}, and is not in the catalogue of effects. While it acts it "
        f"resembles {(says or fitful)[0]}"
    )


def unexplained(result: Result) -> str:
    """Something is missing that no effect explains."""
    return f"Something is missing, but none of the known effects explains it.{_nearest(result)}"


def still_astray(result: Result) -> str:
    """The open-loop error is there, what is likely does not lead nearer, and nothing says that it has no
    name."""
    return f"Undecided: {_error(result)}, and no effect that is likely explains it.{_nearest(result)}"


def _nearest(result: Result) -> str:
    near = _near(result)
    return f" Nearest, but not enough: {' with '.join(near)}." if near else ""


def one_of(result: Result) -> str:
    """One of several effects, which nobody can tell apart."""
    known_by_form = {c["effect"]: percent(c["probability"]) for c in result["resembles"]}
    *others, last = [
        f"something like {n} ({known_by_form[n]})" if n in known_by_form else likely(result, n)
        for n in result["one_of"]
    ]
    return (
        f"Undecided: probably {', '.join(others)} or {last} is missing; these voyages cannot tell them apart."
    )


def no_manoeuvre(result: Result) -> str:
    """The voyages hold no manoeuvre."""
    return (
        "Undecided: no manoeuvre was sailed, and on a ship that holds course and speed no cause can be told "
        "apart from another."
    )


def weather(result: Result) -> str:
    """It may be the weather."""
    fitful, near = _fitful(result), _near(result)
    says = likely(result, near[0]) if near else "something"
    if fitful:
        says = f"something that acts like {fitful[0]} and comes and goes"
    return f"Undecided: the readings point to {says}, but {ROUGHLY}. A calmer voyage would tell."


def as_near(result: Result) -> str:
    """The open-loop error shows no clear difference."""
    how = "and no effect explains how"
    if result["moments"]:
        how = f"for a force pushed the ship {when(result['moments'][0])}, and no effect explains it"
    return (
        f"Undecided: the readings differ from what is usual, {how}; but {_error(result)}, which is no clear "
        "difference."
    )


def astray(result: Result) -> str:
    """The open-loop error is there, and no effect is likely."""
    return f"Undecided: no known effect is likely, but {_error(result)}."


def restless(result: Result) -> str:
    """More than on the references that nothing explains, evenly."""
    return (
        "Undecided: no known effect is likely, but the ship moved more than any effect explains, and more "
        "than on the reference voyages: a rough day, or something that acted for a part of the time."
    )


def pushed_in_weather(result: Result) -> str:
    """A push, in waves."""
    return (
        f"Undecided: {when(result['moments'][0])} a force pushed the ship, and not before or after. "
        "In waves that may be a group of high ones."
    )


def not_named(result: Result) -> str:
    """Why the likeliest effect is not named, where it was estimated."""
    reasons = result["answer"]["not_named"]
    c = next((c for c in result["candidates"] if c["effect"] in reasons), None)
    if c is None:
        return cannot_tell(result)
    return (
        f"Undecided: the readings ask for {likely(result, c['effect'])}, but "
        f"{why_not(c, reasons[c['effect']])}."
    )


def no_power(result: Result) -> str:
    """The voyages would not have shown it."""
    return (
        f"Undecided: nothing shows, but these voyages would have shown only "
        f"{percent(result['facts']['power'])} of the causes that may be missing, and {percent(POWER)} are "
        "needed to say that nothing is."
    )


def cannot_tell(result: Result) -> str:
    """The voyages cannot tell."""
    return "Undecided: these voyages cannot tell what, if anything, is missing."


def by_name(result: Result) -> Result:
    """The candidates by their effect."""
    return {c["effect"]: c for c in result["candidates"]}


def likely(result: Result, name: str) -> str:
    """A name with its probability, where that is known."""
    c = by_name(result).get(name)
    if c is None:
        return name
    changed = any("in_ship_file" in p for p in c["parameters"])
    return f"{'a change of ' * changed}{name} ({percent(c['probability'])})"


def when(m: Result) -> str:
    """From when to when on which voyage."""
    return f"from {clock(m['start_s'])} to {clock(m['end_s'])} on {m['voyage']}"


def _is_weather(result: Result, name: str) -> bool:
    return name in {w["effect"] for w in result["weather"]}


def further_in_words(result: Result, names: list[str]) -> str:
    """Which of the names shows only with the others in the model."""
    later = [n for n in names if n in result["further"]]
    shows = "shows" if len(later) == 1 else "show"
    others = " and ".join(n for n in names if n not in later)
    return f" {' and '.join(later)} {shows} only with {others} in the model." if later else ""


def _more(result: Result) -> str:
    error = result["facts"]["left"]["error"]
    return (
        f" Something more is missing: with all that the open-loop error is still {num(error, 2)} times the "
        "expected one."
        if result["more"]
        else ""
    )


def _fitful(result: Result) -> list[str]:
    """What acts like a cause that lasts, and comes and goes."""
    return [name for name, why in result["answer"]["not_named"].items() if why == "comes_and_goes"]


def _near(result: Result) -> list[str]:
    return [c["effect"] for c in result["candidates"] if c["probability"] >= 0.5]


def _error(result: Result) -> str:
    path = result["path"]
    return (
        f"after {path['horizon_s']:.0f} s the model ends {num(path['error_without'], 3)} m from where the "
        "ship "
        f"went ({num(path['error_floor'], 3)} m "
        "is expected of this calibrated ship)"
    )

"""A diagnosis in words: the sentence first, then the ranking with sizes and intervals."""

from collections.abc import Sequence
from typing import Any

from twin.num import as_given, clock, num, percent, readable
from twin.recording.checks import whose
from twin.study.diagnosis import reasons
from twin.study.diagnosis import sentences as say
from twin.study.diagnosis.against_healthy import healthy_in_words, since_in_words
from twin.study.diagnosis.force_in_words import force as in_words
from twin.study.diagnosis.overtime import changes
from twin.study.diagnosis.set_and_rate import stream_in_words
from twin.study.estimation.start import waves_in_words
from twin.study.track.jumps import jumps_in_words

PUSHED = 3  # moments that are told
SOME = 0.5  # probability from which a kind of weather is more than what any day brings


def terminal_lines(result: dict[str, Any]) -> list[str]:
    """Lines for the terminal."""
    lines = [*whose(result["data_checks"]), *on_its_own(result["calibrated_on"]), result["sentence"]]
    lines += [""] if result["calibrated"] else [healthy_in_words(result), ""]
    lines += [_moment(m) for m in result["moments"][:PUSHED]]
    resembling = [line for c in result["resembles"] for line in candidate_lines(c)]
    known = [line for c in result["candidates"] for line in candidate_lines(c) + _not_named(c, result)]
    if result["verdict"] == "unknown":
        lines += [*resembling, *(["if it is one of the known effects:"] if known else []), *known]
    else:
        lines += known + resembling
    weather = weather_lines(result)
    lines += weather if lines[-1] else weather[1:]
    nothing, unknown = (percent(result["probabilities"][k]) for k in ("nothing_missing", "unknown"))
    lines.append(
        f"nothing of ship and instruments missing: {nothing}   something unknown: {unknown}   (each as often "
        "as on random ships with such an answer)"
    )
    lines += [healthy_in_words(result)] * result["calibrated"]
    lines += since_in_words(result["learned_since"])
    if result["next_manoeuvre"]:
        lines += ["", to_sail(result["next_manoeuvre"])]
    if result["not_judged"]:
        lines.append(f"Not judged, for want of what was not recorded: {unrecorded(result['not_judged'])}.")
    lines += [
        f"{n}: no more of it than on the reference voyages; it is allowed for, and not called missing."
        for n in result["as_on_references"]
    ]
    lines += [*waves_in_words(result["waves"]), *jumps_in_words(result["jumps"])]
    if result["not_visible"]:
        lines.append(
            "Too small to be seen in these voyages, even at a plausible size: "
            f"{', '.join(result['not_visible'])}."
        )
    return lines


def on_its_own(names: Sequence[str]) -> list[str]:
    """A line that the ship was calibrated on these of the voyages; none where it was on none."""
    if not names:
        return []
    return [
        f"{', '.join(names)}: the ship was calibrated on {'these voyages' if names[1:] else 'this voyage'}, "
        "so that a fault it had then is part of the model and does not show. Diagnose a later voyage."
    ]


def unrecorded(effects: Sequence[dict[str, Any]]) -> str:
    """The effects that could not be judged, those that lack the same together with what they lack."""
    by_want: dict[str, list[str]] = {}
    for n in effects:
        by_want.setdefault(" and ".join(n["lacks"]), []).append(n["effect"])
    return "; ".join(f"{', '.join(names)} ({want})" for want, names in by_want.items())


def to_sail(m: dict[str, Any]) -> str:
    """The next manoeuvre, and what it is for."""
    what = (
        f"tell {m['separates'][0]} from {m['separates'][1]}"
        if m["separates"]
        else f"see {' and '.join(m['shows'])}, should {'they' if len(m['shows']) > 1 else 'it'} be there"
    )
    return f"To {what}, sail: {m['manoeuvre']} ({m['why']})."


def weather_lines(result: dict[str, Any]) -> list[str]:
    """Today's water and wind, in a part of their own, and how near the model comes with them."""
    if not result["weather"]:
        return []
    lines = ["", "today's water and wind:"]
    for w in result["weather"]:
        likely = w["probability"] >= SOME
        usual = "" if likely else " (allowed for: no more than any day brings)"
        lines.append(f"{percent(w['probability']) if likely else '':>6}  {w['effect']}: {_numbers(w)}{usual}")
        if beyond := w.get("beyond_file"):
            filed = ", ".join(f"{p['name']} {num(p['value'], 3)} +- {num(p['sd'])}" for p in beyond)
            lines.append(
                f"        the ship file has {filed}: today's is beyond that, and what is told as "
                f"{w['effect']} may be something else that acts like it"
            )
    path, causes = result["path"], result["candidates"] + result["resembles"]
    listed = [w["effect"] for w in result["weather"]]
    held = [name for name in listed if name in path["weather"]]
    if held and path["error_without"] is not None and not causes:
        lines.append(
            f"        with {'it' if held == listed else ' and '.join(held)} the model ends "
            f"{num(path['error_without'], 3)} m off after {path['horizon_s']:.0f} s "
            f"({num(path['error_floor'], 3)} m are expected); twin compare allows for no water and wind but "
            "the ship file's"
        )
    return [*lines, ""]


def _numbers(weather: dict[str, Any]) -> str:
    """A stream by speed and direction, anything else by its numbers and its force."""
    if weather.get("stream"):
        return stream_in_words(weather["stream"])
    numbers = ", ".join(
        f"{p['name']} {num(p['value'], 3)} {p['unit']}".rstrip()
        + " (at the end of its box)" * p.get("at_box_end", False)
        for p in map(readable, weather["parameters"])
        if abs(p["value"]) > 0.0
    )
    pushed = in_words(weather["typical_force"]) if weather["typical_force"] else ""
    return f"{numbers}; typically {pushed}" if pushed else numbers


def _moment(m: dict[str, Any]) -> str:
    return f"{say.when(m)} a force pushed the ship that was not there before or after: {in_words(m)}"


def candidate_lines(c: dict[str, Any]) -> list[str]:
    """One cause: probability, sizes with intervals, typical force, and the error without and with it."""
    head = f"{percent(c['probability']):>6}  {c['effect']}"
    if c["together_with"]:
        head += f" (together with {', '.join(c['together_with'])})"
    lines = [head, *_sizes(c)]
    force = c["typical_force"]
    if in_words(force) and not c.get("stream"):
        lines.append(f"          typically    {in_words(force)}")
    expected = (
        f" ({num(c['error_floor'], 3)} m is expected even with the right cause)"
        if c["error_floor"] is not None
        else ""
    )
    lines.append(
        f"          {c['error_horizon_s']:.0f} s error  {num(c['error_without'], 3)} m without, "
        f"{num(c['error_with'], 3)} m with it{expected}, "
        "on parts not used for the fit"
    )
    if changes(c.get("over_time", ())):
        lines.append("          its size changes with time (1 = the size above):")
        lines += [_part(p) for p in c["over_time"]]
    if c.get("together_sd"):
        lines.append(f"          {reasons.only_together(c)}")
    if c["cannot_be_told_from"]:
        lines.append(f"          cannot be told apart from {', '.join(c['cannot_be_told_from'])}")
    return lines


def _sizes(c: dict[str, Any]) -> list[str]:
    """Each number with its interval; a stream that changes, by its speed and direction."""
    rows = c.get("stream", [])
    if len(rows) > len({row["voyage"] for row in rows}):
        return [f"          {stream_in_words(rows)}"]
    lines = []
    width = max([12, *(len(p["name"]) for p in c["parameters"])])
    for p in map(readable, c["parameters"]):
        file = f"   (ship file: {as_given(p['in_ship_file'], 4)})" if "in_ship_file" in p else ""
        end = "   (at the end of its box)" if p["at_box_end"] else ""
        lines.append(
            f"          {p['name']:<{width}} {num(p['value'], 4):>11} {p['unit']:<5} "
            f"95 %: {num(p['low95'], 4)} to {num(p['high95'], 4)}{file}{end}"
        )
        if not p["unit"] and p.get("meaning"):
            lines.append(f"          {'':<{width}} {p['meaning']}")
    return lines


def _not_named(c: dict[str, Any], result: dict[str, Any]) -> list[str]:
    """Why what is likely is not named beside what is."""
    reason = result["answer"]["not_named"].get(c["effect"])
    return (
        [f"          not named: {reasons.why_not(c, reason)}"]
        if reason and result["verdict"] == "missing"
        else []
    )


def _part(p: dict[str, Any]) -> str:
    return (
        f"            {p['voyage']} {clock(p['start_s']):>11} to {clock(p['end_s']):>11}  "
        f"{p['share']:>6.2f} +- {p['sd']:.2f}"
    )

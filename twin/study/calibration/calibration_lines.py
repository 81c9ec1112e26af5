"""What a calibration tells on the terminal, line by line."""

from typing import Any

from twin.num import as_given, num, readable
from twin.recording.checks import losses, whose
from twin.study.calibration.calibration_record import PARTS
from twin.study.calibration.parts import WEATHER
from twin.study.estimation.columns import FORM, LATE, SEA, owner_of
from twin.study.estimation.start import waves_in_words
from twin.study.reference.weather_baseline import HARDER
from twin.study.track.jumps import jumps_in_words

OF_WHAT = {  # owner of a number that is no effect of the catalogue -> what it stands for
    SEA: "what one wave does to helm and hull at once",
    FORM: "a term of the hull that this model does not have",
    LATE: "how late this instrument usually is",
}


def _of_what(name: str) -> str:
    """What a number of the baseline stands for, with a comma; "" of an effect."""
    words = OF_WHAT.get(owner_of(name))
    return f"{words}, " if words else ""


def terminal_lines(result: dict[str, Any]) -> list[str]:
    """Lines for the terminal: the error first; before it, that a voyage may be of another ship."""
    lines = [*whose(result["data_checks"]), *_errors(result), *_parts(result)]
    lines += [f"  {text}" for text in (*waves_in_words(result["waves"]), *jumps_in_words(result["jumps"]))]
    share = ", ".join(f"{num(100 * s, 2)} %" for s in result["floor"]["share"])
    lines += ["", f"what remains unexplained of the forces at work, in surge, sway, yaw: {share}"]
    lines += [
        f"baseline of this ship: {sizes_in_words({i['name']: i})} ({_of_what(i['name'])}allowed for)"
        for i in result["usual"]
    ]
    lines += _derivatives(result)
    return lines + [f"careful: {text}" for text in result["doubts"]] + losses(result["data_checks"])


def _errors(result: dict[str, Any]) -> list[str]:
    """The open-loop error by horizon and regime, before and after, and what was fitted to."""
    lines = [f"{result['ship']}: open-loop error on what was not used for the fit ({result['held_out_is']})"]
    for e in result["held_out"]:
        if e["position_m"] is not None:
            lines.append(
                f"  {e['horizon_s']:>4.0f} s   {num(e['before_m'], 3):>8} m -> {num(e['position_m'], 3):<8} "
                "m    "
                f"{num(e['before_deg'], 3):>7} deg -> {num(e['heading_deg'], 3):<7} deg   ({e['windows']} "
                "windows)"
            )
    lines += [
        f"  after {r['horizon_s']:.0f} s while {r['regime']}: {num(r['position_m'], 3)} m ({r['windows']} "
        "windows)"
        for r in result["by_regime"]
    ]
    by = "where it went, three lengths ahead" if result["fitted_by"] == "paths" else "each next reading"
    return [*lines, f"  fitted to {by}"]


def _parts(result: dict[str, Any]) -> list[str]:
    """What became a part of the ship's model, each with its numbers; and weather that was too weak."""
    lines = [
        "  the reference voyages together show more of it than sound instruments do from day to day, "
        f"whatever the ship is: now part of the model ({name}: {sizes_in_words(numbers)})"
        for name, numbers in result["instruments"].items()
    ]
    lines += _part(
        result,
        "gear",
        "rudder_angle_deg is the rudder order: the steering gear behind it is now part of the model",
    )
    lines += [
        f"  {name.partition('.')[2]} lags behind what was recorded of it, its order: that is now part of the "
        f"model ({name}: {sizes_in_words(numbers)})"
        for name, numbers in result["actuator_lags"].items()
    ]
    for part, why in (
        (
            "antenna",
            "position is measured elsewhere than the ship file says, or the log's speed, whose place is "
            "allowed for at import: that is now part of the model; if you know the antenna's place, give it "
            "in the ship file (docs/import.md) and calibrate again",
        ),
        ("wind", "wind pushed the ship on these voyages: its force is now part of the model"),
        (
            "shallow_water",
            "there was little water under the keel on these voyages: what that does is now part of the model",
        ),
        (
            "compass",
            "speed over ground is turned by a compass that deviates with the heading: that is now part of "
            "the model",
        ),
    ):
        lines += _part(result, part, why)
    return lines + [
        f"  {name} was measured, {_not_in_the_model(name)}: what pushes up to {as_given(HARDER)} times as "
        "hard is allowed for and not called missing"
        for name in result["too_faint"]
    ]


def _not_in_the_model(name: str) -> str:
    looked_for = name in (weather.__name__ for weather in WEATHER)
    return "but too weak to be estimated" if looked_for else "and is not looked for in a calibration"


def _part(result: dict[str, Any], part: str, why: str) -> list[str]:
    """The line of one of PARTS, where it was found."""
    found = result[part]
    return [f"  {why} ({PARTS[part].__name__}: {sizes_in_words(found)})"] if found else []


def _derivatives(result: dict[str, Any]) -> list[str]:
    """The table of the derivatives that were fitted, and which were not."""
    lines = ["", f"{'derivative':<10}{'before':>11}{'now':>11}{'+-':>9}"]
    lines += [
        f"{d['name']:<10}{num(d['before'], 4):>11}{num(d['value'], 4):>11}{num(d['sd'], 2):>9}"
        + f" {d['unit']}".rstrip()
        for d in map(readable, result["derivatives"])
        if d["excited"]
    ]
    kept = result["unexcited"]
    return lines + [f"not excited by these voyages, prior kept: {', '.join(kept)}"] * bool(kept)


def sizes_in_words(numbers: dict[str, dict[str, Any]]) -> str:
    """Numbers with their standard errors."""
    return ", ".join(
        f"{name} {num(n['value'], 3)} +- {num(n['sd'], 1)} {n['unit']}".rstrip()
        for name, n in ((name, readable(n)) for name, n in numbers.items())
    )

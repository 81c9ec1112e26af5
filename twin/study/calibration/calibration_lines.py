"""What a calibration tells on the terminal, line by line."""

from typing import Any

from twin.num import as_given, num, readable
from twin.recording.checks import losses, whose
from twin.study.calibration.calibration_record import PARTS
from twin.study.estimation.start import waves_in_words
from twin.study.reference.weather_baseline import HARDER
from twin.study.track.jumps import jumps_in_words


def terminal_lines(result: dict[str, Any]) -> list[str]:
    """Lines for the terminal: the error first; before it, that a voyage may be of another ship."""
    error = f"{result['ship']}: open-loop error on what was not used for the fit ({result['held_out_is']})"
    lines = [*whose(result["data_checks"]), error]
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
    lines.append(
        "  fitted to "
        + ("where it went, three lengths ahead" if result["fitted_by"] == "paths" else "each next reading")
    )
    lines += [
        "  the instruments show it on each reference voyage alike, whatever the ship is: now part of the "
        f"model ({name}: {sizes_in_words(numbers)})"
        for name, numbers in result["instruments"].items()
    ]
    if gear := result["gear"]:
        lines.append(
            "  rudder_angle_deg is the rudder order: the steering gear behind it is now part of the model "
            f"({PARTS['gear'].__name__}: {sizes_in_words(gear)})"
        )
    lines += [
        f"  {name.partition('.')[2]} lags behind what was recorded of it, its order: that is now part of the "
        f"model ({name}: {sizes_in_words(numbers)})"
        for name, numbers in result["actuator_lags"].items()
    ]
    if antenna := result["antenna"]:
        lines.append(
            "  position is measured elsewhere than the ship file says: the place is now part of the model "
            f"({PARTS['antenna'].__name__}: {sizes_in_words(antenna)})"
        )
    if wind := result["wind"]:
        lines.append(
            "  wind pushed the ship on these voyages: its force is now part of the model "
            f"({PARTS['wind'].__name__}: {sizes_in_words(wind)})"
        )
    if compass := result["compass"]:
        lines.append(
            "  speed over ground is turned by a compass that deviates with the heading: that is now part of "
            f"the model ({PARTS['compass'].__name__}: {sizes_in_words(compass)})"
        )
    lines += [
        f"  {name} was measured, but too weak to be estimated: up to {as_given(HARDER)} times as strong, it "
        "is allowed for and not called missing"
        for name in result["too_faint"]
    ]
    lines += [f"  {text}" for text in (*waves_in_words(result["waves"]), *jumps_in_words(result["jumps"]))]
    share = ", ".join(f"{num(100 * s, 2)} %" for s in result["floor"]["share"])
    lines += ["", f"what remains unexplained of the forces at work, in surge, sway, yaw: {share}"]
    lines += [
        f"baseline of this ship: {sizes_in_words({i['name']: i})} (allowed for by twin diagnose)"
        for i in result["usual"]
    ]
    lines += ["", f"{'derivative':<10}{'before':>11}{'now':>11}{'+-':>9}"]
    lines += [
        f"{d['name']:<10}{num(d['before'], 4):>11}{num(d['value'], 4):>11}{num(d['sd'], 2):>9}"
        + f" {d['unit']}".rstrip()
        for d in map(readable, result["derivatives"])
        if d["excited"]
    ]
    if result["unexcited"]:
        lines.append(f"not excited by these voyages, prior kept: {', '.join(result['unexcited'])}")
    return lines + [f"careful: {text}" for text in result["doubts"]] + losses(result["data_checks"])


def sizes_in_words(numbers: dict[str, dict[str, Any]]) -> str:
    """Numbers with their standard errors."""
    return ", ".join(
        f"{name} {num(n['value'], 3)} +- {num(n['sd'], 1)} {n['unit']}".rstrip()
        for name, n in ((name, readable(n)) for name, n in numbers.items())
    )

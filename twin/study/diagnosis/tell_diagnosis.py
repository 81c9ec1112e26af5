"""A diagnosis in words: the sentence first, then the ranking with sizes and intervals."""

from typing import Any

from twin.study.diagnosis.leftover import BETTER, NEARLY
from twin.study.diagnosis.overtime import changes
from twin.study.diagnosis.verdict import ACQUITTED, LOST, SURE
from twin.study.estimation.start import told_of_waves

PUSHED = 3  # moments that are told
SMALL = "It is too small to show in where these voyages led her: `twin add` may ask for others."
NEAR = 0.5  # probability from which an effect is told as the nearest one when none explains the voyages


def told(result: dict[str, Any]) -> list[str]:
    """Lines for the terminal."""
    lines = [sentence(result), ""]
    lines += [_moment(m) for m in result["moments"][:PUSHED]]
    for c in result["resembles"]:
        lines += _candidate(c)
    if result["verdict"] == "unknown" and result["candidates"]:
        lines.append("were it one of the effects I know:")
    for c in result["candidates"]:
        lines += _candidate(c) + _not_named(c, result)
    chances = result["probabilities"]
    lines.append(
        f"nothing missing: {chances['nothing_missing']:.0%}   something unknown: {chances['unknown']:.0%}"
    )
    if result["next_manoeuvre"]:
        m = result["next_manoeuvre"]
        lines += [
            "",
            f"To tell {m['separates'][0]} from {m['separates'][1]}, sail: {m['manoeuvre']} ({m['why']}).",
        ]
    lines += [
        f"{n['effect']} cannot be judged: no {' and no '.join(n['lacks'])} was recorded."
        for n in result["not_judged"]
    ]
    lines += [
        f"{n} was no stronger than on the reference voyages: it is reckoned with, and not called missing."
        for n in result["as_on_references"]
    ]
    lines += told_of_waves(result["waves"])
    if result["not_visible"]:
        lines.append(
            "Too small to be seen in these voyages, even at a plausible size: "
            f"{', '.join(result['not_visible'])}."
        )
    return lines


def sentence(result: dict[str, Any]) -> str:
    """The verdict, as one would say it on the bridge."""
    by_name = {c["effect"]: c for c in result["candidates"]}
    if result["verdict"] == "missing":
        first = by_name[result["missing"][0]]
        names = " and ".join(_likely(by_name, n) for n in result["missing"])
        force = first["typical_force"]
        size = f" Typically {_force(force)}." if _force(force) else ""
        rivals = [_likely(by_name, n) for n in first["cannot_be_told_from"]]
        doubt = f" These voyages cannot tell it from {' or '.join(rivals)}." if rivals else ""
        small = f" {SMALL}" if size and len(result["missing"]) == 1 and not nearer(first) else ""
        more = "".join(
            f" Beside it is something like {c['effect']}, or its form is another than nature's."
            for c in result["resembles"]
        )
        return f"Missing: {names}. {first['says']}{size}{doubt}{small}{more}"
    if result["verdict"] == "nothing_missing":
        return (
            "Nothing is missing: what the model cannot explain is no more than it left unexplained on "
            "good voyages."
        )
    if result["verdict"] == "unknown":
        near = [c["effect"] for c in result["candidates"] if c["probability"] >= NEAR]
        if result["resembles"]:
            like = result["resembles"][0]
            beside = f" Beside it: {' with '.join(near)}." if near else ""
            return (
                "Something is missing that is none of the effects of the catalogue. It looks like "
                f"{like['effect']}: {like['says']}{beside}"
            )
        if result["moments"] and not near:
            return (
                "Something is missing that no effect I know would do: it pushed her "
                f"{_when(result['moments'][0])} as it did not before."
            )
        nearest = f" Nearest, but not enough: {' with '.join(near)}." if near else ""
        return f"Something is missing, but none of the effects I know explains it.{nearest}"
    if result["one_of"]:
        *others, last = [_likely(by_name, n) for n in result["one_of"]]
        return (
            f"Undecided: something is missing, {', '.join(others)} or {last}; these voyages cannot tell "
            "them apart."
        )
    if result["calibrated_too_coarsely"]:
        left = ", ".join(result["calibrated_too_coarsely"])
        return (
            f"Undecided: on her reference voyages the model left {left} of the forces at work unexplained, "
            "and is no witness. Calibrate with more, "
            "or calmer, voyages, and leave out one that stands apart."
        )
    likely = [c for c in result["candidates"] if c["probability"] >= SURE]
    if not result["voyages_hold_a_manoeuvre"]:
        return (
            "Undecided: no manoeuvre was sailed, and a ship that holds her course and speed tells one "
            "cause from no other."
        )
    if result["undo_each_other"]:
        first, second = result["undo_each_other"]
        return (
            f"Undecided: {first} and {second} would fit, but each takes back most of what the other "
            "does, "
            "as two faults hardly ever do."
        )
    if likely and likely[0]["effect"] in result["unclear"]:
        return (
            f"Undecided: the readings ask for {_likely(by_name, likely[0]['effect'])}, but "
            f"{_unclear(likely[0])}."
        )
    if likely and not nearer(likely[0]):
        c = likely[0]
        return (
            f"Undecided: step by step the readings say {_likely(by_name, c['effect'])}, but it does not lead "
            "her to where she went any better "
            f"({c['error_with']:.3g} m off with it, {c['error_without']:.3g} m without)."
        )
    if likely and result["weather_may_mislead"]:
        return (
            f"Undecided: the readings say {_likely(by_name, likely[0]['effect'])}, but in weather like this, "
            "whose force the model knows only "
            "roughly, that may be the weather's doing. A calmer voyage would tell."
        )
    if result["moments"] and not likely:
        return (
            f"Undecided: {_when(result['moments'][0])} something pushed her as it did not before and after. "
            "Where waves toss her that may be a group "
            "of them."
        )
    path = result["path"]
    if result["probabilities"]["unknown"] >= LOST and path["error_without"] <= NEARLY * path["error_floor"]:
        return (
            "Undecided: the readings are not what they usually are, as no effect explains, but the model "
            "leads her no clearly farther off than "
            f"usual ({path['error_without']:.3g} m after {path['horizon_s']:.0f} s, "
            f"{path['error_floor']:.3g} m would be usual)."
        )
    if (
        result["probabilities"]["nothing_missing"] >= ACQUITTED
        and path["error_without"] > NEARLY * path["error_floor"]
    ):
        return (
            f"Undecided: no effect that I know is likely, but after {path['horizon_s']:.0f} s the model ends "
            f"{path['error_without']:.3g} m from "
            f"where she went ({path['error_floor']:.3g} m would be usual)."
        )
    return "Undecided: these voyages cannot tell what, if anything, is missing."


def _moment(m: dict[str, Any]) -> str:
    return f"{_when(m)} something pushed her that was not there before and after: {_force(m)}"


def _when(m: dict[str, Any]) -> str:
    return f"from {_clock(m['start_s']).strip()} to {_clock(m['end_s']).strip()} on {m['voyage']}"


def nearer(candidate: dict[str, Any]) -> bool:
    """Whether the ship is led clearly nearer with this effect than without any."""
    return bool(candidate["error_with"] <= (1.0 - BETTER) * candidate["error_without"])


def _likely(by_name: dict[str, Any], name: str) -> str:
    """A name with its probability, where that is known."""
    if name not in by_name:
        return name
    changed = any("in_ship_file" in p for p in by_name[name]["parameters"])
    return f"{'a change of ' * changed}{name} ({by_name[name]['probability']:.0%})"


def _candidate(c: dict[str, Any]) -> list[str]:
    head = f"{c['probability']:6.0%}  {c['effect']}"
    if c["together_with"]:
        head += f" (together with {', '.join(c['together_with'])})"
    lines = [head]
    for p in c["parameters"]:
        file = f"   (ship file: {p['in_ship_file']:.4g})" if "in_ship_file" in p else ""
        lines.append(
            f"          {p['name']:<12} {p['value']:>11.4g} {p['unit']:<5} 95 %: {p['low95']:.4g} "
            f"to {p['high95']:.4g}{file}"
        )
    force = c["typical_force"]
    if _force(force):
        lines.append(f"          typically    {_force(force)}")
    floor = f" (a true cause may leave {c['error_floor']:.3g} m)" if c["error_floor"] is not None else ""
    lines.append(
        f"          {c['error_horizon_s']:.0f} s error  {c['error_without']:.3g} m without, "
        f"{c['error_with']:.3g} m with it{floor}, "
        "on parts not used for the fit"
    )
    if changes(c.get("over_time", ())):
        lines.append("          not the same all the time (1 = the size above):")
        lines += [_part(p) for p in c["over_time"]]
    if c["cannot_be_told_from"]:
        lines.append(f"          not told from {', '.join(c['cannot_be_told_from'])}")
    return lines


def _not_named(c: dict[str, Any], result: dict[str, Any]) -> list[str]:
    """Why what is likely is not named beside what is."""
    if result["verdict"] != "missing" or c["effect"] in result["missing"] or c["probability"] < SURE:
        return []
    why = (
        _unclear(c)
        if c["effect"] in result["unclear"]
        else ("the path does not ask for it: the form of what is named may be another")
    )
    return [f"          not named: {why}"]


def _unclear(c: dict[str, Any]) -> str:
    """Why numbers that the readings ask for are no answer."""
    hers = any("in_ship_file" in p for p in c["parameters"])
    return f"not one of its numbers is clearly other than {'the ship file has it' if hers else 'none'}"


def _part(p: dict[str, Any]) -> str:
    return (
        f"            {p['voyage']} {_clock(p['start_s'])} to {_clock(p['end_s'])}  {p['share']:>6.2f} "
        "+- "
        f"{p['sd']:.2f}"
    )


def _clock(seconds: float) -> str:
    return f"{int(seconds) // 60:>4d}:{int(seconds) % 60:02d}"


def _force(force: dict[str, float]) -> str:
    """The components that are there, in words."""
    forces = {key: force[key] for key in ("X_N", "Y_N", "N_Nm")}
    return ", ".join(
        f"{key[0]} {_si(value, 'N m' if key == 'N_Nm' else 'N')}"
        for key, value in forces.items()
        if abs(value) > 1e-9
    )


def _si(value: float, unit: str) -> str:
    """A size with the prefix that engineers use."""
    for prefix, factor in (("G", 1e9), ("M", 1e6), ("k", 1e3)):
        if abs(value) >= factor:
            return f"{value / factor:.3g} {prefix}{unit}"
    return f"{value:.3g} {unit}"

"""What `twin add` says of its work: the verdict, the notes, the lines on a terminal, and what the ship file
remembers."""

import datetime
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from twin.num import as_given, num, readable
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.checks import whose
from twin.recording.jsonable import short
from twin.study.reference.sailed import Sailed
from twin.study.reference.structure import noise_model_of
from twin.study.update.adding import UNTOUCHED, Fitted, Number
from twin.study.update.fall import Fall
from twin.study.update.proof import HeldOutProof

FEW = 4  # numbers of an effect that are shown beside what was asked for
FARTHER = (
    "That error alone is no smaller on these voyages, and proves nothing by itself: the proof is made of all "
    "that was measured, at every horizon."
)
FOREVER_S = 100.0 * 3600.0  # of sailing, beyond which no more of it is worth asking for


def verdict(result: dict[str, Any], proof: HeldOutProof, shown: Fall) -> str:
    """The first sentence: is what was held out likelier, and what that is in metres."""
    names = " and ".join(result["added"])
    if proof.idle:
        return f"{names}: fitted to zero on these voyages, so this ship file predicts as it did before."
    how = f"{_ratio(proof)}; {_metres(result, shown)}"
    if proof.proved:
        farther = f" {FARTHER}" if shown.after > shown.before else ""
        return f"Measurements that were kept from the fit are likelier with {names}: {how}.{farther}"
    return f"Measurements that were kept from the fit are not clearly likelier with {names}: {how}."


def refused(proof: HeldOutProof, shown: Fall, apart: bool) -> str:
    """The reason, and what would tell. `apart`: whether whole voyages were kept from the fit."""
    if proof.idle:
        return "nothing changes: the effect was fitted to zero;"
    reason = f"not proved: {_ratio(proof)}; {shown.sentence()}."
    if proof.more_s is None:
        return f"{reason} More of such voyages would not prove it."
    if proof.more_s > FOREVER_S:
        return f"{reason} Too little of it shows to be proved in a hundred hours."
    parts = "; so may every third of all these voyages in turn, --cross-validated" * apart
    more = f"about {sailing_time(proof.more_s)} more of held-out sailing would prove it"
    return f"{reason} At this rate {more}{parts}."


def _ratio(proof: HeldOutProof) -> str:
    sizes = f"{num(proof.log_ratio, 3, sign=True)} (95 %: {num(proof.low95, 3)} to {num(proof.high95, 3)})"
    return (
        f"log likelihood ratio {sizes}, from {num(proof.needed, 2)} and with its interval above zero a proof"
    )


def _metres(result: dict[str, Any], shown: Fall) -> str:
    row = next((r for r in result["horizons"] if r["horizon_s"] == shown.horizon_s), None)
    if row is None or shown.unit != "m":
        return shown.sentence()
    b, a, healthy = row["before"], row["after"], row["noise_floor"]
    turned = f"{num(b['heading_mae_deg'], 2)} to {num(a['heading_mae_deg'], 2)} deg"
    usual = (
        f"expected of this ship: {num(healthy['position_mae_m'], 2)} m, "
        f"{num(healthy['heading_mae_deg'], 2)} deg"
    )
    return (
        f"{as_given(shown.horizon_s, 4)} s open-loop error from {num(b['position_mae_m'], 3)} to "
        f"{num(a['position_mae_m'], 3)} m and {turned} ({usual})"
    )


def sailing_time(seconds: float) -> str:
    """So many seconds [s] in words: a model's runs last a minute or two."""
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} minutes" if seconds < 7200.0 else f"{seconds / 3600.0:.0f} hours"


def notes(
    ship: Ship, made: Fitted, sailed: Sequence[Sailed], held_out: Sequence[Sailed], last_third: bool
) -> list[str]:
    """What the owner must know to read the numbers."""
    notes = [
        "Only the added effect's numbers were fitted; the core and the effects already there stay as "
        "they were."
    ]
    if noise_model_of(ship) is None:
        notes.append(
            "careful: this ship was never calibrated, so its core is only roughly known and takes a share of "
            "what the effect does: the numbers are "
            "smaller than after twin calibrate on reference voyages."
        )
    if last_third:
        notes.append(
            "No voyage was held out: the last third of each was kept from the fit and used to judge it."
        )
    present = {type(e).__name__ for e in ship.effects}
    notes += [
        f"{n} was in the model already: it was fitted again."
        for n in sorted(present.intersection(made.names))
    ]
    calm = [f"{n.effect}.{n.name}" for n in made.numbers if n.gained < UNTOUCHED]
    if calm:
        notes.append(f"The voyages say little about {', '.join(calm)}: kept near its prior.")
    ends = [
        _size(f"{n.effect}.{n.name}", {"value": n.value, "unit": n.unit}, 3)
        for n in made.numbers
        if n.at_box_end
    ]
    if ends:
        notes.append(
            f"careful: {', '.join(ends)} ended where its box ends: something else may be at work beside it "
            "or in its place. Ask twin diagnose, "
            "and check the particulars of the ship."
        )
    notes += _beside(made.beside)
    return notes + _of_the_day(set(made.names), sailed, held_out)


def _beside(numbers: Sequence[Number]) -> list[str]:
    """What weather and water the voyages had, and what was left open beside it and does not show."""
    clear = list(dict.fromkeys(n.effect for n in numbers if n.low95 > 0.0 or n.high95 < 0.0))
    open_too = list(dict.fromkeys(n.effect for n in numbers if n.effect not in clear))
    return [
        f"{start} {', '.join(names)} {end}"
        for start, names, end in (
            ("These voyages had", clear, "of their own, fitted beside it and not written to the ship file."),
            (
                "Fitted beside it, and not clear on these voyages:",
                open_too,
                "(not written to the ship file).",
            ),
        )
        if names
    ]


def _of_the_day(names: set[str], sailed: Sequence[Sailed], held_out: Sequence[Sailed]) -> list[str]:
    """A warning that numbers belong to a voyage, and where they are judged by one of another day."""
    bound = sorted(name for name in names if not find(name).lasts())
    if not bound:
        return []
    told = [
        f"careful: {', '.join(bound)} belongs to this voyage and not to the ship: remove it (twin remove) "
        "before the ship file is used for another."
    ]
    days = [
        {str(s.voyage.meta.get("start_time_utc", "?"))[:10] for s in group} for group in (sailed, held_out)
    ]
    if len(sailed) + len(held_out) == 1 or (len(days[0] | days[1]) == 1 and "?" not in days[0]):
        return told
    when = "on another day, as far as the files tell" if "?" in days[0] | days[1] else "on another day"
    return [
        *told,
        f"The numbers of {', '.join(bound)} belong to a voyage; some of these were sailed {when}, "
        "where they need not hold.",
    ]


def written(ship: Ship, model: Model, result: dict[str, Any]) -> Ship:
    """The new ship: effects in, every number with its interval, and one more step of its history."""
    notes = dict(ship.notes)
    notes["effects"] = dict(notes.get("effects", {})) | result["parameters"]
    proof = {k: result["proof"][k] for k in ("log_likelihood_ratio", "low95", "high95", "needed")}
    entry = {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "added": result["added"],
        "interval": "95 %",
        "voyages": result["voyages"],
        "held_out": result["held_out"],
        "proof": result["proof"]["kind"],
        "evidence": proof,
        "judged_by": result["judged_by"],
        "errors": [
            {
                "horizon_s": r["horizon_s"],
                "before_m": r["before"]["position_mae_m"],
                "after_m": r["after"]["position_mae_m"],
                "before_deg": r["before"]["heading_mae_deg"],
                "after_deg": r["after"]["heading_mae_deg"],
                "noise_floor_m": r["noise_floor"]["position_mae_m"],
            }
            for r in result["horizons"]
        ],
        "forced": result["forced"],
    }
    bound = [n for n in result["added"] if not find(n).lasts()]
    notes["history"] = [
        *notes.get("history", []),
        short(entry | ({"of_this_voyage": bound} if bound else {}), 4),
    ]
    return replace(ship, effects=model.effects, notes=notes)


def terminal_lines(result: dict[str, Any]) -> list[str]:
    """The answer on a terminal."""
    out = [
        *whose(result["data_checks"]),
        result["verdict"],
        "",
        f"{'horizon':>8}{'before [m]':>13}{'after [m]':>12}{'expected [m]':>14}"
        f"{'before [deg]':>15}{'after [deg]':>13}{'expected [deg]':>16}",
    ]
    for r in result["horizons"]:
        b, a, n = r["before"], r["after"], r["noise_floor"]
        out.append(
            f"{as_given(r['horizon_s'], 4):>6} s"
            f"{num(b['position_mae_m'], 3):>13}{num(a['position_mae_m'], 3):>12}"
            f"{num(n['position_mae_m'], 2):>14}{num(b['heading_mae_deg'], 2):>15}"
            f"{num(a['heading_mae_deg'], 2):>13}{num(n['heading_mae_deg'], 2):>16}"
        )
    at = [
        f"{r['horizon_s']:.0f} s {num(r['log_likelihood_ratio'], 3, sign=True)}"
        for r in result["proof"]["by_horizon"]
    ]
    out += [f"log likelihood ratio by horizon ({result['proof']['kind']}): {', '.join(at)}"]
    out += ["", "what was fitted (95 %)", *number_lines(result["parameters"])]
    if result["beside"]:
        out += ["water and weather of these voyages, not written", *effect_lines(result["beside"])]
    out += ["", "by regime: before, after [m]"] + [
        f"  {num(w['before_m'], 3):>8}{num(w['after_m'], 3):>9}  {w['condition']}" for w in result["where"]
    ]
    return [*out, "", *result["notes"]]


def effect_lines(parameters: dict[str, dict[str, Any]]) -> list[str]:
    """An effect of few numbers in full; of a stream that varies, or of several voyages, the largest of each
    unit."""
    few = {effect: numbers for effect, numbers in parameters.items() if len(numbers) <= FEW}
    many = ((effect, numbers) for effect, numbers in parameters.items() if effect not in few)
    return number_lines(few) + [
        f"  {effect}: {len(numbers)} numbers, the largest {', '.join(_largest(numbers))}"
        for effect, numbers in many
    ]


def _largest(numbers: dict[str, dict[str, Any]]) -> list[str]:
    """Of the numbers of an effect the largest in each unit, with its name."""
    units = dict.fromkeys(p["unit"] for p in numbers.values())
    each = ({n: p for n, p in numbers.items() if p["unit"] == unit} for unit in units)
    names = (max(alike, key=lambda n: abs(alike[n]["value"])) for alike in each)
    return [_size(n, numbers[n], 2) for n in names]


def number_lines(parameters: dict[str, dict[str, Any]]) -> list[str]:
    """Each number of each effect with its 95 % interval."""
    return [
        f"  {_size(f'{effect}.{n}', p, 4)}   {num(p['low95'], 3)} to {num(p['high95'], 3)}"
        + "   (the end of its box)" * p["at_box_end"]
        for effect, numbers in parameters.items()
        for n, p in ((n, readable(p)) for n, p in numbers.items())
    ]


def _size(name: str, number: Mapping[str, Any], digits: int) -> str:
    told = readable(number)
    return f"{name} = {num(told['value'], digits)} {told['unit']}".rstrip()

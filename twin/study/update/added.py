"""What `twin add` says of its work: the verdict, the notes, the lines on a terminal, and what the ship file
remembers."""

import datetime
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.jsonable import short
from twin.study.reference.nuisance import OF_THE_DAY
from twin.study.reference.sailed import Sailed
from twin.study.update.adding import UNTOUCHED, Found
from twin.study.update.proof import Fall


def verdict(result: dict[str, Any], proof: Fall) -> str:
    """The first sentence: did it fall, from what to what."""
    names = " and ".join(result["added"])
    floor = next(
        row["noise_floor"]["position_mae_m"]
        for row in result["horizons"]
        if row["horizon_s"] == proof.horizon_s
    )
    noise = f" (noise: {floor:.2g} m)" if proof.unit == "m" else ""
    sizes = f"{proof.before:.3g} to {proof.after:.3g} {proof.unit}{noise}"
    if proof.idle:
        return (
            f"{names}: fitted to nothing on these voyages; with it this ship file leads her as it did "
            "without."
        )
    if proof.proved:
        by = 100.0 * (1.0 - proof.after / proof.before)
        return (
            f"With {names} the {proof.measure} falls by {by:.0f} %, from {sizes}, on measurements not "
            "used to fit it."
        )
    change = f"95 % of the change: {proof.low95:+.2g} to {proof.high95:+.2g}"
    head = f"With {names} the {proof.measure} does not fall beyond its noise"
    return f"{head}: {sizes} on measurements not used to fit it ({change})."


def notes(
    ship: Ship, found: Sequence[Found], sailed: Sequence[Sailed], held_out: Sequence[Sailed]
) -> list[str]:
    """What the owner must know to read the numbers."""
    notes = [
        "Only the added effect's numbers were fitted; the core and the effects already there stay as "
        "they were."
    ]
    if not held_out:
        notes.append(
            "No voyage was held out: the last third of each was kept from the fit and used to judge it."
        )
    present = {type(e).__name__ for e in ship.effects}
    notes += [
        f"{n} was in the model already: it was fitted anew."
        for n in sorted({f.effect for f in found} & present)
    ]
    calm = [f"{f.effect}.{f.name}" for f in found if f.gained < UNTOUCHED]
    if calm:
        notes.append(f"The voyages say little about {', '.join(calm)}: kept near what was believed before.")
    notes += _of_the_day({f.effect for f in found}, sailed, held_out)
    return notes


def _of_the_day(names: set[str], sailed: Sequence[Sailed], held_out: Sequence[Sailed]) -> list[str]:
    """A warning when numbers that belong to a voyage are judged by a voyage of another day."""
    bound = sorted(names.intersection(OF_THE_DAY))
    days = [
        {str(s.voyage.meta.get("start_time_utc", "?"))[:10] for s in group} for group in (sailed, held_out)
    ]
    if not bound or len(sailed) + len(held_out) == 1 or (len(days[0] | days[1]) == 1 and "?" not in days[0]):
        return []
    when = "on another day, as far as the files tell" if "?" in days[0] | days[1] else "on another day"
    return [
        f"The numbers of {', '.join(bound)} belong to a voyage; some of these were sailed {when}, where "
        "they need not hold."
    ]


def written(ship: Ship, model: Model, result: dict[str, Any]) -> Ship:
    """The new ship: effects in, every number with its interval, and one more step of her history."""
    notes = dict(ship.notes)
    notes["effects"] = dict(notes.get("effects", {})) | result["parameters"]
    entry = {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "added": result["added"],
        "interval": "95 %",
        "voyages": result["voyages"],
        "held_out": result["held_out"],
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
    notes["history"] = [*notes.get("history", []), short(entry, 4)]
    return replace(ship, effects=model.effects, notes=notes)


def told(result: dict[str, Any]) -> list[str]:
    """The answer on a terminal."""
    out = [
        result["verdict"],
        "",
        f"{'horizon':>8}{'before [m]':>13}{'after [m]':>12}{'noise [m]':>12}"
        f"{'before [deg]':>15}{'after [deg]':>13}",
    ]
    for r in result["horizons"]:
        b, a = r["before"], r["after"]
        out.append(
            f"{r['horizon_s']:>6g} s{b['position_mae_m']:>13.3g}{a['position_mae_m']:>12.3g}"
            f"{r['noise_floor']['position_mae_m']:>12.2g}{b['heading_mae_deg']:>15.2g}{a['heading_mae_deg']:>13.2g}"
        )
    out += ["", "what was fitted (95 %)"]
    for effect, numbers in result["parameters"].items():
        out += [
            f"  {effect}.{n} = {p['value']:.4g} {p['unit']}   {p['low95']:.3g} to {p['high95']:.3g}"
            for n, p in numbers.items()
        ]
    out += ["", "by regime: before, after [m]"] + [
        f"  {w['before_m']:>8.3g}{w['after_m']:>9.3g}  {w['condition']}" for w in result["where"]
    ]
    return [*out, "", *result["notes"]]

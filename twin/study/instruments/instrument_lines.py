"""What was found of the instruments: as JSON, and as lines on a terminal, what is wrong first."""

import math
import textwrap
from collections.abc import Collection, Sequence
from typing import Any

from twin.num import READABLE, as_given, num
from twin.physics.ship import Ship
from twin.study.estimation.rarity import P95
from twin.study.instruments.findings import FAULT_BAYES_FACTOR, InstrumentEstimate, Instruments, instrument_of
from twin.study.instruments.instrument_samples import Readings
from twin.study.instruments.ship_file_numbers import as_filed, held
from twin.study.instruments.unknowns import ALWAYS, FAULTS, INDEX, UNKNOWNS, effect_of

SHOWN = READABLE | {"-": ("%", 100.0)}
PLAIN = ("leeway",)  # no percentage
READ = {
    "place": "m",
    "velocity": "m/s",
    "heading": "rad",
    "rate": "rad/s",
    "log": "m/s",
    "log aside": "m/s",
    "wind": "m/s",
    "drift": "m/s",
}


def as_json(found: Instruments) -> dict[str, Any]:
    """What was found, in SI units and radians (docs/json.md)."""
    return {
        "voyages": [
            {
                "name": r.name,
                "velocity_turned_by": "the receiver" if own else "the compass",
                "instruments": sorted(k for k in r.by if k != "heading at velocity"),
                "scatter": {k: {"value": v, "unit": READ[k]} for k, v in scatter.items()},
                "stream": {k: v.tolist() for k, v in stream.items()},
            }
            for r, own, scatter, stream in zip(
                found.readings, found.own, found.scatter, found.stream, strict=True
            )
        ],
        "faults": [
            {
                "fault": f,
                "effect": effect_of(f),
                "words": FAULTS[f].words,
                "log_bayes_factor": found.log_bayes_factors[f],
                "log_bayes_factor_of_any": found.of_any[f],
                "or_instead": list(found.instead[f]),
                "residuals": {
                    k: {"without": a, "with": b, "unit": READ[k]} for k, (a, b) in found.falls[f].items()
                },
            }
            for f in found.faults
        ],
        "numbers": [_number(e) for e in found.estimates],
        "ages": {
            "prompt": instrument_of(found.clock),
            "reference": found.relative[0],
            "later_s": {k: {"value": v, "sd": sd} for k, (v, sd) in found.relative[1].items()},
        },
    }


def _number(e: InstrumentEstimate) -> dict[str, Any]:
    lo, hi = e.interval
    return {
        "name": e.unknown.name,
        "fault": e.unknown.fault,
        "effect": effect_of(e.unknown.fault),
        "unit": e.unknown.unit,
        "meaning": e.unknown.meaning,
        "seen": e.seen,
        "value": e.value,
        "lo": lo,
        "hi": hi,
        "cramer_rao_sd": e.sd,
        "log_bayes_factor": e.log_bayes_factor if math.isfinite(e.log_bayes_factor) else None,
        "unseen_below": None if e.seen else e.limit,
        "known": e.known,
        "hard_to_tell_from": e.unlike,
        "voyage": e.voyage,
    }


def terminal_lines(found: Instruments, ship: Ship | None = None) -> list[str]:
    """The whole answer, a line each; a fault that the `ship`'s file has as the readings tell it is one line
    behind the others."""
    out, filed = [], as_filed(ship, found)
    for fault in found.faults:
        if fault not in filed:
            out += _fault(found, fault) + _known(found, fault, ship)
    if not out:
        out.append(f"{nothing_new(filed)}.")
    if ship:
        out += [
            f"{_called(f)}: as the ship file has it within 95 % ({_in_file(found, f, ship)})" for f in filed
        ]
    out += ["", "stream, in the middle of each voyage"]
    out += [
        f"  {e.voyage}: {e.unknown.name.removeprefix('current_')} {_sized(e)}"
        for e in found.estimates
        if e.unknown.fault == "current"
    ]
    others = {*ALWAYS, *found.faults, *(f for named in found.instead.values() for f in named)}
    unseen = [e for e in found.estimates if e.unknown.fault not in others]
    out += ["", "not seen (95 %: less than)"] + [
        f"  {e.unknown.meaning}: {_limit(e)}" for e in unseen if e.known
    ]
    out += _unknown([e for e in found.estimates if not e.known and e.unknown.fault not in found.faults])
    untold = [
        f.words for name, f in FAULTS.items() if name not in (*ALWAYS, found.clock, *found.log_bayes_factors)
    ]
    out += textwrap.wrap(f"not observable from these readings: {'; '.join(untold)}", 110) if untold else []
    reference, later = found.relative
    out += [
        "",
        f"later than {reference} (velocity: than position); none is early, so the earliest is taken "
        "for prompt",
    ]
    out += [f"  {k}: {v:.2f} s (+- {P95 * sd:.2f})" for k, (v, sd) in later.items()]
    return out + [turned_by(r, own) for r, own in zip(found.readings, found.own, strict=True)]


def turned_by(r: Readings, own: bool) -> str:
    """Whose attitude turned a voyage's velocity over ground, where one was measured."""
    if "velocity" not in r.by:
        return f"{r.name}: no velocity over ground was measured"
    return (
        f"{r.name}: velocity over ground was turned by "
        f"{'an attitude of the receiver' if own else 'the compass'}"
    )


def either(fault: str, instead: Sequence[str]) -> str:
    """A fault in words, and what may be there in its place."""
    return FAULTS[fault].words + _or(instead)


def nothing_new(filed: Sequence[str]) -> str:
    """Where no fault is seen but these, which the ship file has: what to say of it."""
    more = ", but for what the ship file has" if filed else ""
    return f"No instrument disagrees with the others beyond its noise{more}"


def as_it_is(fault: str) -> str:
    """Of a fault that the ship file has as the readings tell it: why it is not written."""
    return f"{FAULTS[fault].words} is as the ship file has it"


def ambiguities(found: Instruments, filed: Collection[str] = ()) -> list[str]:
    """Of each fault seen that the voyages do not tell from another, and that therefore is written nowhere:
    from which, and what would tell, a line each; of one that the ship file has (`filed`), none."""
    out = []
    for fault, instead in found.instead.items():
        if instead and fault not in filed:
            turns = dict.fromkeys(FAULTS[x].turn for x in (fault, *instead))
            out.append(
                f"these voyages do not tell {FAULTS[fault].words} from {_all(instead)}, and neither is "
                f"written; sail {', and '.join(turns)}, and ask all voyages together"
            )
    return out


def _or(instead: Sequence[str]) -> str:
    return f" or {_all(instead)}" if instead else ""


def _all(faults: Sequence[str]) -> str:
    return " and ".join(FAULTS[f].words for f in faults)


def _called(fault: str) -> str:
    """A fault in words, with its effect of the catalogue."""
    effect = effect_of(fault)
    return FAULTS[fault].words + (f" ({effect})" if effect else "")


def _fault(found: Instruments, fault: str) -> list[str]:
    f, numbers = FAULTS[fault], [e for e in found.estimates if e.unknown.fault == fault]
    head = _called(fault) + _or(found.instead[fault]) + f": log Bayes factor {num(found.of_any[fault], 3)}"
    out = [head] + [f"  {e.unknown.name:<18}{_sized(e)}   {e.unknown.meaning}" for e in numbers]
    if found.instead[fault]:
        out.append(
            "  these voyages do not tell which: log Bayes factor of the first against the other "
            f"{num(found.log_bayes_factors[fault], 3)} (told above {as_given(FAULT_BAYES_FACTOR)})"
        )
    if untold := [e.unknown.meaning for e in numbers if not e.known]:
        out += textwrap.wrap(
            "only if nothing else is wrong: beside all other faults these voyages do not tell "
            f"{', '.join(untold)} (sail {f.turn})",
            110,
            initial_indent="  ",
            subsequent_indent="    ",
        )
    falls = [f"{k} {amount(a, READ[k])} -> {amount(b, READ[k])}" for k, (a, b) in found.falls[fault].items()]
    return out + ([f"  shown by the residuals of {', '.join(falls)}"] if falls else [])


def _known(found: Instruments, fault: str, ship: Ship | None) -> list[str]:
    """What the ship file has of the fault's numbers already, other than these readings tell it."""
    told = _in_file(found, fault, ship) if ship else ""
    return [f"  in the ship file already: {told}"] if told else []


def _in_file(found: Instruments, fault: str, ship: Ship) -> str:
    return ", ".join(
        f"{h.parameter} {amount(h.value, h.estimate.unknown.unit)}" for h in held(ship, found, fault)
    )


def amount(value: float, unit: str) -> str:
    """A number of this SI unit as it is told: angles in degrees, shares in percent."""
    name, k = SHOWN.get(unit, (unit, 1.0))
    return f"{num(value * k, 3)} {name}"


def _sized(e: InstrumentEstimate) -> str:
    name, k = ("", 1.0) if e.unknown.name in PLAIN else SHOWN.get(e.unknown.unit, (e.unknown.unit, 1.0))
    lo, hi = e.interval
    return f"{num(e.value * k, 3)} {name} (95 %: {num(lo * k, 3)} to {num(hi * k, 3)})"


def _limit(e: InstrumentEstimate) -> str:
    name, k = ("", 1.0) if e.unknown.name in PLAIN else SHOWN.get(e.unknown.unit, (e.unknown.unit, 1.0))
    return f"{num(e.limit * k)} {name}"


def _unknown(numbers: list[InstrumentEstimate]) -> list[str]:
    """What these voyages cannot say beside all else, what it is hard to tell from, and what would show it."""
    if not numbers:
        return []
    out = ["", "not known beside all others from these voyages"]
    for e in numbers:
        beside = f", hard to tell from {UNKNOWNS[INDEX[e.unlike]].meaning}" if e.unlike else ""
        out += textwrap.wrap(
            f"  {e.unknown.meaning}{beside}; sail {FAULTS[e.unknown.fault].turn}",
            110,
            subsequent_indent="    ",
        )
    return out

"""What was found, written where it takes effect: as instrument effects of a ship file, or as the lines of a
map."""

import datetime
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import degrees
from typing import Any, cast

from twin.errors import SettingsError
from twin.num import as_given, num
from twin.physics.effect import Effect, SensorFault
from twin.physics.effects import catalogue
from twin.physics.ship import Ship
from twin.study.estimation.rarity import P95
from twin.study.instruments.findings import InstrumentEstimate, Instruments
from twin.study.instruments.instrument_lines import amount
from twin.study.instruments.ship_file_numbers import as_filed
from twin.study.instruments.unknowns import INDEX, UNKNOWNS
from twin.study.reference.derivatives import noted

OFFSETS = {
    "A": ("heading_true_north_deg", degrees(1.0)),
    "gyro_bias": ("yaw_rate_degps", degrees(1.0)),
    "log_bias": ("surge_velocity_through_water_mps", 1.0),
}


def corrected(ship: Ship, found: Instruments) -> tuple[Ship, list[InstrumentEstimate]]:
    """The ship with the faults that were seen, and told from every other, as effects of its own (those that
    its file has as the readings tell them stay: it may rest on more voyages); and those of their numbers that
    no effect of the catalogue holds, or that lie outside the box of theirs."""
    filed = as_filed(ship, found)
    numbers = [e for e in _distinct(found) if e.unknown.fault not in filed]
    known, names = effects_of_readings(), [r.name for r in found.readings]
    left = [e for e in numbers if e.unknown.name not in known]
    for effect in dict.fromkeys(known[e.unknown.name] for e in numbers if e not in left):
        its = [e for e in numbers if known.get(e.unknown.name) is effect]
        told = {e.unknown.name: (e.value, e.sd) for e in its}
        try:
            ship = with_numbers(ship, told, all(found.own), names)
        except SettingsError:  # outside what this effect can be
            left += its
    return ship, left


def with_numbers(
    ship: Ship, told: Mapping[str, tuple[float, float]], own: bool, voyages: Sequence[str]
) -> Ship:
    """The ship with these numbers that the readings tell (value, sd) as effects of its instruments, each in
    the place of what it had. `own`: whether the receiver turned its velocity itself; `voyages`: where they
    are from."""
    effects: dict[str, Effect] = {type(e).__name__: e for e in ship.effects}
    entries: dict[str, Any] = {}
    source = f"kinematics of {', '.join(voyages)}, {datetime.date.today().isoformat()}"
    known = effects_of_readings()
    for number, (value, sd) in told.items():
        name, parameter = known[number].__name__, known[number].by_readings[number]
        fault = cast(SensorFault, effects.get(name) or known[number].absent(ship))
        effects[name] = _boxed(fault.as_read(number, value, own), ship)
        entry = {
            "value": float(getattr(effects[name], parameter)),
            "unit": UNKNOWNS[INDEX[number]].unit,
            "sd": sd,
            "source": source,
        }
        entries.setdefault(name, {})[parameter] = entry
    return noted(replace(ship, effects=tuple(effects.values())), "effects", entries)


def effects_of_readings() -> dict[str, type[SensorFault]]:
    """The instruments' effect of the catalogue that holds each number that the readings tell."""
    faults = [e for e in catalogue().values() if issubclass(e, SensorFault)]
    return {number: e for e in reversed(faults) for number in e.by_readings}


def _distinct(found: Instruments) -> list[InstrumentEstimate]:
    """The numbers of the faults that were seen and that the voyages tell from every other."""
    return [e for e in found.estimates if e.seen and e.unknown.fault in found.distinct]


def _boxed(effect: Effect, ship: Ship) -> Effect:
    """The effect, or a SettingsError that says which number no ship file can hold."""
    effect.check(ship, "what was found, ")
    return effect


def as_map(found: Instruments) -> str:
    """The lines of a map that take constants off; what a map cannot say stands in it as a comment. Each
    offset is in the unit of its channel. SettingsError: no constant that a map can take off was seen, and
    told from every other fault."""
    lines = [
        "# Found by `twin instruments`: add each `offset` to the line of that channel in your own map "
        "(docs/import.md).",
        "[columns]",
    ]
    said = [e for e in _distinct(found) if e.unknown.name in OFFSETS]
    for e in said:
        channel, k = OFFSETS[e.unknown.name]
        entry = f'{channel} = {{ column = "{channel}", offset = {as_given(-e.value * k, 6)} }}'
        lines.append(f"{entry}  # +- {num(P95 * e.sd * k, 2)}")
    for e in _distinct(found):
        if e not in said:
            lines.append(
                f"# {e.unknown.name} = {amount(e.value, e.unknown.unit)}: a map cannot take it off; a "
                "ship file can (--ship ... -o SHIP.toml)"
            )
    if not said:
        raise SettingsError(
            "nothing was found that a map can take off (a constant of heading, rate of turn "
            "or log). Give --ship, and -o SHIP.toml."
        )
    return "\n".join(lines) + "\n"

"""What was found, written where it takes effect: as instrument effects of a ship file, or as the lines of a
map."""

import datetime
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from twin.errors import SettingsError
from twin.physics.effect import Effect
from twin.physics.effects import find
from twin.physics.ship import Ship
from twin.study.instruments.findings import InstrumentEstimate, Instruments
from twin.study.instruments.unknowns import INDEX, UNKNOWNS
from twin.study.reference.derivatives import noted

PARAMETERS = {  # number -> effect, parameter, and the one that says by what the velocity was turned
    "gnss_delay": ("SensorDelay", "delay", "turned"),
    "smoothing": ("ReceiverSmoothing", "time", None),
    "heading_delay": ("HeadingLag", "lag", "turned"),
    "A": ("HeadingBias", "bias", "turned"),
    "B": ("CompassDeviation", "B", None),
    "C": ("CompassDeviation", "C", None),
    "D": ("CompassDeviation", "D", None),
    "E": ("CompassDeviation", "E", None),
    "gyro_bias": ("GyroBias", "bias", None),
    "log_scale": ("SpeedLogScale", "scale", None),
    "log_bias": ("SpeedLogBias", "bias", None),
    "log_angle": ("SpeedLogMisalignment", "angle", None),
    "antenna_ahead": ("AntennaOffset", "ahead", None),
    "antenna_starboard": ("AntennaOffset", "starboard", None),
    "antenna_above": ("AntennaOffset", "above", None),
}
OFFSETS = {
    "A": ("heading_true_north_deg", 57.29577951308232),
    "gyro_bias": ("yaw_rate_degps", 57.29577951308232),
    "log_bias": ("surge_velocity_through_water_mps", 1.0),
}


def corrected(ship: Ship, found: Instruments) -> tuple[Ship, list[InstrumentEstimate]]:
    """The ship with the faults that were seen as effects of its own; and the seen numbers that no effect of
    the catalogue holds."""
    seen = _seen(found)
    told = {e.unknown.name: (e.value, e.sd) for e in seen if e.unknown.name in PARAMETERS}
    left = [e for e in seen if e.unknown.name not in PARAMETERS]
    return with_numbers(ship, told, all(found.own), [r.name for r in found.readings]), left


def with_numbers(
    ship: Ship, told: Mapping[str, tuple[float, float]], own: bool, voyages: Sequence[str]
) -> Ship:
    """The ship with these numbers of PARAMETERS (value, sd) as effects of its instruments, each in the place
    of what it had. `own`: whether the receiver turned its velocity itself; `voyages`: where they are from."""
    effects: dict[str, Effect] = {type(e).__name__: e for e in ship.effects}
    entries: dict[str, Any] = {}
    source = f"kinematics of {', '.join(voyages)}, {datetime.date.today().isoformat()}"
    for number, (value, sd) in told.items():
        name, parameter, turned = PARAMETERS[number]
        effect = effects.get(name) or find(name).absent(ship)
        values = {parameter: value} | ({turned: 0.0 if own else value} if turned else {})
        if name == "CompassDeviation":
            values["turned"] = 0.0 if own else 1.0
        effects[name] = _boxed(effect.but(**values), ship)
        entry = {
            "value": float(getattr(effects[name], parameter)),
            "unit": UNKNOWNS[INDEX[number]].unit,
            "sd": sd,
            "source": source,
        }
        entries.setdefault(name, {})[parameter] = entry
    return noted(replace(ship, effects=tuple(effects.values())), "effects", entries)


def _seen(found: Instruments) -> list[InstrumentEstimate]:
    return [e for e in found.estimates if e.seen and e.unknown.fault in found.faults]


def _boxed(effect: Effect, ship: Ship) -> Effect:
    """The effect, or a SettingsError that says which number no ship file can hold."""
    effect.check(ship, "what was found, ")
    return effect


def as_map(found: Instruments) -> str:
    """The lines of a map that take constants off; what a map cannot say stands in it as a comment."""
    lines = [
        "# Found by `twin instruments`: add each `offset` to the line of that channel in your own map "
        "(docs/import.md).",
        "[columns]",
    ]
    said = [e for e in _seen(found) if e.unknown.name in OFFSETS]
    for e in said:
        channel, k = OFFSETS[e.unknown.name]
        lines.append(
            f'{channel} = {{ column = "{channel}", offset = {-e.value * k:.6g} }}  # +- {1.96 * e.sd * k:.2g}'
        )
    for e in _seen(found):
        if e not in said:
            lines.append(
                f"# {e.unknown.name} = {e.value:.6g} {e.unknown.unit}: a map cannot take it off; a "
                "ship file can (--ship ... -o SHIP.toml)"
            )
    if not said:
        raise SettingsError(
            "nothing was found that a map can take off (a constant of heading, rate of turn "
            "or log). Give --ship, and -o SHIP.toml."
        )
    return "\n".join(lines) + "\n"

"""What a calibration found of the core, what the ship file keeps of it, and what --json holds."""

import datetime
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from twin.physics.effect import Effect
from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.study.calibration.parts import WEATHER
from twin.study.calibration.usual import significantly_there
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.start import waves_on
from twin.study.reference.derivatives import KEPT, UNEXCITED, Derivative, noted
from twin.study.reference.sailed import Sailed
from twin.study.reference.steering_gear import gears_of
from twin.study.reference.weather_baseline import FAINT
from twin.study.track.jumps import jumps_on
from twin.study.track.track import Track

SCHEMA_VERSION = 1
# of the ship and not of the core, found with it; their numbers stand under these keys in --json
PARTS = {role: of_role(role) for role in ("gear", "antenna", "wind", "shallow_water", "compass")}


def searched_parts(ship: Ship) -> tuple[type[Effect], ...]:
    """Of the ship and not of the core, and found by the probability of the voyages (the antenna: by
    predictions): its steering gear or its actuators' lags, wind and shallow water."""
    return (*(gear for gears in gears_of(ship) for gear in gears), *WEATHER)


@dataclass(frozen=True)
class Core:
    """What a filter one step ahead makes of the voyages: the derivatives, and what they leave over."""

    tracks: list[Track]  # with the swing in waves, where they showed
    model: Model
    derivatives: list[Derivative]
    # of the ship file; gears and wind among them if the voyages asked for these
    effects: tuple[Effect, ...]
    # of the parts that were searched and of the antenna, with their standard errors
    numbers: dict[str, dict[str, dict[str, Any]]]
    searched: tuple[type[Effect], ...]
    antenna: Effect | None  # where it was found, if not where the ship file has it
    noise_model: NoiseModel
    temper: float

    @property
    def unexcited(self) -> list[str]:
        """Derivatives of which the voyages say nothing."""
        return [n for d in self.derivatives if not d.excited for n in d.unknown.names]


def sourced(width: float, sd: float, why: str) -> str:
    """Where a number of a part comes from: `why`, or its prior, where the voyages took hardly anything away
    of that prior's variance (as of a derivative). `width`: the prior's standard deviation, `sd` what is left
    of it."""
    today = datetime.date.today().isoformat()
    return KEPT if 1.0 - (sd / width) ** 2 < UNEXCITED else f"calibrated {today}: {why}"


def remembering(ship: Ship, core: Core, fitted: Sequence[Sailed]) -> Ship:
    """The ship with what remains of these voyages, in place of what an earlier calibration left."""
    today, voyages = datetime.date.today().isoformat(), [s.provenance() for s in fitted]
    # tomorrow's wind is another one
    names = [type(e).__name__ for e in ship.effects if not e.of_recorded_weather()]
    structural = {
        "floor": plain(asdict(core.noise_model)),
        "temper": core.temper,
        "date": today,
        "voyages": voyages,
        "beside_effects": names,
    }
    after = noted(
        ship,
        "effects",
        {
            name: _given(ship, name, numbers) | numbers
            for name, numbers in core.numbers.items()
            if numbers and _found_here(name, ship, core)
        },
    )
    return replace(after, notes={**after.notes, "structural": structural})


def _given(ship: Ship, name: str, found: Mapping[str, Any]) -> dict[str, Any]:
    """What the ship file says of those numbers of a part that were not found here."""
    entries = ship.notes.get("effects", {}).get(name, {})
    return {k: entry for k, entry in entries.items() if k not in found}


def _found_here(name: str, ship: Ship, core: Core) -> bool:
    """Whether a part of it is in the ship file as this calibration found it."""
    return any(
        type(e).__name__ == name and (type(e) in core.searched or e == core.antenna) for e in ship.effects
    )


def record(ship: Ship, after: Ship, core: Core, way: str, held_out: list[dict[str, Any]]) -> dict[str, Any]:
    """What --json holds. `way`: one of FITTED_BY; `held_out`: errors by horizon."""
    lasting_ones = after.notes["structural"]
    lags = [e.__name__ for e in searched_parts(ship) if e not in PARTS.values()]
    return {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "derivatives": [_row(d, n, ship, after) for d in core.derivatives for n in d.unknown.names],
        "unexcited": core.unexcited,
        "fitted_by": way,
        **{key: _said(owner.__name__, after, core) for key, owner in PARTS.items()},
        "actuator_lags": {name: n for name in lags if (n := _said(name, after, core))},
        "waves": waves_on(core.tracks),
        "jumps": jumps_on(core.tracks),
        "too_faint": [name for name, felt in lasting_ones["weather"].items() if felt > FAINT],
        "usual": significantly_there(after, lasting_ones),
        "between_voyages": lasting_ones["between_voyages"],
        "floor": asdict(core.noise_model),
        "temper": core.temper,
        "by_regime": lasting_ones["by_regime"],
        "held_out": held_out,
    }


def _said(owner: str, after: Ship, core: Core) -> dict[str, dict[str, Any]]:
    """The numbers of a part of it that this calibration measured and put into the ship file; one that keeps
    its prior was not measured."""
    numbers = core.numbers.get(owner, {}) if _found_here(owner, after, core) else {}
    measured = {name: number for name, number in numbers.items() if number["source"] != KEPT}
    return {name: {k: v for k, v in number.items() if k != "source"} for name, number in measured.items()}


def _row(d: Derivative, name: str, ship: Ship, after: Ship) -> dict[str, Any]:
    before, value = (float(s.derivative(name)) for s in (ship, after))
    return {
        "name": name,
        "before": before,
        "value": value,
        "sd": d.sd,
        "unit": d.unknown.unit,
        "excited": d.excited,
    }

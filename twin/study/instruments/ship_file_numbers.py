"""What a ship file has already of what the readings tell."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.physics.effect import SensorFault
from twin.physics.ship import Ship
from twin.study.estimation.rarity import P95, deviations
from twin.study.instruments.findings import InstrumentEstimate, Instruments


@dataclass(frozen=True)
class HeldNumber:
    """A number as the readings tell it (`estimate`) and as the ship file has it: the `parameter` of its
    effect, `value` and `sd` (0: the file says none, for the owner knows it), in the number's own unit."""

    estimate: InstrumentEstimate
    parameter: str
    value: float
    sd: float

    @property
    def distance(self) -> float:
        """How far the one is from the other, in standard deviations of both."""
        return (self.estimate.value - self.value) / float(np.hypot(self.estimate.sd, self.sd))


def held(ship: Ship, found: Instruments, fault: str) -> list[HeldNumber]:
    """The numbers of a fault that effects of the ship file hold."""
    out = []
    for effect in (e for e in ship.effects if isinstance(e, SensorFault)):
        entries = ship.notes.get("effects", {}).get(type(effect).__name__, {})
        for e in found.estimates:
            if e.unknown.fault == fault and (parameter := effect.by_readings.get(e.unknown.name)):
                sd = _sd(entries.get(parameter))
                out.append(HeldNumber(e, parameter, float(getattr(effect, parameter)), sd))
    return out


def as_filed(ship: Ship | None, found: Instruments) -> list[str]:
    """The faults seen that the ship file has: all its numbers together within 95 % of what the readings and
    the file leave open. None where there is no ship."""
    return [f for f in found.faults if _agrees(held(ship, found, f))] if ship else []


def _agrees(numbers: list[HeldNumber]) -> bool:
    off = np.array([n.distance for n in numbers])
    return off.size > 0 and deviations(off, np.eye(off.size)) <= P95


def _sd(entry: Any) -> float:
    return float(entry["sd"]) if isinstance(entry, Mapping) and "sd" in entry else 0.0

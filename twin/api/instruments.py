"""`twin.instruments`: what is wrong with the instruments, by how their readings go together."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from twin.api.result import Progress, Result, quietly
from twin.api.voyages import several
from twin.errors import UsageError
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.instruments.corrections import as_map, corrected
from twin.study.instruments.estimate import Instruments, estimate
from twin.study.instruments.told import amount, as_json, told

FRAMES = {"compass": "course", "receiver": "body"}  # who turned the velocity -> the frame it came in


@dataclass(frozen=True, repr=False)
class InstrumentCheck(Result):
    """What is wrong with compass, log, receiver, gyro and vane. Its rows are the numbers: value, 95 %
    interval, whether it was seen, and what these voyages cannot tell."""

    found: Instruments = field(repr=False)

    @property
    def faults(self) -> list[str]:
        """The faults that were seen, by the names of docs/instruments.md."""
        return [str(f["fault"]) for f in self.data["faults"]]

    @property
    def effects(self) -> list[str]:
        """The same as effects of the catalogue; a fault that no effect describes is left out."""
        return list(dict.fromkeys(f["effect"] for f in self.data["faults"] if f["effect"]))

    def corrected(self, ship: Ship) -> Ship:
        """The ship with the faults that were seen as effects of its instruments. SettingsError when a number
        lies outside its effect's box."""
        return corrected(ship, self.found)[0]

    def not_held(self, ship: Ship) -> list[str]:
        """The numbers that were seen and that no effect of the catalogue holds, each with its size and
        unit."""
        left = corrected(ship, self.found)[1]
        return [f"{e.unknown.meaning} ({amount(e.value, e.unknown.unit)})" for e in left]

    def as_map(self) -> str:
        """The lines of a map that take the constants off that were seen. SettingsError when there are
        none."""
        return as_map(self.found)

    def text(self) -> list[str]:
        """The lines of `twin instruments`."""
        return told(self.found)

    def _rows(self) -> Any:
        return self.data["numbers"]

    def __repr__(self) -> str:
        voyages = ", ".join(v["name"] for v in self.data["voyages"])
        return f"<InstrumentCheck of {voyages}: {', '.join(self.faults) or 'no fault seen'}>"

    def page(self) -> str:
        """The lines of the terminal as a page."""
        from html import escape

        return f"<!doctype html><meta charset=utf-8><pre>{escape(chr(10).join(self.text()))}</pre>"


def instruments(
    ship: Ship | None,
    voyages: Voyage | Iterable[Voyage],
    *,
    velocity_by: str | None = None,
    progress: Progress | None = None,
) -> InstrumentCheck:
    """Ask whether position, velocity, heading, rate of turn, log and wind of these voyages agree, without
    rudder, shaft or model (`read_voyage(..., controls=False)`).

    Of the `ship` only the length is used: how far off an antenna may be; None: nothing is known of it.
    `velocity_by`: what turned the velocity over ground into the ship's axes, "compass" or "receiver"; else as
    recorded, or as the readings say. DataError when a voyage cannot be used; UsageError for another
    `velocity_by`. Seconds to minutes.
    """
    if velocity_by not in (None, *FRAMES):
        raise UsageError(
            f"velocity_by={velocity_by!r}: give {' or '.join(map(repr, FRAMES))}, or leave it out."
        )
    asked = several(voyages)
    if velocity_by:
        asked = [v.with_meta(velocity_frame=FRAMES[velocity_by]) for v in asked]
    found = estimate(asked, float(ship.L_pp) if ship else None, quietly(progress))
    said = {"schema_version": 1, "ship": ship.name if ship else None} | as_json(found)
    return InstrumentCheck(found, data=plain(said))

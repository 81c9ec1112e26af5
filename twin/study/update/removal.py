"""`twin remove`: take an effect out of a ship's model again; its history remembers both."""

import datetime
from collections.abc import Sequence
from dataclasses import replace

from twin.errors import SettingsError, did_you_mean
from twin.physics.ship import Ship

SCHEMA_VERSION = 1


def remove(ship: Ship, names: Sequence[str]) -> Ship:
    """The ship without these effects; SettingsError when it has no such effect."""
    present = [type(e).__name__ for e in ship.effects]
    for name in names:
        if name not in present:
            has = did_you_mean(name, present) if present else " It has no effects at all."
            raise SettingsError(f"{ship.name} has no effect {name!r}.{has}")
    notes = dict(ship.notes)
    notes["effects"] = {k: v for k, v in notes.get("effects", {}).items() if k not in names}
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    notes["history"] = [*notes.get("history", []), {"date": today, "removed": list(names)}]
    return replace(ship.without_effects(*names), notes=notes)

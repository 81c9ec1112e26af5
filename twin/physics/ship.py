"""A ship, and how its file is read and written."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from twin import whole

from . import ship_file, ship_text
from .particulars import DERIVATIVES, PARTICULARS, Derivatives, ShipNumbers
from .ship_file import bundled, load_actuators
from .ship_text import save, text, to_table

__all__ = [
    "DERIVATIVES",
    "PARTICULARS",
    "Derivatives",
    "Ship",
    "bundled",
    "from_table",
    "load",
    "load_actuators",
    "save",
    "text",
    "to_table",
]


@dataclass(frozen=True, repr=False)
class Ship(ShipNumbers):
    """Everything the model knows of one ship; a file of it is read with `load` and written with `save`."""

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """The ship of a file, or a bundled one by its bare name; SettingsError says what is wrong."""
        return ship_file.load(cls, path, arrays=True)

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the ship file, whole or not at all; SettingsError when it would write over a file and `force`
        is not set."""
        whole.not_over(str(path), force)
        ship_text.save(self, path)


def load(path: str | os.PathLike[str], arrays: bool = True) -> Ship:
    """Read a ship file (or a bundled ship by its bare name, such as `kvlcc2`); SettingsError says what is
    wrong and where. `arrays`: also the long arrays that calibration left beside it, which the study reads and
    nothing on board does."""
    return ship_file.load(Ship, path, arrays)


def from_table(table: Mapping[str, Any], where: str = "") -> Ship:
    """A ship from the content of its file; `where` begins every complaint."""
    return ship_file.from_table(Ship, table, where)

"""Whether the place is measured elsewhere on board than the ship file says: then where is a part of the ship.

Nothing is wrong on a reference voyage, so an antenna that clearly stands elsewhere was never where the file has it (a receiver that
reports her centre of gravity, a lever arm left at zero). Kept in mind alone it would leave every prediction off by how she swings.
"""

from dataclasses import replace

from twin.physics.effects.antenna_offset import AntennaOffset
from twin.physics.model import Model
from twin.physics.ship import Ship

from .fit import Fit
from .held_out import HeldOut, errors, size

CLEAR = 4.0  # standard errors
BETTER = 0.05  # share by which predictions of what was not used for the fit must be better with it


def clearly(found: Fit) -> AntennaOffset | None:
    """Where the antenna was found, if that is clearly not where the fit began."""
    numbers = [(u, v, sd) for u, v, sd in zip(found.unknowns, found.value, found.sd, strict=True) if u.owner == AntennaOffset.__name__]
    if not any(abs(v - u.centre) > CLEAR * sd for u, v, sd in numbers):
        return None
    return AntennaOffset(**{u.name: float(v) for u, v, _ in numbers})


def placed(ship: Ship, antenna: AntennaOffset | None, held_out: HeldOut) -> Ship:
    """The ship with her antenna there, if so she is predicted better."""
    if antenna is None:
        return ship
    moved = replace(ship, effects=(*(e for e in ship.effects if not isinstance(e, AntennaOffset)), antenna))
    before, after = (size(errors(Model.of(s), held_out)) for s in (ship, moved))
    return moved if after < before - BETTER else ship

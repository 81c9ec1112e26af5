"""What a calibration left in the ship file, and one line where it is damaged."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import inf

from twin.errors import SettingsError

from .ship import Ship


@contextmanager
def read_from(ship: Ship, part: str) -> Iterator[None]:
    """While a part of it is read. SettingsError: the file does not hold it as it was written."""
    try:
        yield
    except (TypeError, ValueError, KeyError, IndexError, AttributeError) as error:
        raise SettingsError(
            f"{ship.name}: {part} in the ship file is damaged ({error}). Calibrate it again."
        ) from None


def positive(value: object) -> float:
    """A finite number above zero. ValueError, TypeError: it is none."""
    number = float(value)  # type: ignore[arg-type]
    if not 0.0 < number < inf:
        raise ValueError(f"{value} is not above zero")
    return number


def known_to_owner(ship: Ship, effect: str, number: str) -> bool:
    """Whether the owner knows a number of an effect: the ship file has it without a standard error, as no fit
    does."""
    entry = ship.notes.get("effects", {}).get(effect, {}).get(number)
    return entry is not None and not (isinstance(entry, Mapping) and "sd" in entry)

"""How a number of a ship is declared: value, unit, range, meaning and the width of its prior."""

from dataclasses import field
from typing import Any


def number(
    default: float | None, unit: str, lo: float, hi: float, doc: str, sd: float = 0.0, **more: Any
) -> Any:
    """A number of the ship: value, unit, the range outside which it is a mistake, meaning, width of its
    prior."""
    return field(
        default=default,
        metadata={"unit": unit, "lo": lo, "hi": hi, "doc": doc, "sd": sd, **more},
        kw_only=True,
    )

"""Results in the types that JSON knows."""

import math
from typing import Any

import numpy as np


def plain(value: Any) -> Any:
    """The same in types that JSON knows; what is not finite becomes null."""
    if isinstance(value, dict):
        return {k: plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value.item() if isinstance(value, np.generic) else value


def short(value: Any, digits: int = 6) -> Any:
    """The same with every number of fractions rounded to so many digits: what a person may read in a ship
    file."""
    if isinstance(value, dict):
        return {k: short(v, digits) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [short(v, digits) for v in value]
    return float(f"{value:.{digits}g}") if isinstance(value, float) else value

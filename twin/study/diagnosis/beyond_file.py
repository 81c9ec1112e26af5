"""Weather whose strength the ship's file knows, and that is another today than what the calibration found:
wind pushes the same ship by the same coefficients, so that something else may act like it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from twin.physics.ship import Ship
from twin.study.estimation.rarity import P95

BEYOND = (
    3.0  # standard deviations of both together: one day in 370 by chance; not fitted, and decides nothing
)


def beyond_file(ship: Ship, effect: str, parameters: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Numbers of an effect as the ship's file has them, each with its standard deviation there (both in its
    own unit), of those that today's `parameters` are farther from than chance has it; none where nobody
    calibrated them."""
    noted = ship.notes.get("effects", {}).get(effect, {})
    filed = next((e.values() for e in ship.effects if type(e).__name__ == effect), {})
    out = []
    for p in parameters:
        sd = noted.get(p["name"], {}).get("sd") if p["name"] in filed else None
        if sd is None:
            continue
        # the wider side: the other end may be that of its box
        today = max(p["high95"] - p["value"], p["value"] - p["low95"]) / P95
        value = float(filed[p["name"]])
        if abs(p["value"] - value) > BEYOND * float(np.hypot(sd, today)):
            out.append({"name": p["name"], "value": value, "sd": float(sd), "unit": p["unit"]})
    return out

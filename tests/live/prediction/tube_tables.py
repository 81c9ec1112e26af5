"""A [tube] as `twin tube` writes it, with round numbers, in a ship's file."""

from dataclasses import replace

from twin.live.learning.residual import ship_hash
from twin.live.prediction.circumstances import NAMES

N = len(NAMES)
LEVELS = (0.8, 0.9, 0.96)


def table(ship, **changes):
    """A [tube] as `twin tube` writes it, with round numbers."""
    found = {
        "level": 0.9,
        "voyages": 20,
        "model": ship_hash(ship),
        "source": "by hand",
        "seas": ["slight", "rough"],
        "horizons_s": [10.0, 60.0, 120.0],
        "levels": list(LEVELS),
        "lowest": [1.0] + [0.0] * 5 + [-5.0] * 4,
        "highest": [1.0] + [5.0] * 5 + [3.0] * 4,
    }
    for h in (10, 60, 120):
        found |= {f"{axis}_{h}s": [0.0] * N for axis in ("along", "across", "heading")}
        found[f"cell_{h}s_all"] = {"voyages": 20, "place": [1.0, 2.0, 4.0], "heading": [1.0, 1.5, 3.0]}
    return found | changes


def with_tube(ship, **changes):
    return replace(ship, notes={**ship.notes, "tube": table(ship, **changes)})

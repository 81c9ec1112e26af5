"""What was found of a prediction tube, as numbers for people and programs."""

from collections.abc import Mapping, Sequence
from math import degrees, sqrt
from typing import Any

import numpy as np

from twin.live.observer.predict import usual_error
from twin.live.prediction.calibrated import RegionTable
from twin.live.prediction.judge import VerifiedPrediction
from twin.num import num
from twin.physics.ship import Ship
from twin.study.reference.foretold import Errors
from twin.study.reference.tube_calibration import regimes


def rows(ship: Ship, table: RegionTable, voyages: Sequence[Errors]) -> list[dict[str, Any]]:
    """One row a horizon: what is promised, how wide the tube is in the mean, and the same by regime."""
    out = []
    for h, horizon in table.horizons.items():
        usual = usual_error(ship, h)
        sizes = [(j, *half_widths(table, h, j, (usual[0], usual[1]))) for v in voyages for j in v[h]]
        level = table.promise(horizon.cells["all"])
        by_regime = [
            {"regime": name, "voyages": cell.voyages} | _mean([s for s in sizes if name in regimes(s[0])])
            for name, cell in horizon.cells.items()
            if name != "all"
        ]
        out.append(
            {"horizon_s": h, "level": level, "voyages": horizon.cells["all"].voyages}
            | _mean(sizes)
            | {"regimes": by_regime}
        )
    return out


def half_widths(
    table: RegionTable, h: float, j: VerifiedPrediction, usual: tuple[float, float]
) -> tuple[float, float]:
    """Radius of the place's circle of the same area [m] and half width of the heading [rad]."""
    along, across, heading = table.sigmas(h, j.foretold.known, usual)
    _, cell = table.cell(h, j.foretold.known)
    place, turning = (table.quantile(of, table.level) for of in (cell.place, cell.heading))
    return place * sqrt(along * across), turning * heading


def _mean(sizes: Sequence[tuple[VerifiedPrediction, float, float]]) -> dict[str, float | int]:
    place, heading = (float(np.mean([s[k] for s in sizes])) for k in (1, 2))
    return {"predictions": len(sizes), "place_m": place, "heading_deg": degrees(heading)}


def terminal_lines(result: Mapping[str, Any]) -> list[str]:
    """The lines of the terminal."""
    lines = [f"{result['ship']}: tube around its predictions, from {len(result['voyages'])} voyages"]
    for row in result["horizons"]:
        lines.append(
            f"  {row['horizon_s']:4.0f} s: {100 * row['level']:.0f} % within {num(row['place_m'], 3)} m and "
            f"{num(row['heading_deg'], 2)} deg, in the mean, if helm and engine are held ({row['voyages']} "
            f"voyages, {row['predictions']} predictions)"
        )
        lines += [
            f"          {r['regime'].replace('_', ', sea '):<24} {num(r['place_m'], 3)} m, "
            f"{num(r['heading_deg'], 2)} deg ({r['voyages']} voyages)"
            for r in row["regimes"]
        ]
    return [*lines, *(f"note: {text}" for text in result["doubts"])]

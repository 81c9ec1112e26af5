"""What `twin compare` and `twin add` expect a healthy ship to be off by: as its reference voyages were, each
predicted by the others.

Of the same distribution as the proof of `twin add` (reference/path_error.py), so that the two verbs agree on
one voyage. Where no reference voyage told it, rows stay as sensors and structural error make them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from twin.physics.ship import Ship
from twin.study.prediction.envelope import widening
from twin.study.prediction.score import DEGREES, NAMES, pooled
from twin.study.prediction.windows import SENSORS, Windows
from twin.study.reference.path_error import of_ship

MEAN = {"position": "position_m", "lateral": "lateral_m", "heading": "heading_rad"}
OF = "reference voyages"


def with_expected_errors(
    rows: list[dict[str, Any]], windows: Sequence[Windows], ship: Ship
) -> list[dict[str, Any]]:
    """The rows of score.horizons with `noise_floor` as the reference voyages have it: expected errors, no
    less than what sensors alone would make, wider where these voyages leave what was sailed then (`widened`),
    and `limit95`, times which 95 % of healthy voyages stay below."""
    known = of_ship(ship)
    if known is None:
        return rows
    out = []
    for row in rows:
        horizon = row["horizon_s"]
        sensors = pooled(windows, horizon, SENSORS)
        judged = [w.valid[w.at(horizon)] for w in windows]
        wider = float(
            np.mean(
                np.concatenate(
                    [widening(w, horizon, known.sailed)[ok] for w, ok in zip(windows, judged, strict=True)]
                )
            )
        )
        floor = {
            key: max(
                float(np.nanmean(sensors[name])),
                wider * float(known.expected(MEAN[name], [horizon])[0]) * DEGREES.get(name, 1.0),
            )
            for name, key in NAMES.items()
        }
        out.append(row | {"noise_floor": floor | {"of": OF, "limit95": known.limit95, "widened": wider}})
    return out

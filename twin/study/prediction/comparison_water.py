"""What `twin compare` says of the water of the day: the same predictions with the stream that each voyage had
shown when they began.

A model without today's stream is off by what the stream does, on every healthy voyage. What acts like a
stream on these voyages (growth on one long leg does) is taken for one too: which it is, `twin diagnose`
tells."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from twin.num import num
from twin.physics.model import Model
from twin.study.prediction import score
from twin.study.prediction.expected import OF
from twin.study.prediction.own_water import OwnWater, settled, shown_best
from twin.study.prediction.path_prior import errors_of
from twin.study.prediction.windows import Windows

KEYS = ("position_mae_m", "heading_mae_deg")


def in_own_water(windows: Sequence[Windows], models: Sequence[Model]) -> list[OwnWater]:
    """The predictions of each voyage, by the model of each, in the stream that the voyage shows."""
    out = []
    for w, model in zip(windows, models, strict=True):
        ahead = shown_best((w.lead * w.track.h).tolist(), model)
        out.append(settled(w, model, errors_of(model.ship, [w.track], [ahead]).at(ahead), ahead))
    return out


def with_own_water(rows: Sequence[dict[str, Any]], water: Sequence[OwnWater]) -> list[dict[str, Any]]:
    """The rows of score.horizons with the errors [m, deg] in the voyages' own streams."""
    ahead = [row["horizon_s"] for row in rows]
    own = score.horizons([w.windows for w in water], ahead, False)
    return [
        row | {"own_water": {k: o[k] for k in score.NAMES.values()}} for row, o in zip(rows, own, strict=True)
    ]


def stream_at_end(water: OwnWater) -> dict[str, float]:
    """What a voyage had shown of its stream at its end, beside the model's own: speed [m/s], and toward where
    [deg from true north]."""
    north, east = map(float, water.stream_mps[-1])
    return {
        "speed_mps": float(np.hypot(north, east)),
        "toward_deg": float(np.degrees(np.arctan2(east, north)) % 360.0),
    }


def in_words(row: Mapping[str, Any], streams: Sequence[Mapping[str, float]], limit: float) -> str:
    """The sentence about the water where the error of a horizon is more than `limit` times the expected one;
    `streams`: what each voyage had shown at its end."""
    own = row["own_water"]
    times = [own[k] / max(row["noise_floor"][k], 1e-12) for k in KEYS]
    fastest = max(streams, key=lambda s: s["speed_mps"])
    speed = f"{num(fastest['speed_mps'], 2)} m/s"
    if len(streams) == 1:
        shown = f"the voyage itself shows ({speed} toward {fastest['toward_deg']:.0f} deg)"
    else:
        shown = f"each voyage itself shows (up to {speed})"
    error = f"{num(own[KEYS[0]], 3)} m and {num(own[KEYS[1]], 2)} deg"
    ratio = f"ratio {num(times[0], 3)} and {num(times[1], 3)}"
    less = ", of which the reference voyages had less," if row["noise_floor"]["of"] == OF else ""
    explained = f"no more than expected: water of the day{less} or what acts like it"
    told = explained if max(times) < limit else "still more than expected"
    return f"In the stream that {shown} the error is {error} ({ratio}), {told}."

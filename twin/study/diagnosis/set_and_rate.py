"""Set and rate of the stream that a diagnosis found, as a navigator logs them: toward where, and how fast, in
the course of each voyage."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from twin.num import clock, num
from twin.physics.effect import Flow
from twin.physics.state import Situation
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found

MOMENTS = 5  # of each voyage, from where it begins to where it ends


def set_and_rate(case: Case, found: Found, name: str) -> list[dict[str, Any]]:
    """Voyage, time_s, speed_mps and toward_deg [deg from true north], moment by moment; one row a voyage
    where the stream is steady, none where the effect is no stream."""
    rows = []
    for i, track in enumerate(case.tracks):
        model = found.on(i)
        effect = next((e for e in model.effects if type(e).__name__ == name), None)
        if not (isinstance(effect, Flow) and effect.stream):
            return []
        t = np.linspace(track.t[0], track.t[-1], MOMENTS)
        water = effect.water(Situation(t=t), model.loaded)  # felt by a ship that heads north
        north, east = np.atleast_1d(water.u), np.atleast_1d(water.v)
        rows += [
            {
                "voyage": track.name,
                "time_s": float(at),
                "speed_mps": float(np.hypot(n, e)),
                "toward_deg": float(np.degrees(np.arctan2(e, n)) % 360.0),
            }
            for at, n, e in zip(t, north, east, strict=False)
        ]
    return rows


def stream_in_words(rows: Sequence[dict[str, Any]]) -> str:
    """One clause: each moment with its time, and with its voyage where there are several."""
    voyages = [row["voyage"] for row in rows]
    several, steady = len(set(voyages)) > 1, len(set(voyages)) == len(voyages)
    return ", ".join(
        f"{num(row['speed_mps'], 2)} m/s toward {row['toward_deg']:.0f} deg"
        + ("" if steady else f" at {clock(row['time_s'])}")
        + (f" on {row['voyage']}" if several else "")
        for row in rows
    )

"""The unit of unlabelled wind speeds, by the triangle of true wind, apparent wind and the ship's motion."""

from typing import Any

import numpy as np

from twin.recording.suggest_units import HEADED, SPEED_UNITS, Taken, heading_samples, samples

SIDES_OF_IT = (
    ("true_wind_speed_mps", "true_wind_direction_deg"),
    ("apparent_wind_speed_mps", "apparent_wind_angle_deg"),
    ("speed_over_ground_mps", "course_over_ground_deg"),
)


def wind_unit(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> None:
    """The unit of unlabelled wind speeds, in which true wind, apparent wind and the ship's motion close."""
    winds = ("true_wind_speed_mps", "apparent_wind_speed_mps")
    open_ones = [n for n in winds if n in taken and "unit" not in entries[n].keys]
    if not open_ones:
        return
    missed = {
        unit: triangle(entries, taken, time, dict.fromkeys(open_ones, scale))
        for unit, scale in SPEED_UNITS[:2]
    }
    known = {unit: m for unit, m in missed.items() if m is not None}
    best = min(known, key=lambda u: known[u], default="")
    for name in open_ones:
        if best and known[best] < 0.5 * max(known.values()):
            entries[name].keys["unit"] = best
            entries[name].why.append("unit by true wind, apparent wind and the ship's speed")
        else:
            entries[name].why.append("m/s? CONFIRM")


def triangle(
    entries: dict[str, Any], taken: Taken, time: dict[str, Any], scales: dict[str, float]
) -> float | None:
    """How far apparent wind and true wind less the ship's motion are apart, as a share; None where one of
    them is not there."""
    sides = []
    for speed, angle in SIDES_OF_IT:
        if speed not in taken or angle not in taken:
            return None
        size, turned = (
            samples(*taken[speed][:2], time),
            heading_samples(entries[angle].keys, taken[angle], time),
        )
        if size is None or turned is None:
            return None
        scale = scales.get(speed, dict(SPEED_UNITS).get(entries[speed].keys.get("unit", ""), 1.0))
        sides.append((size, turned, scale))
    psi = heading_samples(entries[HEADED].keys, taken[HEADED], time) if HEADED in taken else None
    if psi is None:
        return None
    t = sides[0][0][0]
    true, apparent, way = (
        s * np.interp(t, *a) * np.exp(1j * np.radians(np.interp(t, *b))) for a, b, s in sides
    )
    made = (true + way) * np.exp(-1j * np.radians(np.interp(t, *psi)))
    return float(np.median(np.abs(made - apparent)) / max(np.median(np.abs(apparent)), 1e-9))

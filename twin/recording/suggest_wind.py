"""A wind that a table does not say to be true or apparent, and the unit of one that has none: by the other
column of it, and by the triangle of true wind, apparent wind and the ship's motion."""

from typing import Any

import numpy as np

from twin.recording.formats.name_words import words_of
from twin.recording.suggest_units import HEADED, SPEED_UNITS, Taken, heading_samples, samples

SIDES_OF_IT = (
    ("true_wind_speed_mps", "true_wind_direction_deg"),
    ("apparent_wind_speed_mps", "apparent_wind_angle_deg"),
    ("speed_over_ground_mps", "course_over_ground_deg"),
)
WHOSE = frozenset(
    ("true", "tws", "twd", "mwd", "ground", "apparent", "relative", "rel", "aws", "awa", "rws", "rwd")
)
TURNED_INTO = (  # a half whose name does not say, the other half, and what the first is then
    ("true_wind_speed_mps", "apparent_wind_angle_deg", "apparent_wind_speed_mps"),
    ("true_wind_direction_deg", "apparent_wind_speed_mps", "apparent_wind_angle_deg"),
)


def one_wind(taken: Taken) -> None:
    """A speed or an angle that does not say of which wind it is, is of the wind that the other column is of:
    a wind angle is off the bow, so the wind speed beside it is the apparent one."""
    for half, other, becomes in TURNED_INTO:
        lone = len([n for pair in SIDES_OF_IT[:2] for n in pair if n in taken]) == 2
        if lone and half in taken and other in taken and unsaid(taken[half][1]):
            seen, name, how = taken.pop(half)
            taken[becomes] = (seen, name, how._replace(channel=becomes))


def unsaid(name: str) -> bool:
    """Whether a column's name leaves open of which wind it is."""
    return not WHOSE & {*words_of(name)[0]}


def whose_wind(entries: dict[str, Any], taken: Taken) -> None:
    """Asks a person about a speed or a direction that is the apparent wind's only because the other column
    is."""
    for name in SIDES_OF_IT[1]:
        if name in taken and unsaid(taken[name][1]) and "angle" not in words_of(taken[name][1])[0]:
            entries[name].why.append("apparent, as the other column of the wind is. CONFIRM")


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

"""Where the ship was and how she moved, on the chart and in her own axes; what is absent is derived."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from twin.study.frames import SMOOTH_S, body_from_earth, chart, earth_from_body, integral, slope
from twin.study.mapping import FRAMED, PLACES, Map
from twin.study.resample import continuous
from twin.study.samples import from_zero
from twin.study.units import froude

Columns = dict[str, np.ndarray]
CHART = ("north_m", "east_m")
SLOWEST_MPS = 1e-3  # below this a ship has no course


def placed(columns: Columns, by: Map) -> tuple[Columns, dict[str, Any], list[str]]:
    """Columns with north/east and body velocities in place of latitude/longitude, earth or course velocities.

    Second: what is known of the place (`datum`). Third: sentences.
    """
    facts: dict[str, Any] = {}
    notes: list[str] = []
    if set(PLACES) <= set(columns):
        north, east, facts["datum"] = chart(*(columns.pop(name) for name in PLACES))
        if set(CHART).isdisjoint(columns):
            columns |= dict(zip(CHART, (north, east), strict=True))
    for name in CHART:
        if name in columns:
            columns[name], said = from_zero(name, columns[name])
            notes += said
    return turned(columns, by), facts, notes


def turned(columns: Columns, by: Map) -> Columns:
    """Velocities by the earth or by the course, in the ship's own axes; they need the heading."""
    frame = by.columns[FRAMED[0]].frame if FRAMED[0] in by.columns else "body"
    if frame == "body" or "heading_true_north_deg" not in columns:
        return columns
    north, east = (columns[name] for name in FRAMED)
    if frame == "course":
        speed, course = north, np.radians(east)
        north, east = speed * np.cos(course), speed * np.sin(course)
    psi = np.radians(columns["heading_true_north_deg"])
    return columns | dict(zip(FRAMED, body_from_earth(north, east, psi), strict=True))


def derive(time_s: np.ndarray, columns: Columns) -> tuple[Columns, dict[str, str]]:
    """Position from velocity, velocity from position, yaw rate from heading; second: what was made how."""
    columns, how = dict(columns), dict[str, str]()
    psi = np.radians(continuous(columns["heading_true_north_deg"], 360.0))
    if not present(columns, *CHART):
        north, east = earth_from_body(columns[FRAMED[0]], columns[FRAMED[1]], psi)
        columns |= {"north_m": integral(time_s, north), "east_m": integral(time_s, east)}
        how |= dict.fromkeys(CHART, "integrated from the velocities and the heading")
    elif not present(columns, *FRAMED):
        north, east = (slope(time_s, columns[name]) for name in CHART)
        columns |= dict(zip(FRAMED, body_from_earth(north, east, psi), strict=True))
        how |= dict.fromkeys(FRAMED, f"slope of the position over {SMOOTH_S:g} s, turned by the heading")
    if not present(columns, "yaw_rate_degps"):
        columns["yaw_rate_degps"] = np.degrees(slope(time_s, psi))
        how["yaw_rate_degps"] = f"slope of the heading over {SMOOTH_S:g} s"
    return columns, how


def present(columns: Mapping[str, np.ndarray], *names: str) -> bool:
    """True when every named column holds a sample."""
    return all(name in columns and bool(np.isfinite(columns[name]).any()) for name in names)


def scaled(columns: Columns, by: Map) -> Columns:
    """Model to ship at equal Froude number; constants of a map are the ship's already."""
    if by.froude_scale == 1.0:
        return columns
    return {n: x if n in by.constant else x * froude(n, by.froude_scale) for n, x in columns.items()}

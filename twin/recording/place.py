"""Where the ship was and how it moved, on the chart and in its own axes; what is absent is derived."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from twin.live.signals.channels import BY_NAME
from twin.num import as_given
from twin.recording.frames import SMOOTH_S, body_from_earth, chart, earth_from_body, integral, slope
from twin.recording.mapping import FRAMED, PLACES, Map
from twin.recording.resample import beside, continuous
from twin.recording.samples import from_zero
from twin.recording.units import froude

Columns = dict[str, np.ndarray]
CHART = ("north_m", "east_m")
HEADING = "heading_true_north_deg"


def no_latitude(columns: Mapping[str, np.ndarray]) -> str:
    """Why the column of latitudes (N,) [deg] holds none; empty where it does."""
    values = columns.get("latitude_deg", np.empty(0))
    values = values[np.isfinite(values) & (np.abs(values) != 91.0)]  # 91: AIS, no position
    if not values.size or float(np.median(np.abs(values))) <= 90.0:
        return ""
    return (
        f"latitude_deg is {as_given(float(np.median(values)))} (median), and no latitude is beyond 90 deg: "
        "latitude and longitude are exchanged, or its unit is another. In the map: swap their columns, or "
        "give the unit."
    )


def placed(time_s: np.ndarray, columns: Columns, by: Map) -> tuple[Columns, dict[str, Any], list[str]]:
    """Columns with north/east and body velocities in place of latitude/longitude, earth or course velocities.

    Numbers that belong together may stand in rows of their own: the others are brought to the time of the
    first. Second: what is known of the place (`datum`). Third: sentences. `time_s` (N,) and every column
    (N,), in the unit in its name."""
    facts: dict[str, Any] = {}
    notes: list[str] = []
    if set(PLACES) <= set(columns):
        latitude, longitude = (columns.pop(name) for name in PLACES)
        north, east, facts["datum"] = chart(latitude, _with(time_s, longitude, latitude, CHART[1], 360.0))
        if set(CHART).isdisjoint(columns):
            columns |= dict(zip(CHART, (north, east), strict=True))
    for half in set(PLACES) & set(columns):
        del columns[half]
        notes.append(f"{half} is not used: a position needs both {' and '.join(PLACES)}")
    for name in CHART:
        if name in columns:
            columns[name], said = from_zero(name, columns[name])
            notes += said
    return turned(time_s, columns, by), facts, notes


def _with(
    time_s: np.ndarray, values: np.ndarray, partner: np.ndarray, name: str, period: float | None = None
) -> np.ndarray:
    """`values` of channel `name` wherever its partner was measured, NaN elsewhere."""
    ch, rows = BY_NAME[name], np.isfinite(partner)
    near = beside(time_s, values, rows, ch.stale_s, ch.period if period is None else period)
    return np.where(rows, near, np.nan)


def turned(time_s: np.ndarray, columns: Columns, by: Map) -> Columns:
    """Velocities by the earth or by the course, in the ship's own axes; they need the heading. `time_s`
    (N,) and every column (N,), in the unit in its name."""
    frame = by.columns[FRAMED[0]].frame if FRAMED[0] in by.columns else "body"
    if frame == "body" or HEADING not in columns:
        return columns
    first, second = (columns[name] for name in FRAMED)
    second = _with(time_s, second, first, FRAMED[1], 360.0 if frame == "course" else None)
    north, east = first, second
    if frame == "course":
        north, east = first * np.cos(np.radians(second)), first * np.sin(np.radians(second))
    psi = np.radians(_with(time_s, columns[HEADING], first, HEADING))
    return columns | dict(zip(FRAMED, body_from_earth(north, east, psi), strict=True))


def derive(time_s: np.ndarray, columns: Columns) -> tuple[Columns, dict[str, str]]:
    """Position from velocity, velocity from position, yaw rate from heading; second: what was made how.
    `time_s` (N,) and every column (N,), in the unit in its name."""
    columns, how = dict(columns), dict[str, str]()
    heading = continuous(columns[HEADING], 360.0)
    if not present(columns, *CHART):
        u = columns[FRAMED[0]]
        v, psi = (
            _with(time_s, columns[FRAMED[1]], u, FRAMED[1]),
            np.radians(_with(time_s, heading, u, HEADING)),
        )
        north, east = earth_from_body(u, v, psi)
        columns |= {"north_m": integral(time_s, north), "east_m": integral(time_s, east)}
        how |= dict.fromkeys(CHART, "integrated from the velocities and the heading")
    elif not present(columns, *FRAMED):
        north, east = (slope(time_s, columns[name]) for name in CHART)
        east, psi = _with(time_s, east, north, CHART[1]), np.radians(_with(time_s, heading, north, HEADING))
        columns |= dict(zip(FRAMED, body_from_earth(north, east, psi), strict=True))
        how |= dict.fromkeys(
            FRAMED, f"slope of the position over {as_given(SMOOTH_S)} s, turned by the heading"
        )
    if not present(columns, "yaw_rate_degps"):
        columns["yaw_rate_degps"] = slope(time_s, heading)
        how["yaw_rate_degps"] = f"slope of the heading over {as_given(SMOOTH_S)} s"
    return columns, how


def present(columns: Mapping[str, np.ndarray], *names: str) -> bool:
    """True when every named column (N,), in whatever unit, holds a sample."""
    return all(name in columns and bool(np.isfinite(columns[name]).any()) for name in names)


def scaled(columns: Columns, by: Map) -> Columns:
    """Model to ship at equal Froude number, of columns that are `placed`; constants of a map are the ship's
    already. Columns (N,), each in the unit in its name."""
    if by.froude_scale == 1.0:
        return columns
    return {n: x if n in by.constant else x * froude(n, by.froude_scale) for n, x in columns.items()}

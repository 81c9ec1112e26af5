"""Which of two axes is north, from where a quaternion counts, and to which side a speed counts: by position,
heading and speed together, else by the habit of the names."""

from typing import Any

import numpy as np

from twin.recording.suggest_units import Taken, heading_samples, instants_between, placed_samples, samples

HEADING = "heading_true_north_deg"
CHART = ("north_m", "east_m")
PLAIN_AXES = ("plain_x", "plain_y")
ALIKE, PLAINLY = 0.6, 1.5  # what is left of the way, as a share; how much more the other reading leaves
ROBOTS = ("pose", "odom", "orientation", "local_position")  # words of ROS, which counts east and north


def axes(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> None:
    """Settles `x` and `y`, a quaternion, and the side to which the sway counts."""
    plain_axes(entries, taken)
    named = [taken[n][1].lower() for n in (*CHART, HEADING) if n in taken]
    pair_of_robots = any(word in n for n in named for word in ROBOTS) and not any("ned" in n for n in named)
    by_quaternion = (
        str(entries[HEADING].keys.get("unit", "")) == "quaternion" if HEADING in entries else False
    )
    swapped = globe_says(entries, taken, time)
    if swapped is None:
        swapped = by_quaternion and pair_of_robots
        why = "as ROS counts: from east, anticlockwise? CONFIRM" if swapped else ""
    else:
        why = "by latitude and longitude"
    if swapped:
        swap(entries, taken, why, by_quaternion)
    elif by_quaternion:
        entries[HEADING].why.append('from north, clockwise? If it counts from east: unit = "quaternion_enu"')
    sway_side(entries, taken, time)


def plain_axes(entries: dict[str, Any], taken: Taken) -> None:
    """Columns called x and y alone are a position, where no other is there."""
    if all(n in taken for n in PLAIN_AXES) and not any(n in taken for n in CHART):
        for own, plain in zip(CHART, PLAIN_AXES, strict=True):
            taken[own], entries[own] = taken[plain], entries[plain]
            entries[own].why.append(
                f"{plain[-1]} north, {'y east'}? CONFIRM" if own == CHART[0] else "CONFIRM"
            )


def swap(entries: dict[str, Any], taken: Taken, why: str, by_quaternion: bool) -> None:
    """x is east and y north."""
    if all(n in taken for n in CHART) and taken[CHART[0]][1].lower().rstrip("]) ").endswith("x"):
        for table in (entries, taken):
            table[CHART[0]], table[CHART[1]] = table[CHART[1]], table[CHART[0]]
        entries[CHART[0]].why.append(why)
    if by_quaternion:
        entries[HEADING].keys["unit"] = "quaternion_enu"
        entries[HEADING].why.append(why)


def globe_says(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> bool | None:
    """Whether x goes with longitude and not with latitude; None where it cannot be told."""
    if not all(n in taken for n in (*CHART, "latitude_deg", "longitude_deg")):
        return None
    found = [
        placed_samples(taken[n], entries[n].keys, time) for n in (*CHART, "latitude_deg", "longitude_deg")
    ]
    if any(f is None for f in found):
        return None
    stamps = [f[0] for f in found if f is not None]
    first, last = max(t[0] for t in stamps), min(t[-1] for t in stamps)
    t = np.linspace(first, last, 2000) if last > first else stamps[0]
    x, y, lat, lon = (np.interp(t, *f) for f in found if f is not None)
    lat, lon = lat * 111_200.0, lon * 111_320.0 * np.cos(np.radians(np.median(lat)))
    straight = np.hypot(np.std(x - lat), np.std(y - lon))
    crossed = np.hypot(np.std(x - lon), np.std(y - lat))
    if min(straight, crossed) > ALIKE * np.hypot(np.std(lat), np.std(lon)):
        return None
    return bool(crossed < straight) if max(straight, crossed) > PLAINLY * min(straight, crossed) else None


def sway_side(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> None:
    """The sign of the sway, from how position and heading say the ship goes aside."""
    sway = "sway_velocity_mps"
    if not all(n in taken for n in (*CHART, HEADING, sway)):
        return
    place = [placed_samples(taken[n], entries[n].keys, time) for n in CHART]
    psi, v = heading_samples(entries[HEADING].keys, taken[HEADING], time), samples(*taken[sway][:2], time)
    if psi is None or v is None or place[0] is None or place[1] is None:
        return
    step = 10.0 * float(np.median(np.diff(place[0][0])))
    grid = instants_between(place[0][0][0], place[0][0][-1], step)
    if grid.size < 12:
        return
    step = float(grid[1] - grid[0])
    way = np.diff(np.interp(grid, *place[0]) + 1j * np.interp(grid, *place[1])) / step
    middle = grid[:-1] + step / 2.0
    aside = (way * np.exp(-1j * np.radians(np.interp(middle, *psi)))).imag
    shown = np.interp(middle, *v)
    size = float(np.linalg.norm(aside) * np.linalg.norm(shown))
    if size > 0.0 and float(np.dot(aside, shown)) < -0.7 * size:
        entries[sway].keys["sign"] = -1
        entries[sway].why.append("positive to port, as position and heading say")

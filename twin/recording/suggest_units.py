"""Units of an unknown table: by its cells, and by how place, speed, heading and turning go together."""

from typing import Any

import numpy as np

from twin.num import num
from twin.recording.cells import degrees_of
from twin.recording.columns_seen import SeenColumns
from twin.recording.formats.guess import Guess
from twin.recording.formats.name_words import words_of
from twin.recording.frames import from_ddmm
from twin.recording.resample import continuous
from twin.recording.suggest_clock import seconds_of
from twin.recording.units import DEG_PER_RAD, KNOT_MPS

Taken = dict[str, tuple[SeenColumns, str, Guess]]
RADIANS = 2.0 * np.pi + 1e-3
SPEEDS = {
    "speed_over_ground_mps": None,
    "surge_velocity_mps": "sway_velocity_mps",
    "velocity_north_mps": "velocity_east_mps",
}
HEADED = "heading_true_north_deg"
WATER, WATER_ASIDE = "surge_velocity_through_water_mps", "sway_velocity_through_water_mps"
SPEED_UNITS = (("m/s", 1.0), ("kn", KNOT_MPS), ("km/h", 1 / 3.6), ("ft/s", 0.3048))
RATE_UNITS = (("deg/s", 1.0), ("deg/min", 1.0 / 60.0), ("rad/s", DEG_PER_RAD))
SLOW_TURNS = 30.0  # an unlabelled shaft that never turns faster is told in 1/s
MOST_INSTANTS = 2000.0
Samples = tuple[np.ndarray, np.ndarray]  # stamps [s] in order, values


def place_format(
    keys: dict[str, Any], why: list[str], seen: SeenColumns, name: str, values: np.ndarray
) -> None:
    """Degrees, NMEA's ddmm.mmm, 1e-7 deg, or text; a column of letters beside it. `values` (N,) in the
    unit of the file."""
    if not np.isfinite(values).any():
        keys["unit"] = "dms"
        why[:] = [f"as text: {next((s for s in seen.texts(name) if s), '')!r}"]
        return
    largest = float(np.nanmax(np.abs(values)))
    limit = 90.0 if "latitude" in words_of(name)[0] or "lat" in name.lower() else 180.0
    if largest > 1e6:
        keys["unit"] = "degE7"
    elif largest > limit:
        keys["unit"] = "ddmm"
        why.append("degrees and minutes as NMEA writes them, for they exceed the globe")
    letters = next(
        (n for n in seen.names if n != name and are_letters(seen, n) and name[:3].lower() in n.lower()), None
    )
    at = seen.names.index(name) + 1
    if letters is None and at < len(seen.names) and are_letters(seen, seen.names[at]):
        letters = seen.names[at]
    if letters:
        keys["hemisphere"] = seen.key(letters)


def are_letters(seen: SeenColumns, name: str) -> bool:
    """Whether a column holds the letters of a hemisphere."""
    found = {s for s in seen.texts(name)[:50] if s}
    return bool(found) and found <= set("NSEWnsew")


def unit_of_angle(
    keys: dict[str, Any], why: list[str], channel: str, stated: str, values: np.ndarray
) -> None:
    """Degrees or radians: as the name says, else by the range. `values` (N,) in the unit of the file."""
    if stated in ("rad", "deg"):
        if stated == "rad":
            keys["unit"] = "rad"
        why.append("unit by its name")
        return
    good = values[np.isfinite(values)]
    if good.size > 20 and np.max(np.abs(good)) <= RADIANS and np.ptp(good) > 0.05:
        wide = "heading" in channel or "direction" in channel or "course" in channel or "wind" in channel
        if wide and np.ptp(good) > 0.3:
            keys["unit"] = "rad"
            why.append("within 2 pi: radians? CONFIRM")
        elif channel == "rudder_angle_deg" and np.max(np.abs(good)) < 0.9:
            keys["unit"] = "rad"
            why.append("below one: radians? CONFIRM")
    elif (
        good.size and wide_angle(channel) and np.max(np.abs(good)) > 1000.0 and np.max(np.abs(good)) < 36001.0
    ):
        keys["unit"] = "cdeg"
        why.append("hundredths of a degree, for they exceed a circle")


def wide_angle(channel: str) -> bool:
    """Whether an angle goes all around."""
    return any(word in channel for word in ("heading", "direction", "course"))


def unit_of_turns(keys: dict[str, Any], why: list[str], stated: str, values: np.ndarray) -> None:
    """Turns a minute, or a second where they are few. `values` (N,) in the unit of the file."""
    good = np.abs(values[np.isfinite(values)])
    if not stated and good.size and 0.0 < good.max() < SLOW_TURNS:
        keys["unit"] = "1/s"
        why.append("never more than 30: turns a second? CONFIRM")


def samples(seen: SeenColumns, name: str, time: dict[str, Any]) -> Samples | None:
    """Where a column has numbers: their stamps (N,) [s], in order, and values (N,); None where the clock
    cannot be read, or they are few."""
    t, x = seconds_of(seen, time), seen.numbers(name)
    if t is None or t.shape != x.shape:
        return None
    good = np.isfinite(t) & np.isfinite(x)
    t, x = t[good], x[good]
    order = np.argsort(t, kind="stable")
    return (t[order], x[order]) if t.size > 10 and t[order][-1] > t[order][0] else None


def track(
    taken: Taken, entries: dict[str, Any], time: dict[str, Any]
) -> tuple[np.ndarray, np.ndarray] | None:
    """Stamps (N,) [s] and places north + i east (N,) [m]; None where there is no position."""
    for first, second in (("latitude_deg", "longitude_deg"), ("north_m", "east_m")):
        if first not in taken or second not in taken:
            continue
        a, b = (placed_samples(taken[n], entries[n].keys, time) for n in (first, second))
        if a is None or b is None:
            continue
        north, east = a[1], np.interp(a[0], *b)
        if first == "latitude_deg":
            east = east * 111_320.0 * np.cos(np.radians(np.median(north)))
            north = north * 111_200.0
        return a[0], north + 1j * east
    return None


def placed_samples(
    of: tuple[SeenColumns, str, Guess], keys: dict[str, Any], time: dict[str, Any]
) -> Samples | None:
    """Samples (N,) of a position's column in [deg] or [m], as its entry reads them."""
    seen, name, _ = of
    if keys.get("unit") == "dms":
        t = seconds_of(seen, time)
        try:
            x = np.array([degrees_of(s) for s in seen.texts(name)])
        except ValueError:
            return None
        good = np.isfinite(x)
        return None if t is None or not good.any() else (t[good], x[good])
    found = samples(seen, name, time)
    if found is None:
        return None
    scale = {"degE7": 1e-7, "ddmm": 1.0}.get(keys.get("unit", ""), 1.0)
    return found[0], from_ddmm(found[1]) if keys.get("unit") == "ddmm" else found[1] * scale


def instants_between(first: float, last: float, step: float) -> np.ndarray:
    """Instants (N,) [s] so far apart, or farther where they would be more than some thousands."""
    return np.arange(first, last, max(step, (last - first) / MOST_INSTANTS, 1e-6))


def chords(t: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(instants, way made good between them [m]): some ten of the usual steps apart, so that the noise of
    positions is small beside it. `t` (N,) [s], `place` (N,) [m]."""
    grid = instants_between(t[0], t[-1], 10.0 * float(np.median(np.diff(t))))
    at = np.interp(grid, t, place.real) + 1j * np.interp(grid, t, place.imag)
    return grid, np.abs(np.diff(at))


def speed_unit(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> None:
    """The unit of an unlabelled speed, from the distance between positions; that of a speed through water
    from the speed over ground."""
    speed = next((s for s in SPEEDS if s in taken), None)
    way = track(taken, entries, time)
    if speed is not None and way is not None and "unit" not in entries[speed].keys:
        over_ground(entries, taken, time, speed, way)
    if speed is not None and WATER in taken and "unit" not in entries[WATER].keys:
        through_water(entries, taken, time, speed)


def over_ground(entries: dict[str, Any], taken: Taken, time: dict[str, Any], speed: str, way: Any) -> None:
    """The same of the speed over ground."""
    shown = magnitude(taken, time, speed)
    if shown is None or way[0].size < 12:
        return
    grid, moved = chords(*way)
    inside = (grid[:-1] >= shown[0][0]) & (grid[1:] <= shown[0][-1])
    run = np.interp((grid[1:] + grid[:-1]) / 2.0, *shown) * np.diff(grid)
    total, far = float(np.sum(run[inside])), float(np.sum(moved[inside]))
    if not total > 0.0 or not far > 0.0:
        return
    ratio = far / total
    unit, scale = min(SPEED_UNITS, key=lambda c: abs(np.log(ratio / c[1])))
    pair = [n for n in (speed, SPEEDS[speed]) if n in entries]
    if abs(np.log(ratio / scale)) < 0.15:
        for name in pair:
            entries[name].keys["unit"] = unit
            entries[name].why.append(f"unit by the distance between positions (ratio {num(ratio, 3)})")
    else:
        entries[speed].why.append(
            f"the positions move {num(ratio, 3)} times as far as this says: unit? CONFIRM"
        )


def magnitude(taken: Taken, time: dict[str, Any], speed: str) -> Samples | None:
    """Samples (N,) of a speed, of both its parts where it has two, in the unit of the file."""
    a = samples(*taken[speed][:2], time)
    other = SPEEDS[speed]
    b = samples(*taken[other][:2], time) if other in taken else None
    if a is None or b is None:
        return None if a is None else (a[0], np.abs(a[1]))
    return a[0], np.hypot(a[1], np.interp(a[0], *b))


def through_water(entries: dict[str, Any], taken: Taken, time: dict[str, Any], speed: str) -> None:
    """The unit in which a log tells most nearly the speed over ground."""
    ground, water = magnitude(taken, time, speed), samples(*taken[WATER][:2], time)
    scale = dict(SPEED_UNITS).get(entries[speed].keys.get("unit", ""))
    if ground is None or water is None or scale is None or not np.median(np.abs(water[1])) > 0.0:
        return
    ratio = float(np.median(ground[1]) * scale / np.median(np.abs(water[1])))
    unit, own = min(SPEED_UNITS[:2], key=lambda c: abs(np.log(max(ratio, 1e-6) / c[1])))
    if abs(np.log(max(ratio, 1e-6) / own)) < 0.3:
        for name in (n for n in (WATER, WATER_ASIDE) if n in entries and "unit" not in entries[n].keys):
            entries[name].keys["unit"] = unit
            entries[name].why.append("unit by the speed over ground: CONFIRM")


def turn_unit(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> None:
    """The unit of an unlabelled rate of turn, from how the heading turns."""
    rate, heading = "yaw_rate_degps", "heading_true_north_deg"
    if rate not in taken or heading not in taken or "unit" in entries[rate].keys:
        return
    psi, r = heading_samples(entries[heading].keys, taken[heading], time), samples(*taken[rate][:2], time)
    if psi is None or r is None:
        return
    step = 10.0 * float(max(np.median(np.diff(psi[0])), np.median(np.diff(r[0]))))
    grid = instants_between(max(psi[0][0], r[0][0]), min(psi[0][-1], r[0][-1]), step)
    if grid.size < 8:
        return
    summed = np.r_[0.0, np.cumsum((r[1][1:] + r[1][:-1]) / 2.0 * np.diff(r[0]))]
    a, b = np.diff(np.interp(grid, r[0], summed)), np.diff(np.interp(grid, *psi))
    if not float(np.dot(a, a)) > 0.0:
        return
    ratio = float(np.dot(a, b) / np.dot(a, a))
    fit = abs(float(np.dot(a, b))) / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-12)
    for unit, scale in RATE_UNITS:
        if fit > 0.5 and ratio and abs(np.log(abs(ratio) / scale)) < 0.3:
            entries[rate].keys["unit"] = unit
            if ratio < 0.0:
                entries[rate].keys["sign"] = -1
            entries[rate].why.append(f"unit by the heading's turning (ratio {num(ratio, 3)})")
            return
    entries[rate].why.append("unit? CONFIRM (it hardly turns, or heading and rate do not agree)")


def heading_samples(
    keys: dict[str, Any], of: tuple[SeenColumns, str, Guess], time: dict[str, Any]
) -> Samples | None:
    """Samples (N,) of the heading [deg], continuous, as its entry reads them."""
    seen, name, _ = of
    if str(keys.get("unit", "")).startswith("quaternion"):
        x, y, z, w = (seen.numbers(n) for n in keys["column"])
        yaw = np.degrees(np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))
        seen = SeenColumns(
            seen.path,
            seen.names,
            seen.cells | {name: 90.0 - yaw if keys["unit"] == "quaternion_enu" else yaw},
            keys=seen.keys,
        )
        scale = 1.0
    else:
        scale = {"rad": DEG_PER_RAD, "cdeg": 0.01}.get(keys.get("unit", ""), 1.0)
    found = samples(seen, name, time)
    return None if found is None else (found[0], continuous(found[1] * scale, 360.0))

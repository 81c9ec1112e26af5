"""Units and clocks of an unknown table: by its cells, and by how place, speed, heading and turning go
together."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

import numpy as np

from twin.num import as_given, num
from twin.recording.columns_seen import SeenColumns
from twin.recording.formats.guess import Guess, guess
from twin.recording.resample import continuous
from twin.recording.units import DEG_PER_RAD, KNOT_MPS, UNITS

FORMATS = (
    "%d.%m.%Y %H:%M:%S.%f",
    "%d.%m.%Y %H:%M:%S",
    "%Y/%m/%d %H:%M:%S.%f",
    "%Y/%m/%d %H:%M:%S",
    "%d/%m/%Y %H:%M:%S.%f",
    "%d/%m/%Y %H:%M:%S",
    "%m/%d/%Y %H:%M:%S",
    "%d-%m-%Y %H:%M:%S",
    "%d.%m.%Y %H:%M",
    "%H:%M:%S.%f",
    "%H:%M:%S",
)
EPOCHS = ((1e17, "ns"), (1e14, "us"), (1e11, "ms"), (1e8, "s"))
Taken = dict[str, tuple[SeenColumns, str, Guess]]
RADIANS = 2.0 * np.pi + 1e-3
SPEEDS = ("speed_over_ground_mps", "surge_velocity_mps", "velocity_north_mps")


def time_entry(files: Sequence[SeenColumns]) -> dict[str, Any]:
    """The [time] table: a column that every file has, its unit by name, size or form."""
    common = [n for n in files[0].names if all(n in f.names for f in files)]
    times = [n for n in common if (g := guess(n)) and g.channel == "time"]
    dates = [n for n in times if "date" in n.lower() and "time" not in n.lower()]
    clocks = [n for n in times if n not in dates]
    seen = files[0]
    if not times:
        return {"column": "TIME", "why": "NOT FOUND: which column is the time?"}
    if dates and clocks:
        joined = [
            f"{a} {b}" for a, b in zip(seen.texts(dates[0])[:50], seen.texts(clocks[0])[:50], strict=True)
        ]
        return {"column": [dates[0], clocks[0]], **(text_format(joined) or {"why": "which format?"})}
    name = min(
        clocks or times,
        key=lambda n: (
            not np.isfinite(seen.numbers(n)).any() and not text_format(seen.texts(n)[:50]),
            times.index(n),
        ),
    )
    values = seen.numbers(name)
    if not np.isfinite(values).any():
        return {"column": name, **(text_format(seen.texts(name)[:50]) or {"why": "which format?"})}
    stated = g.unit if (g := guess(name)) and g.unit in UNITS["s"] else ""
    unit, why = (stated, "unit by its name") if stated else clock_unit(values)
    return {"column": name, "unit": unit, "why": why}


def clock_unit(values: np.ndarray) -> tuple[str, str]:
    """(unit, why): since 1970 by size, else by the usual step. `values` (N,) in the unit of the file."""
    first = float(values[np.isfinite(values)][0])
    for least, unit in EPOCHS:
        if first > least:
            return unit, "since 1970, by its size"
    steps = np.diff(values[np.isfinite(values)])
    step = float(np.median(steps)) if steps.size else 1.0
    if step >= 20.0 and steps.size > 10:
        return "ms", f"a step of {as_given(step, 4)}: milliseconds? CONFIRM"
    return "s", f"a step of {as_given(step, 4)}"


def text_format(stamps: Sequence[str]) -> dict[str, Any] | None:
    """`unit = "iso"`, or the first format that reads the stamps."""
    filled = [s for s in stamps if s]
    if not filled:
        return None
    try:
        for s in filled:
            datetime.fromisoformat(s)
        return {"unit": "iso"}
    except ValueError:
        pass
    for form in FORMATS:
        try:
            for s in filled:
                datetime.strptime(cut(s), form)
        except ValueError:
            continue
        return {"format": form}
    return None


def cut(stamp: str) -> str:
    """A stamp whose fraction has at most six digits, as strptime reads them, with a point."""
    head, point, part = stamp.replace(",", ".").rpartition(".")
    return f"{head}.{part[:6]}" if point and part.isdigit() and len(part) > 4 else stamp.replace(",", ".")


def place_format(
    keys: dict[str, Any], why: list[str], seen: SeenColumns, name: str, values: np.ndarray
) -> None:
    """Degrees, NMEA's ddmm.mmm, 1e-7 deg, or text; a column of letters beside it. `values` (N,) in the
    unit of the file."""
    if not np.isfinite(values).any():
        keys["unit"] = "dms"
        why[:] = [f"as text: {seen.texts(name)[0]!r}"]
        return
    largest = float(np.nanmax(np.abs(values)))
    limit = 90.0 if "lat" in name.lower() else 180.0
    if largest > 1e6:
        keys["unit"] = "degE7"
    elif largest > limit:
        keys["unit"] = "ddmm"
        why.append("degrees and minutes as NMEA writes them, for they exceed the globe")
    letters = next(
        (
            n
            for n in seen.names
            if n != name and set(seen.texts(n)[:50]) <= set("NSEWnsew") and name[:3].lower() in n.lower()
        ),
        None,
    )
    at = seen.names.index(name) + 1
    if letters is None and at < len(seen.names) and set(seen.texts(seen.names[at])[:50]) <= set("NSEWnsew"):
        letters = seen.names[at]
    if letters:
        keys["hemisphere"] = letters


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
        wide = "heading" in channel or "direction" in channel or "course" in channel
        if wide and np.ptp(good) > 0.3:
            keys["unit"] = "rad"
            why.append("within 2 pi: radians? CONFIRM")
        elif channel == "rudder_angle_deg" and np.max(np.abs(good)) < 0.9:
            keys["unit"] = "rad"
            why.append("below one: radians? CONFIRM")


def seconds_of(seen: SeenColumns, time: dict[str, Any]) -> np.ndarray | None:
    """(N,) the clock of a file [s], where it is a number."""
    name = time["column"]
    if (
        not isinstance(name, str)
        or name not in seen.cells
        or "unit" not in time
        or time["unit"] not in UNITS["s"]
    ):
        return None
    return seen.numbers(name) * UNITS["s"][time["unit"]]


def speed_unit(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> None:
    """The unit of an unlabelled speed, from the distance between positions of the same file."""
    speed = next((s for s in SPEEDS if s in taken), None)
    if speed is None or "unit" in entries[speed].keys:
        return
    seen, name, _ = taken[speed]
    t, moved = seconds_of(seen, time), distance(seen, taken, entries)
    if t is None or moved is None:
        return
    shown = np.abs(seen.numbers(name))
    if speed != "speed_over_ground_mps":
        other = {"surge_velocity_mps": "sway_velocity_mps", "velocity_north_mps": "velocity_east_mps"}[speed]
        shown = (
            np.hypot(shown, seen.numbers(taken[other][1]))
            if other in taken and taken[other][0] is seen
            else shown
        )
    run = np.nansum((shown[1:] + shown[:-1]) / 2.0 * np.diff(t))
    if not run > 0.0 or not moved > 0.0:
        return
    ratio = moved / run
    unit, scale = min(
        (("m/s", 1.0), ("kn", KNOT_MPS), ("km/h", 1 / 3.6), ("ft/s", 0.3048)),
        key=lambda c: abs(np.log(ratio / c[1])),
    )
    if abs(np.log(ratio / scale)) < 0.15:
        for other in (speed, "sway_velocity_mps" if speed == "surge_velocity_mps" else speed):
            if other in entries:
                entries[other].keys["unit"] = unit
                entries[other].why.append(f"unit by the distance between positions (ratio {num(ratio, 3)})")
    else:
        entries[speed].why.append(
            f"the positions move {num(ratio, 3)} times as far as this says: unit? CONFIRM"
        )


def distance(seen: SeenColumns, taken: Taken, entries: dict[str, Any]) -> float | None:
    """Way made good between positions ten rows apart, summed [m]."""
    for first, second in (("latitude_deg", "longitude_deg"), ("north_m", "east_m")):
        if (
            first in taken
            and second in taken
            and taken[first][0] is seen
            and "unit" not in entries[first].keys
        ):
            a, b = seen.numbers(taken[first][1]), seen.numbers(taken[second][1])
            if first == "latitude_deg":
                b = b * 111_200.0 * np.cos(np.radians(np.nanmedian(a)))
                a = a * 111_200.0
            a, b = a[::10], b[::10]
            return float(np.nansum(np.hypot(np.diff(a), np.diff(b))))
    return None


def turn_unit(entries: dict[str, Any], taken: Taken, time: dict[str, Any]) -> None:
    """The unit of an unlabelled rate of turn, from how the heading of the same file turns."""
    rate, heading = "yaw_rate_degps", "heading_true_north_deg"
    if (
        rate not in taken
        or heading not in taken
        or "unit" in entries[rate].keys
        or taken[rate][0] is not taken[heading][0]
    ):
        return
    seen, name, _ = taken[rate]
    t = seconds_of(seen, time)
    if t is None or entries[heading].keys.get("unit") == "quaternion":
        return
    psi = seen.numbers(taken[heading][1]) * (
        DEG_PER_RAD if entries[heading].keys.get("unit") == "rad" else 1.0
    )
    psi, r = continuous(psi, 360.0)[::10], seen.numbers(name)
    turned = np.diff(psi)
    summed = np.add.reduceat(np.nan_to_num(r[:-1] * np.diff(t)), np.arange(0, r.size - 1, 10))[: turned.size]
    n = min(turned.size, summed.size)
    turned, summed = turned[:n], summed[:n]
    good = np.isfinite(turned)
    power = float(np.dot(summed[good], summed[good]))
    if power <= 0.0:
        return
    ratio = float(np.dot(turned[good], summed[good])) / power
    for unit, scale in (("deg/s", 1.0), ("deg/min", 1.0 / 60.0), ("rad/s", DEG_PER_RAD)):
        if abs(np.log(abs(ratio) / scale)) < 0.3 if ratio else False:
            entries[rate].keys["unit"] = unit
            if ratio < 0.0:
                entries[rate].keys["sign"] = -1
            entries[rate].why.append(f"unit by the heading's turning (ratio {num(ratio, 3)})")
            return

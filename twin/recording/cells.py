"""Cells of a table as the numbers of a channel: one column or several, letters of a hemisphere, degrees as
text."""

import re
from collections.abc import Iterable

import numpy as np

from twin.errors import DataError
from twin.recording.frames import from_ddmm
from twin.recording.mapping import QUATERNIONS, Column, Key, measured_as, target
from twin.recording.resample import USUAL_WAITS, continuous, wrapped
from twin.recording.samples import spikes
from twin.recording.table import Table
from twin.recording.units import factor

PARTS = re.compile(r"\d+(?:[.,]\d+)?")
WORDS = re.compile(r"[A-Z]+")
# of degrees, minutes and seconds; an S is the seconds' only behind the minutes' mark
UNIT_MARKS = re.compile(
    r"(?<=\d)\s*(?:D(?:EG(?:REES?)?)?|SEC(?:ONDS?)?"
    r"|M(?:IN(?:UTES?)?)?(?:\s*[\d.,]+\s*S(?:EC(?:ONDS?)?)?(?!OUTH))?)"
)
HEMISPHERES = {word: word[0] for word in ("N", "S", "E", "W", "NORTH", "SOUTH", "EAST", "WEST")}
NEGATIVE = frozenset("SWsw-")
ROUNDING_DEG = 1e-9  # of a heading: a step of Newton's that is no more was the last
PLAIN_UNITS = (None, "ddmm", "dms", *QUATERNIONS)


def number_keys(columns: Iterable[Column]) -> list[Key]:
    """The columns of a file that are read as numbers."""
    return [key for c in columns if not c.is_text for key in c.parts]


def text_keys(columns: Iterable[Column]) -> list[Key]:
    """The columns of a file that are read as text: degrees as text, letters of a hemisphere."""
    return [key for c in columns for key in (c.needs if c.is_text else c.letters)]


def optional_keys(columns: Iterable[Column]) -> list[Key]:
    """The columns of a file that a map may go without."""
    return [key for c in columns if c.optional for key in c.needs]


def there(table: Table, c: Column) -> bool:
    """Whether every column that an entry needs was read."""
    return all(key in table.numbers or key in table.texts for key in c.needs)


def converted(
    name: str, table: Table, c: Column, time_s: np.ndarray, where: str, notes: list[str]
) -> np.ndarray:
    """One channel with its sign, unit, offset, direction and lateness as docs/import.md has them (not yet its
    frame). (N,) in the channel's unit; `time_s` (N,) [s]: its rows."""
    values = raw(table, c)
    notes += [
        f"{name}: {key} is the same number in every row, while what it is added to is not: a dead sensor?"
        for key in _still(table, c)
    ]
    notes += [f"{name}: {key} is empty, and so is its sum with the others" for key in _empty(table, c)]
    scale = 1.0 if c.unit in PLAIN_UNITS else factor(target(name, c), c.unit or "", where)
    values = values * (c.sign * scale * c.factor) + c.offset + (180.0 if c.direction == "to" else 0.0)
    if c.deviation:
        values = without_deviation(values, c.deviation)
    ch = measured_as(name, c)
    if c.despike and (at := spikes(values, ch.period)).size:
        notes.append(f"{name}: {at.size} spikes blanked (first in line {table.lines[at[0]]})")
        values[at] = np.nan
    if c.late_s:
        values = wrapped(earlier(time_s, values, c.late_s, ch.period, ch.stale_s), ch.wraps)
    return values


def raw(table: Table, c: Column) -> np.ndarray:
    """The cells as one number a row, before unit, sign and offset. (N,) in the file's unit."""
    if c.is_text:
        values = degrees_of_text(table, c.parts[0])
    elif c.unit in QUATERNIONS:
        x, y, z, w = (table.numbers[key] for key in c.parts)
        yaw = np.degrees(np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))
        values = np.mod(90.0 - yaw if c.unit == "quaternion_enu" else yaw, 360.0)
    else:
        values = sum_of(in_one_row([table.numbers[key] for key in c.parts]), c.factors)
    values = from_ddmm(values) if c.unit == "ddmm" else values
    if c.hemisphere and c.hemisphere in table.texts:
        south = np.array([text[:1] in NEGATIVE for text in table.texts[c.hemisphere]])
        values = np.where(south, -np.abs(values), np.abs(values))
    return values


def _still(table: Table, c: Column) -> list[Key]:
    """The columns of a sum that never change where another one does."""
    if not c.is_sum or len(c.parts) < 2:
        return []
    told = {key: x[np.isfinite(x)] for key in c.parts for x in (table.numbers[key],)}
    still = [key for key, x in told.items() if x.size and np.all(x == x[0])]
    return still if len(still) < len(told) else []


def _empty(table: Table, c: Column) -> list[Key]:
    """The columns of a sum without any number where another one has some."""
    if c.is_text or len(c.parts) < 2:
        return []
    without = [key for key in c.parts if not np.isfinite(table.numbers[key]).any()]
    return without if len(without) < len(c.parts) else []


def sum_of(columns: list[np.ndarray], factors: tuple[float, ...]) -> np.ndarray:
    """The columns added up, each times its factor (1 where none is given). All (N,), in whatever unit the
    file has."""
    out = np.zeros(columns[0].shape)
    for values, by in zip(columns, factors or (1.0,) * len(columns), strict=True):
        out = out + values * by
    return out


def in_one_row(columns: list[np.ndarray]) -> list[np.ndarray]:
    """Columns that stand in no row together, as of two shafts that a log tells of one after the other: in
    each row that has one of them the others as they were told last, unless that is more than twice their
    usual number of rows ago. Any other columns as they are. All (N,), in whatever unit the file has."""
    told = np.isfinite(columns)
    if told.all(axis=0).any() or not told.any(axis=1).all():
        return columns
    return [np.where(told.any(axis=0), _held(x), np.nan) for x in columns]


def _held(values: np.ndarray) -> np.ndarray:
    """(N,) what was told last."""
    at = np.flatnonzero(np.isfinite(values))
    last = np.searchsorted(at, np.arange(values.size), "right") - 1
    usual = np.median(np.diff(at)) if at.size > 1 else 0.0
    ago = np.arange(values.size) - at[last]
    return np.where((last >= 0) & (ago <= 2.0 * usual), values[at[last]], np.nan)


def degrees_of_text(table: Table, key: Key) -> np.ndarray:
    """Degrees, minutes and seconds as people write them: 57°30.123'N, 11 05 30 W, -57 30.5; NaN for empty
    cells. (N,) [deg]."""
    return np.array([one_angle(table, key, i, text) for i, text in enumerate(table.texts[key])])


def one_angle(table: Table, key: Key, row: int, text: str) -> float:
    """One of them [deg], negative to the south and west. DataError: it is not degrees and minutes."""
    try:
        return degrees_of(text)
    except ValueError:
        raise DataError(
            f"{table.path}: line {table.lines[row]}, column {key!r}: {text[:40]!r} is not degrees and "
            "minutes with one of N, S, E, W (57 30.123 N). Correct it."
        ) from None


def degrees_of(text: str) -> float:
    """Degrees, minutes and seconds as text [deg]: the sign by the letter where there is one, else by the
    mark in front; NaN of a text without digits. ValueError: minutes or seconds are 60 or more, or its
    letters are not those of one hemisphere."""
    parts = [float(p.replace(",", ".")) for p in PARTS.findall(text)]
    if not parts:
        return np.nan
    if len(parts) > 3 or any(p >= 60.0 for p in parts[1:]):
        raise ValueError(text)
    size = sum(p / 60.0**k for k, p in enumerate(parts))
    sides = {HEMISPHERES.get(word) for word in WORDS.findall(UNIT_MARKS.sub(" ", text.upper()))}
    if None in sides or len(sides) > 1:
        raise ValueError(text)
    south = sides <= {"S", "W"} if sides else text.lstrip().startswith("-")
    return -size if south else size


def without_deviation(shown: np.ndarray, deviation: tuple[float, ...]) -> np.ndarray:
    """The true heading [deg] from what the compass shows: shown = true + A + B sin + C cos + D sin 2 + E
    cos 2 (true). Both (N,)."""
    a, b, c, d, e = (*deviation, *(0.0,) * (5 - len(deviation)))
    true = shown - a
    for _ in range(20):  # Newton's steps, while the coefficients are below a radian
        sin, cos = np.sin(np.radians(true)), np.cos(np.radians(true))
        sin2, cos2 = 2.0 * sin * cos, 1.0 - 2.0 * sin * sin
        off = a + b * sin + c * cos + d * sin2 + e * cos2
        slope = np.radians(b * cos - c * sin + 2.0 * (d * cos2 - e * sin2))
        more = (shown - true - off) / np.maximum(1.0 + slope, 0.5)
        true = true + more
        if not np.any(np.abs(more) > ROUNDING_DEG):
            break
    return true


def earlier(
    time_s: np.ndarray, values: np.ndarray, late_s: float, period: float, longest_s: float
) -> np.ndarray:
    """The same channel had its samples stood where they were true, `late_s` before their rows: lines
    between its neighbours no more than `longest_s` apart (or USUAL_WAITS, if that is longer), NaN outside;
    an angle (`period` > 0) without jumps. `time_s` and `values` (N,), the values in their own unit."""
    known = np.flatnonzero(np.isfinite(values) & np.isfinite(time_s))
    out = np.full(values.shape, np.nan)
    if known.size < 2:
        return out
    t, x = time_s[known] - late_s, continuous(values[known], period)
    here = time_s[known]
    after = np.clip(np.searchsorted(t, here), 1, t.size - 1)
    longest_s = max(longest_s, USUAL_WAITS * float(np.median(np.diff(t))))
    good = (here >= t[0]) & (here <= t[-1]) & (t[after] - t[after - 1] <= longest_s)
    out[known] = np.where(good, np.interp(here, t, x), np.nan)
    return out

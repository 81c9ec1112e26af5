"""The [time] table of a map for an unknown table: which column is the clock, its unit or the form of its
text."""

import re
from collections.abc import Sequence
from datetime import datetime
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.num import as_given
from twin.recording.columns_seen import SeenColumns
from twin.recording.formats.guess import guess
from twin.recording.formats.name_words import words_of
from twin.recording.mapping import TimeColumn
from twin.recording.timebase import DAY_S, FRACTION, moments
from twin.recording.units import UNITS

DAYS = ("%d.%m.%Y", "%Y/%m/%d", "%Y-%m-%d", "%d/%m/%Y", "%m/%d/%Y", "%d-%m-%Y", "%Y%m%d", "%d%m%y",
        "%d.%m.%y", "%m/%d/%y", "%d-%b-%Y", "%d %b %Y", "%b %d, %Y", "%d-%b-%y")  # fmt: skip
CLOCKS = (
    "%H:%M:%S.%f",
    "%H:%M:%S",
    "%I:%M:%S %p",
    "%I:%M:%S.%f %p",
    "%H:%M",
    "%H%M%S",
    "%H%M%S.%f",
    "%I:%M %p",
)
BETWEEN = (" ", "T", ", ", "-", "_")
TEXT_FORMATS = (
    *(f"{d}{b}{c}" for b in BETWEEN for c in CLOCKS for d in DAYS),
    *(c for c in CLOCKS if ":" in c and "%S" in c),
)
PARTS = {"year": "%Y", "month": "%m", "day": "%d", "hour": "%H", "minute": "%M", "second": "%S"}
RESTS = (("secs", "nsecs"), ("sec", "nanosec"), ("sec", "nsec"), ("secs", "nanosecs"))
EPOCHS = ((1e17, "ns"), (1e14, "us"), (1e11, "ms"), (1e8, "s"))
LOOKED_AT_ROWS = 50
DAY_AND_MONTH = re.compile("%([dm])[/-]%(?!\\1)[dm][/-]")  # with points the day is always first


def time_entry(files: Sequence[SeenColumns]) -> dict[str, Any]:
    """The [time] table: a column that every file has, its unit by name, size or form."""
    common = [n for n in files[0].names if all(n in f.names for f in files)]
    times = [n for n in common if (g := guess(n, files[0].units.get(n, ""))) and g.channel == "time"]
    seen = files[0]
    if parts := in_parts(seen, common):
        return parts
    if pair := seconds_and_rest(seen, common, times):
        return pair
    times = times or [n for n in common if counts_by_its_unit(seen, n)]
    if not times:
        return {"column": "TIME", "why": "NOT FOUND: which column is the time?"}
    dates = [
        n
        for n in times
        if "date" in words_of(n)[0] and "time" not in words_of(n)[0] and not has_clock(seen, n)
    ]
    clocks = [n for n in times if n not in dates]
    if dates and clocks and not counts_on(seen, clocks[0]):
        joined = [
            f"{a} {b}"
            for a, b in zip(
                seen.texts(dates[0])[:LOOKED_AT_ROWS], seen.texts(clocks[0])[:LOOKED_AT_ROWS], strict=True
            )
        ]
        found = text_format(joined) or {"why": "which format?"}
        return {"column": [seen.key(dates[0]), seen.key(clocks[0])], **found}
    name = min(
        clocks or times,
        key=lambda n: (
            not np.isfinite(seen.numbers(n)).any() and not text_format(seen.texts(n)[:LOOKED_AT_ROWS]),
            standing(seen, n),
            times.index(n),
        ),
    )
    return {"column": seen.key(name), **clock_of(seen, name)}


def counts_by_its_unit(seen: SeenColumns, name: str) -> bool:
    """Whether a column whose name is no clock's has a unit of time, and every number beyond the last."""
    unit, numbers = words_of(name)[1] or seen.units.get(name, ""), seen.numbers(name)
    return unit in UNITS["s"] and numbers.size > 1 and bool(np.all(np.diff(numbers) > 0.0))


def clock_of(seen: SeenColumns, name: str) -> dict[str, Any]:
    """The unit of a column of numbers, or the form of one of text, and why."""
    values = seen.numbers(name)
    if not np.isfinite(values).any():
        return text_format(seen.texts(name)[:LOOKED_AT_ROWS]) or {"why": "which format?"}
    g = guess(name, seen.units.get(name, ""))
    stated = g.unit if g and g.unit in UNITS["s"] else ""
    unit, why = (stated, "unit by its name") if stated and sensible(values, stated) else clock_unit(values)
    return {"unit": unit, "why": why}


def sensible(values: np.ndarray, unit: str) -> bool:
    """Whether numbers (N,) in that unit are seconds from the start, or a date of our century."""
    first = float(values[np.isfinite(values)][0]) * UNITS["s"][unit]
    return abs(first) < 1e8 or 1e8 < first < 4.2e9


def standing(seen: SeenColumns, name: str) -> bool:
    """Whether a column of numbers hardly ever changes: it is no clock."""
    values = seen.numbers(name)
    values = values[np.isfinite(values)]
    return values.size > 2 and np.count_nonzero(np.diff(values) > 0.0) < 0.2 * values.size


def has_clock(seen: SeenColumns, name: str) -> bool:
    """Whether the text of a column holds a time of day."""
    return any(":" in s for s in seen.texts(name)[:LOOKED_AT_ROWS])


def counts_on(seen: SeenColumns, name: str) -> bool:
    """Whether a column is seconds that count on, and no time of day written as a number."""
    values = seen.numbers(name)
    good = values[np.isfinite(values)]
    of_day = [s for s in seen.texts(name)[:LOOKED_AT_ROWS] if len(s.partition(".")[0]) == 6]
    return bool(good.size) and (good[0] > 1e8 or (not of_day and good[0] < 86400.0))


def in_parts(seen: SeenColumns, common: Sequence[str]) -> dict[str, Any] | None:
    """Year, month, day, hour, minute and second in columns of their own; None where they are not."""
    held = {
        part: n for n in common for part in PARTS if words_of(n)[0][:1] == [part] or n.strip().lower() == part
    }
    seconds = next((n for n in common if n.strip().lower() in ("sec", "seconds")), None)
    held = ({"second": seconds} if seconds else {}) | held
    if not {"year", "month", "day", "hour", "minute", "second"} <= set(held):
        return None
    fraction = ".%f" * any("." in s for s in seen.texts(held["second"])[:LOOKED_AT_ROWS])
    return {
        "column": [seen.key(held[p]) for p in PARTS],
        "format": " ".join(PARTS.values()) + fraction,
        "why": "in six columns",
    }


def seconds_and_rest(seen: SeenColumns, common: Sequence[str], times: Sequence[str]) -> dict[str, Any] | None:
    """Whole seconds since 1970 in one column and nanoseconds in another, where no other column is a clock."""
    pairs = [(a, b) for a in common for b in common if is_rest(a, b)]
    if not pairs or any(all(n not in pair for pair in pairs) for n in times):
        return None
    columns = [seen.key(n) for n in pairs[0]]
    return {"column": columns, "factors": [1, 1e-9], "why": "seconds and nanoseconds"}


def is_rest(seconds: str, other: str) -> bool:
    """Whether a column's name is that of seconds with the word for nanoseconds in its place."""
    a, b = seconds.lower(), other.lower()
    return any(a.endswith(x) and b == a.removesuffix(x) + y for x, y in RESTS)


def clock_unit(values: np.ndarray) -> tuple[str, str]:
    """(unit, why): since 1970 by size, days of a spreadsheet, else by the usual step. `values` (N,) in the
    unit of the file."""
    good = values[np.isfinite(values)]
    first = float(good[0])
    for least, unit in EPOCHS:
        if first > least:
            return unit, "since 1970, by its size"
    steps = np.diff(good)
    step = float(np.median(steps)) if steps.size else 1.0
    if 30_000.0 < first < 80_000.0 and 0.0 < step * DAY_S < 3600.0 and step < 0.04:
        return "excel", "days since 1900 as spreadsheets count them, by their size"
    if step >= 1e4 and steps.size > 10:
        return "us", f"a step of {as_given(step, 4)}: microseconds? CONFIRM"
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
        if len(filled[0]) > 8:
            return {"unit": "iso"}
    except ValueError:
        pass
    day = min(len(s.split()[0]) for s in filled)
    for form in TEXT_FORMATS:
        if form.startswith("%Y%m%d") and day < 8:
            continue
        if read := read_by(filled, form):
            return {"format": form} | other_order(filled, form, read)
    return None


def read_by(stamps: Sequence[str], form: str) -> list[datetime]:
    """The moments of the stamps; none where one of them is not of this form."""
    try:
        return [datetime.strptime(cut(s), form) for s in stamps]
    except ValueError:
        return []


def other_order(stamps: Sequence[str], form: str, read: Sequence[datetime]) -> dict[str, Any]:
    """What is to be confirmed of a date with strokes: it may be one with day and month exchanged."""
    turned = re.sub("%[dm]", lambda m: "%m" if m[0] == "%d" else "%d", form)
    if not DAY_AND_MONTH.match(form) or read_by(stamps, turned) in ([], list(read)):
        return {}
    first = "the day" if form.startswith("%d") else "the month"
    return {"why": f"{first} first? CONFIRM"}


def cut(stamp: str) -> str:
    """A stamp whose fraction has at most six digits, as strptime reads them, with a point."""
    found = FRACTION.match(stamp)
    return f"{found[1]}.{found[2][:6]}{found[3] or ''}" if found else stamp


def seconds_of(seen: SeenColumns, time: dict[str, Any]) -> np.ndarray | None:
    """(N,) the clock of a table [s], by its [time] table; None where that does not read it."""
    names = [
        n
        for k in (time["column"] if isinstance(time["column"], list) else [time["column"]])
        for n in seen.names
        if seen.key(n) == k
    ]
    if not names:
        return None
    if time.get("unit") == "excel":
        return seen.numbers(names[0]) * DAY_S
    if "factors" in time:
        return sum(seen.numbers(n) * f for n, f in zip(names, time["factors"], strict=True))  # type: ignore[return-value]
    if time.get("unit", "iso") in UNITS["s"]:
        return seen.numbers(names[0]) * UNITS["s"][time["unit"]]
    spec = TimeColumn(unit="iso" if "format" not in time else "s", format=time.get("format", ""))
    words = [" ".join(parts) for parts in zip(*(seen.texts(n) for n in names), strict=True)]
    try:
        return moments(seen.path, np.arange(len(words)), words, spec)
    except DataError:
        return None

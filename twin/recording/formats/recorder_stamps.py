"""Time stamps in front of a message, as recorders write them: seconds since 1970, ISO 8601, time of day."""

import re
from collections.abc import Callable
from datetime import UTC, datetime

ISO = re.compile(
    r"(\d{4})[-/](\d\d)[-/](\d\d)[T_ -](\d\d):?(\d\d):?(\d\d)(?:[.,](\d{1,9}))?(Z|[+-]\d\d:?\d\d)?"
)
DAY = re.compile(r"(?<!\d)(\d\d):(\d\d):(\d\d)(?:[.,](\d{1,9}))?")
NUMBER = re.compile(r"(?<![\d.])(\d{9,19}(?:\.\d+)?)(?![\d.])")
UNITS = ((1e17, 1e-9), (1e14, 1e-6), (1e11, 1e-3), (0.0, 1.0))
FIRST_S, LAST_S = 3.0e8, 4.2e9  # 1979 to 2103
DAY_S = 86400.0


def days_from_civil(year: int, month: int, day: int) -> int:
    """Days since 1970-01-01; ValueError for a date that is none."""
    return (datetime(year, month, day, tzinfo=UTC) - datetime(1970, 1, 1, tzinfo=UTC)).days


def from_iso(text: str) -> float | None:
    """Seconds since 1970 of an ISO 8601 date and time; None: there is none."""
    found = ISO.search(text)
    if not found:
        return None
    year, month, day, hour, minute, second, part, zone = found.groups()
    try:
        t = (
            days_from_civil(int(year), int(month), int(day)) * DAY_S
            + int(hour) * 3600
            + int(minute) * 60
            + int(second)
        )
    except ValueError:
        return None
    if zone and zone != "Z":
        t -= (1 if zone[0] == "+" else -1) * (int(zone[1:3]) * 3600 + int(zone[-2:]) * 60)
    return t + (float(f"0.{part}") if part else 0.0)


def from_day(text: str) -> float | None:
    """Seconds since midnight of a time of day; None: there is none."""
    found = DAY.search(text)
    if not found:
        return None
    hour, minute, second, part = found.groups()
    return int(hour) * 3600.0 + int(minute) * 60 + int(second) + (float(f"0.{part}") if part else 0.0)


def from_epoch(text: str) -> float | None:
    """Seconds, milliseconds, microseconds or nanoseconds since 1970, told apart by their size."""
    found = NUMBER.search(text)
    if not found:
        return None
    value = float(found.group(1))
    seconds = value * next(scale for least, scale in UNITS if value >= least)
    return seconds if FIRST_S < seconds < LAST_S else None


WAYS: tuple[Callable[[str], float | None], ...] = (from_iso, from_epoch, from_day)


class Stamp:
    """Reads the stamps of one log: the way that reads the first is kept; a time of day counts on past
    midnight."""

    def __init__(self) -> None:
        self._way: Callable[[str], float | None] | None = None
        self._day, self._last = 0.0, -1.0

    def __call__(self, text: str) -> float | None:
        if self._way is None:
            self._way = next((way for way in WAYS if way(text) is not None), None)
        t = self._way(text) if self._way else None
        return self.past_midnight(t) if t is not None and self._way is from_day else t

    def past_midnight(self, t: float) -> float:
        """A time of day as seconds since the first midnight."""
        if t + self._day < self._last - DAY_S / 2:
            self._day += DAY_S
        self._last = t + self._day
        return self._last

"""The clock of a file: stamps as numbers or as text, to seconds; rounded stamps made even again."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from twin.errors import DataError
from twin.live.keelson.stamps import LATEST_S, YEAR_S
from twin.num import as_given, num
from twin.recording.mapping import TimeColumn
from twin.recording.units import UNITS

EPOCH_S = 1e8  # a number of seconds above this counts from 1970, not from the start of the voyage
FINER = {"ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}
DAY_S = 86400.0
EXCEL_1970 = 25569.0  # days from 30 December 1899 to 1 January 1970
OF_A_DATE = ("%d", "%j", "%m", "%b", "%B", "%Y", "%y", "%s", "%c", "%x", "%D", "%F")
FRACTION = re.compile(r"^(.*:\d\d)[.,](\d{1,9})(\D.*)?$")  # up to the seconds, their fraction, a zone


@dataclass(frozen=True)
class TimeAxis:
    """(N,) seconds, the UTC time of zero when the file knows it, and what was assumed."""

    time_s: np.ndarray
    start_time_utc: str | None = None
    notes: tuple[str, ...] = ()


def clock_from_numbers(path: Path, stamps: np.ndarray, spec: TimeColumn) -> TimeAxis:
    """Stamps (N,): numbers in the map's unit; seconds since 1970 become seconds since the first sample.

    A number of seconds that only fits our century as milliseconds, microseconds or nanoseconds since 1970
    is read so, and a note says it; DataError when no unit gives a date."""
    if spec.unit == "excel":
        stamps, spec = (stamps - EXCEL_1970) * DAY_S, replace(spec, unit="s")
    time_s = stamps * UNITS["s"][spec.unit]
    finite = time_s[np.isfinite(time_s)]
    if not finite.size or abs(finite[0]) <= EPOCH_S:
        return TimeAxis(time_s)
    if EPOCH_S < finite[0] <= LATEST_S:
        return TimeAxis(time_s - finite[0], utc(finite[0]))
    unit = (
        next((u for u in FINER if EPOCH_S < finite[0] * UNITS["s"][u] <= LATEST_S), None)
        if spec.unit == "s"
        else None
    )
    if unit is None:
        raise DataError(
            f"{path}: its first time stamp, {as_given(finite[0], 6)} s, is no time since the begin of a "
            "voyage and no date before 2100. "
            'Correct the stamps, or give their unit in a map: [time] unit = "ms" (s, ms, us, ns, min, h).'
        )
    first = finite[0] * UNITS["s"][unit]
    said = (
        f"the time counts {FINER[unit]} since 1970 (its first stamp is {as_given(finite[0], 6)}, which in "
        "seconds is no date) and was "
        f'read so, from {utc(first)}; in a map: [time] unit = "{unit}"'
    )
    return TimeAxis((time_s - finite[0]) * UNITS["s"][unit], utc(first), (said,))


def clock_from_text(path: Path, lines: np.ndarray, stamps: Sequence[str], spec: TimeColumn) -> TimeAxis:
    """ISO-8601 or strptime stamps, in the file's lines (N,); without a zone they are taken as UTC. The
    clock is in [s]. DataError: they begin after 2100."""
    seconds = moments(path, lines, stamps, spec)
    if spec.format and not any(part in spec.format for part in OF_A_DATE):
        return TimeAxis(past_midnights(seconds))
    finite = seconds[np.isfinite(seconds)]
    if finite.size and finite[0] > LATEST_S:
        first = stamps[int(np.flatnonzero(np.isfinite(seconds))[0])]
        raise DataError(f"{path}: its first time stamp, {first!r}, lies after 2100. Correct the stamps.")
    return TimeAxis(seconds - finite[0], utc(finite[0])) if finite.size else TimeAxis(seconds)


def past_midnights(seconds: np.ndarray) -> np.ndarray:
    """Times of day (N,) [s] as seconds since the first midnight: where they fall by most of a day, the next
    day begins."""
    good = np.flatnonzero(np.isfinite(seconds))
    if not good.size:
        return seconds
    out, days = seconds.copy(), np.cumsum(np.r_[0, np.diff(seconds[good]) < -DAY_S / 2.0])
    out[good] = seconds[good] - DAY_S * np.floor(seconds[good[0]] / DAY_S) + DAY_S * days
    return out


def moments(path: Path, lines: np.ndarray, stamps: Sequence[str], spec: TimeColumn) -> np.ndarray:
    """(N,) seconds since 1970 of all stamps. The whole second is worked out once for all stamps in it; a
    fraction may have nine digits, or be a count of nanoseconds without its leading zeros, which is
    believed when only so the clock runs forward."""
    known: dict[str, float] = {}
    whole, parts, digits = np.empty(len(stamps)), np.zeros(len(stamps)), np.zeros(len(stamps), int)
    form = replace(spec, format=spec.format.replace(".%f", "").replace(",%f", "")) if spec.format else spec
    for i, stamp in enumerate(stamps):
        found = FRACTION.match(stamp)
        text, part = (
            (found[1] + (found[3] or ""), found[2])
            if found and (not spec.format or form is not spec)
            else (stamp, "")
        )
        if text not in known:
            known[text] = moment(path, int(lines[i]), text, form if part else spec, stamp)
        whole[i], digits[i] = known[text], len(part)
        parts[i] = int(part or 0)
    plain = whole + parts / 10.0**digits
    most = int(digits.max(initial=0))
    if most in (3, 6, 9) and (digits[digits > 0] < most).any() and backwards(plain):
        counted = whole + parts / 10.0**most
        return counted if backwards(counted) < backwards(plain) else plain
    return plain


def backwards(seconds: np.ndarray) -> int:
    """How often a clock goes back. Stamps (N,) [s]."""
    return int(np.count_nonzero(np.diff(seconds[np.isfinite(seconds)]) < 0.0))


def moment(path: Path, line: int, stamp: str, spec: TimeColumn, shown: str = "") -> float:
    """Seconds since 1970 of one stamp; NaN for an empty cell. `shown`: as the file has it. DataError: it
    is no such stamp."""
    if not stamp:
        return np.nan
    try:
        t = datetime.strptime(stamp, spec.format) if spec.format else datetime.fromisoformat(stamp)
    except ValueError:
        raise DataError(f"{path}: line {line}: {_no_time(shown or repr(stamp), spec.format)}") from None
    return (t if t.tzinfo else t.replace(tzinfo=UTC)).timestamp()


def _no_time(shown: str, form: str | None) -> str:
    """What is wrong with a stamp that this format does not read, and what to do."""
    pattern = '[time] format = "%d.%m.%Y %H:%M:%S"'
    if form and "%" not in form:
        return (
            f"the time {shown} cannot be read: {form!r} is no format. Leave it out of the map for ISO "
            f"8601, or give one such as {pattern}."
        )
    wanted = form or "ISO 8601, such as 2024-05-17T08:30:00.25Z"
    return f"the time {shown} is not {wanted}. Correct it, or give its format in a map: {pattern}."


def utc(seconds: float) -> str:
    """The moment as ISO 8601."""
    return datetime.fromtimestamp(seconds, UTC).isoformat().replace("+00:00", "Z")


def day(seconds: float, form: str) -> str:
    """The UTC day of a moment [s since 1970] in this format; "" of none."""
    return datetime.fromtimestamp(seconds, UTC).strftime(form) if np.isfinite(seconds) else ""


def moment_of(stamp: str | None) -> float:
    """Seconds since 1970 of an ISO-8601 stamp; 0 when there is none."""
    return datetime.fromisoformat(stamp).timestamp() if stamp else 0.0


def refuse_leaps(path: Path, lines: np.ndarray, time_s: np.ndarray) -> None:
    """A hole of months is one; a stamp that lies years ahead is wrong, and so is what was judged by it.
    `lines` and `time_s` (N,), the latter in [s]. DataError: time leaps by more than a year."""
    ahead = np.flatnonzero(np.diff(time_s) > YEAR_S)
    if ahead.size:
        i = int(ahead[0])
        raise DataError(
            f"{path}: line {lines[i + 1]}: time leaps ahead from {as_given(time_s[i])} s to "
            f"{as_given(time_s[i + 1])} s, by more than a year ({ahead.size} times in all). A clock that was "
            "not set yet, or a wrong stamp? Correct or remove these rows, or split the file there."
        )


def refuse_backwards(path: Path, lines: np.ndarray, time_s: np.ndarray) -> None:
    """Time may stand still (a check says so) but not go back: nobody can tell which half is right. `lines`
    and `time_s` (N,), the latter in [s]. DataError: it does."""
    back = np.flatnonzero(np.diff(time_s) < 0.0)
    if not back.size:
        return
    i = int(back[0])
    why = "Two files pasted together, or rows out of order? Split or sort it."
    if DAY_S * 0.9 < time_s[i] - time_s[i + 1] <= DAY_S:
        why = "The clock passes midnight: export the date too."
    raise DataError(
        f"{path}: line {lines[i + 1]}: time goes back from {as_given(time_s[i])} s to "
        f"{as_given(time_s[i + 1])} s ({back.size} times in all). {why}"
    )


def refuse_standing(path: Path, time_s: np.ndarray) -> None:
    """`time_s` (N,) [s], not going back. DataError: it does not run on from the first row to the last."""
    if not time_s[-1] > time_s[0]:
        raise DataError(
            f"{path}: all {time_s.size} rows have the same time. Is it the right time column, and the whole "
            "of it (a date without its time of day)?"
        )


def rebuilt(path: Path, time_s: np.ndarray, step: bool | float) -> tuple[np.ndarray, str]:
    """Even stamps in place of rounded ones, and a sentence that says so.

    The step is the given one [s], or the straight line through the stamps. Refused when a stamp lies
    farther from the line than rounding explains: then rows are missing. Both (N,). DataError: so refused."""
    k = np.arange(time_s.size)
    if step is True:
        step, start = (float(c) for c in np.polyfit(k, time_s, 1)) if time_s.size > 1 else (1.0, time_s[0])
    else:
        step = float(step)
        start = float(np.mean(time_s - step * k))
    off = np.abs(time_s - start - step * k)
    steps = np.diff(time_s)
    rounding = float(np.quantile(steps[steps > 0.0], 0.95)) if np.any(steps > 0.0) else 0.0
    worst, allowed = int(np.argmax(off)), rounding + step
    if off[worst] > allowed:
        raise DataError(
            f"{path}: row {worst + 1}: the stamp {as_given(time_s[worst])} s lies {num(off[worst], 3)} s "
            f"from an even step of {as_given(step, 6)} s; rounding explains {num(allowed, 2)} s. Rows are "
            "missing, or the step is wrong: leave rebuild out."
        )
    within = f"the stamps are within {num(off.max(), 2)} s of it"
    return time_s[0] + step * k, f"time stamps rebuilt with an even step of {as_given(step, 6)} s ({within})"

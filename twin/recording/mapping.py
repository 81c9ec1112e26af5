"""A map: how to read a file that has its own columns, units, signs and clock. Format: docs/import.md."""

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from twin.live.signals.channels import BY_NAME, Channel

FRAMED = ("surge_velocity_mps", "sway_velocity_mps")
PLACES = ("latitude_deg", "longitude_deg")
HEADING = "heading_true_north_deg"
COURSE = "course_deg"  # what a course over ground is, whatever column it fills
NAMES = (*BY_NAME, *PLACES)
FRAMES = ("body", "earth", "course")
GROUND = {  # what stands for the velocities in the ship's axes, by the frame that a map would name
    "course": ("speed_over_ground_mps", "course_over_ground_deg"),
    "earth": ("velocity_north_mps", "velocity_east_mps"),
}
QUATERNIONS = ("quaternion", "quaternion_enu")  # units of a heading in four columns
SEPARATORS = {"tab": "\t", "whitespace": " ", ",": ",", ";": ";", "\t": "\t", " ": " ", "|": "|"}
Key = str | int  # a column by its name, or by its number from 1


@dataclass(frozen=True)
class Layout:
    """`[file]`: how the text is cut into cells. None: found by looking."""

    skip_lines: int = 0
    header: bool = True
    skip_after_header: int = 0
    separator: str | None = None  # "," ";" "tab" "whitespace"
    decimal: str | None = None  # "." ","
    encoding: str | None = None
    long: tuple[str, ...] = ()  # a row a reading: the columns of its name and its value
    missing: tuple[str, ...] = ()  # cells that mean "no sample", as written


@dataclass(frozen=True)
class TimeColumn:
    """`[time]`: a number in `unit`, or text (`unit = "iso"` or a strptime `format`); `rebuild` makes it
    even.
    """

    column: Key | tuple[Key, ...] = "time_s"
    unit: str = "s"
    format: str = ""
    rebuild: bool | float = False  # true: the even step that fits the stamps best; a number: this step [s]
    # a number in several columns (seconds, nanoseconds): what each is multiplied by
    factors: tuple[float, ...] = ()

    @property
    def parts(self) -> tuple[Key, ...]:
        """Every column that holds a part of the stamps."""
        return self.column if isinstance(self.column, tuple) else (self.column,)

    @property
    def is_text(self) -> bool:
        """Whether its stamps are text."""
        return self.unit == "iso" or bool(self.format)

    @property
    def is_sum(self) -> bool:
        """Whether its columns are numbers that are added up."""
        return not self.is_text


@dataclass(frozen=True)
class Column:
    """One entry of `[columns]`: cell * factor * sign * unit + offset (offset in the channel's unit)."""

    column: Key | tuple[Key, ...]  # several: their sum by `factors`, or the x, y, z, w of unit = "quaternion"
    unit: str | None = None
    sign: int = 1
    factor: float = 1.0
    factors: tuple[float, ...] = ()
    hemisphere: Key | None = None  # a column of letters: S and W make the value negative
    file: str = ""  # of several files the one that the column stands in: the end of its path, * for any part
    late_s: float = 0.0  # the samples stand in rows this much later [s] than when they were true
    # compass: A to E [deg] of A + B sin + C cos + D sin 2 + E cos 2 of the true heading
    deviation: tuple[float, ...] = ()
    offset: float = 0.0
    # velocities: body; earth (north, east); course (speed over ground, course over ground)
    frame: str = "body"
    direction: str = "from"  # wind and waves: where they come from, or go "to"
    despike: bool = False
    optional: bool = False  # a file without this column is read without it

    @property
    def parts(self) -> tuple[Key, ...]:
        """Every column that holds its value."""
        return self.column if isinstance(self.column, tuple) else (self.column,)

    @property
    def letters(self) -> tuple[Key, ...]:
        """The column of its hemisphere, if it has one."""
        return () if self.hemisphere is None else (self.hemisphere,)

    @property
    def needs(self) -> tuple[Key, ...]:
        """Every column without which it cannot be read."""
        return (*self.parts, *self.letters)

    @property
    def is_text(self) -> bool:
        """Whether its cells are degrees and minutes as text."""
        return self.unit == "dms"

    @property
    def is_sum(self) -> bool:
        """Whether its columns are numbers that are added up."""
        return self.unit not in ("dms", *QUATERNIONS)


@dataclass(frozen=True)
class Map:
    """A whole map. Without a file: the columns are the channels' own names."""

    name: str = ""
    layout: Layout = Layout()
    time: TimeColumn | None = None
    columns: Mapping[str, Column] = field(default_factory=dict)
    constant: Mapping[str, float] = field(default_factory=dict)
    froude_scale: float = 1.0  # the ship is this many times as long as the model that was measured
    description: str = ""


def target(name: str, entry: Column) -> str:
    """The name whose unit the cell must reach: a course over ground is an angle, whatever column it fills."""
    return COURSE if entry.frame == "course" and name == FRAMED[1] else name


def measured_as(name: str, entry: Column) -> Channel:
    """The channel with the period and the age of an entry's samples: a course over ground turns as a heading
    does, a latitude or longitude is a position."""
    return BY_NAME[HEADING] if target(name, entry) == COURSE else BY_NAME.get(name, BY_NAME["north_m"])


def nearest(name: str, known: Iterable[str]) -> str:
    """The known name that is written most alike, or that holds this one as a word; '' when none does."""
    known = list(known)
    close = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    return next(iter(close), "") or next((k for k in known if name.lower() in k.split("_")), "")

"""A map from its TOML file (format: docs/import.md); a mistake in it is a SettingsError that says where."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from twin.errors import SettingsError, did_you_mean
from twin.live.signals.channels import BY_NAME
from twin.num import as_given
from twin.physics.actuators.actuator_channels import CHANNELS_OF
from twin.recording.mapping import (
    FRAMED,
    FRAMES,
    GROUND,
    HEADING,
    NAMES,
    PLACES,
    QUATERNIONS,
    SEPARATORS,
    Column,
    Layout,
    Map,
    TimeColumn,
    nearest,
    target,
)
from twin.recording.units import UNITS, factor

WORDS: dict[type, str] = {
    int: "a whole number",
    float: "a number",
    str: "text",
    bool: "true or false",
    list: "a list",
}
KINDS: dict[str, tuple[type, ...]] = {
    "skip_lines": (int,),
    "header": (bool,),
    "skip_after_header": (int,),
    "separator": (str,),
    "decimal": (str,),
    "encoding": (str,),
    "missing": (list,),
    "long": (list,),
    "column": (str, int, list),
    "unit": (str,),
    "format": (str,),
    "rebuild": (bool, int, float),
    "sign": (int,),
    "offset": (int, float),
    "frame": (str,),
    "direction": (str,),
    "despike": (bool,),
    "optional": (bool,),
    "factor": (int, float),
    "factors": (list,),
    "hemisphere": (str, int),
    "file": (str,),
    "late_s": (int, float),
    "deviation": (list,),
}
NUMBERS = ("factors", "deviation")  # lists of numbers; the others are lists of names


def read_map(path: Path) -> Map:
    """The map in a TOML file; SettingsError says which entry is wrong and what it may be."""
    try:
        data = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read: {error.strerror}.") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SettingsError(f"{path}: is not valid TOML: {error}.") from None
    return parse_map(data, str(path))


def parse_map(data: Mapping[str, Any], where: str) -> Map:
    """A map from its TOML table; `where` names it in messages. SettingsError: something in it cannot be
    meant."""
    known(data, ("description", "file", "time", "columns", "constant", "scale"), where)
    scale = known(data.get("scale", {}), ("froude",), f"{where}: [scale]").get("froude", 1.0)
    entries = in_frames(a_table(data.get("columns", {}), f"{where}: [columns]"), where)
    columns = {name: column(name, entry, where) for name, entry in entries.items()}
    given = a_table(data.get("constant", {}), f"{where}: [constant]")
    constant = {n: number(x, f"{where}: [constant] {n}") for n, x in given.items()}
    for name in constant:
        channel_name(name, where)
    frames_agree(columns, where)
    places_agree(columns, constant, where)
    layout: Layout = build(Layout, data.get("file", {}), f"{where}: [file]")
    one_of(layout.separator, (None, *SEPARATORS), f"{where}: [file] separator")
    one_of(layout.decimal, (None, ".", ","), f"{where}: [file] decimal")
    for key, lines in (("skip_lines", layout.skip_lines), ("skip_after_header", layout.skip_after_header)):
        if lines < 0:
            raise SettingsError(f"{where}: [file] {key} = {lines} must be a number of lines, 0 or more.")
    if len(layout.long) not in (0, 2):
        raise SettingsError(
            f"{where}: [file] long names two columns: that of the names and that of the values."
        )
    if not number(scale, f"{where}: [scale] froude") > 0.0:
        raise SettingsError(
            f"{where}: [scale] froude = {scale} must be positive (ship length / model length)."
        )
    return Map(
        name=Path(where).stem,
        layout=layout,
        time=time_column(data["time"], where) if "time" in data else None,
        columns=columns,
        constant=constant,
        froude_scale=float(scale),
        description=str(data.get("description", "")),
    )


def in_frames(entries: Mapping[str, Any], where: str) -> dict[str, Any]:
    """The entries, those of speed and course over ground or of north and east as velocities in that frame.
    SettingsError: one velocity has two."""
    meant = {
        name: (own, frame) for frame, pair in GROUND.items() for own, name in zip(FRAMED, pair, strict=True)
    }
    out = dict[str, Any]()
    for name, entry in entries.items():
        own, frame = meant.get(name, (name, None))
        if own in out:
            raise SettingsError(f"{where}: {name} is a second entry for {own}. Remove one of them.")
        table = {"column": name} | dict(entry) if isinstance(entry, Mapping) else {"column": entry}
        out[own] = table | {"frame": frame} if frame else entry
    return out


def column(name: str, entry: Any, where: str) -> Column:
    """One entry: `"NAME"`, `3`, or a table; a table without `column` is of the column with the channel's
    own name. SettingsError: its keys do not fit each other or the channel."""
    channel_name(name, where)
    table = {"column": name} | dict(entry) if isinstance(entry, Mapping) else {"column": entry}
    out: Column = build(Column, table, f"{where}: [columns] {name}")
    one_of(out.frame, FRAMES, f"{where}: {name}: frame")
    one_of(out.direction, ("from", "to"), f"{where}: {name}: direction")
    one_of(out.sign, (1, -1), f"{where}: {name}: sign")
    if out.frame != "body" and name not in FRAMED:
        raise SettingsError(f"{where}: {name}: frame is for {' and '.join(FRAMED)} only. Remove it.")
    if out.optional and name in FRAMED:
        raise SettingsError(
            f"{where}: {name}: a velocity has two parts and cannot be optional. Write a map without it."
        )
    if out.unit is not None and out.unit not in special_units(name):
        factor(target(name, out), out.unit, where)
    several_agree(out, f"{where}: [columns] {name}")
    return out


def special_units(name: str) -> tuple[str, ...]:
    """Ways of writing a channel that are no factor."""
    return ("ddmm", "dms") if name in PLACES else QUATERNIONS if name == HEADING else ()


def several_agree(out: Column, where: str) -> None:
    """How many columns there are must fit what is made of them. SettingsError: they do not."""
    factors_agree(out, where)
    n = len(out.parts)
    if out.unit in QUATERNIONS and n != 4:
        raise SettingsError(f"{where}: a quaternion needs column = [X, Y, Z, W], four of them.")
    if n > 1 and out.is_text:
        raise SettingsError(f"{where}: degrees and minutes as text stand in one column.")
    if len(out.deviation) > 5:
        raise SettingsError(f"{where}: deviation has at most five coefficients, A to E in deg.")


def factors_agree(out: Column | TimeColumn, where: str) -> None:
    """There is a column, and where columns are added up a factor for each or none. SettingsError: it is not
    so."""
    n = len(out.parts)
    if not n:
        raise SettingsError(f"{where}: column names no column. Name one, or remove the entry.")
    if out.factors and not out.is_sum:
        raise SettingsError(f"{where}: factors is for numbers that are added up. Remove it.")
    if len(out.factors) not in (0, n):
        raise SettingsError(f"{where}: factors needs {n} number{'s' * (n > 1)}, one for each column.")


def frames_agree(columns: Mapping[str, Column], where: str) -> None:
    """Surge and sway must be measured in the same frame, and both be there unless that frame is the ship.
    SettingsError: they are not."""
    frames = [columns[name].frame for name in FRAMED if name in columns]
    if len(set(frames)) > 1 or (len(frames) == 1 and frames[0] != "body"):
        raise SettingsError(f"{where}: {' and '.join(FRAMED)} need the same frame, both of them: {frames}.")


def places_agree(columns: Mapping[str, Column], constant: Mapping[str, float], where: str) -> None:
    """A position is one pair: one half of it beside the other pair is a sign or an offset in the wrong
    place. SettingsError: it is such a half."""
    pairs = (PLACES, ("north_m", "east_m"))
    for pair, other in (pairs, pairs[::-1]):
        half = [name for name in pair if name in columns or name in constant]
        if len(half) == 1 and any(name in columns for name in other):
            twin = other[pair.index(half[0])]
            raise SettingsError(
                f"{where}: {half[0]} stands beside {' and '.join(other)}; a position is one pair. "
                f"A sign or an offset belongs to {twin}: write it there and remove {half[0]}."
            )


def time_column(entry: Any, where: str) -> TimeColumn:
    """The entry `[time]`. SettingsError: its step is not positive, or its factors do not fit its columns."""
    out: TimeColumn = build(TimeColumn, entry, f"{where}: [time]")
    one_of(out.unit, (*UNITS["s"], "iso", "excel"), f"{where}: [time] unit")
    factors_agree(out, f"{where}: [time]")
    if not isinstance(out.rebuild, bool) and not out.rebuild > 0.0:
        raise SettingsError(
            f"{where}: [time] rebuild = {as_given(out.rebuild)} must be true, false or a step in seconds."
        )
    return out


def build(kind: Any, table: Any, where: str) -> Any:
    """A dataclass from a TOML table, refusing unknown keys by name."""
    names = [f.name for f in fields(kind)]
    table = known(table, names, where)
    for key, value in table.items():
        right_kind(value, KINDS[key], f"{where} {key}")
    return kind(**{k: as_tuple(k, v, where) if isinstance(v, list) else v for k, v in table.items()})


def as_tuple(key: str, values: list[Any], where: str) -> tuple[Any, ...]:
    """A list of numbers, of column names and numbers, or of words."""
    if key in NUMBERS:
        return tuple(number(v, f"{where} {key}") for v in values)
    return tuple(
        v if key == "column" and isinstance(v, int) and not isinstance(v, bool) else str(v) for v in values
    )


def known(table: Any, names: Any, where: str) -> Mapping[str, Any]:
    """The table, when it has no other keys than `names`. SettingsError: it has, or is no table."""
    for name in a_table(table, where):
        if name not in names:
            raise SettingsError(f"{where}: nothing is called {name!r} here.{did_you_mean(name, names)}")
    return a_table(table, where)


def a_table(value: Any, where: str) -> Mapping[str, Any]:
    """The value as a table. SettingsError: it is none."""
    if not isinstance(value, Mapping):
        raise SettingsError(f"{where}: is {value!r}; it must be a table.")
    return value


def one_of(value: Any, allowed: tuple[Any, ...], where: str) -> None:
    """SettingsError: the value is none of those allowed."""
    if value not in allowed:
        raise SettingsError(f"{where} = {value!r} is not possible. Known: {', '.join(map(str, allowed))}.")


def right_kind(value: Any, kinds: tuple[type, ...], where: str) -> None:
    """SettingsError: the value is of none of these types; a bool is no number."""
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        raise SettingsError(f"{where} = {value!r} must be {' or '.join(WORDS[kind] for kind in kinds)}.")


def number(value: Any, where: str) -> float:
    """The value as a number. SettingsError: it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise SettingsError(f"{where} = {value!r} must be a number.")
    try:
        return float(value)
    except OverflowError:
        raise SettingsError(f"{where} = {value!r:.60} is longer than a number can be.") from None


def of_actuator(owner: str, last: str) -> str:
    """The channel of an actuator that is written most alike; "" when none is."""
    near = f"{re.sub('[^a-z0-9_]+', '_', owner.lower())}.{nearest(last, CHANNELS_OF)}"
    return near if near in BY_NAME else ""


def channel_name(name: str, where: str) -> None:
    """SettingsError: no channel has this name."""
    if name not in NAMES and name not in BY_NAME:
        owner, _, last = name.rpartition(".")
        near = of_actuator(owner, last) if owner else nearest(name, NAMES)
        hint = f" Did you mean {near!r}?" if near else ""
        raise SettingsError(f"{where}: no channel is called {name!r}.{hint} docs/import.md lists them.")

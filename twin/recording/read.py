"""Files to voyages: an MCAP log, or a text file by the contract's column names or by a map.

What cannot be used is a DataError; what was blanked, assumed or derived stands in the voyage's `meta`.
"""

import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.live.signals.channels import BY_NAME
from twin.recording.frames import from_ddmm
from twin.recording.headers import own_names
from twin.recording.mapping import PLACES, Column, Key, Map, TimeColumn, target
from twin.recording.place import CHART, FRAMED, derive, placed, present, scaled
from twin.recording.samples import plausible, spikes
from twin.recording.table import Table, read_table
from twin.recording.timebase import (
    Clock,
    clock_from_numbers,
    clock_from_text,
    rebuilt,
    refuse_backwards,
    refuse_leaps,
)
from twin.recording.units import factor, froude
from twin.recording.voyage import Voyage

FEWEST_ROWS = 10
CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm")


@dataclass
class Raw:
    """A file's samples in border units, before anything is judged; `lines`: where each row stands in it."""

    path: Path
    lines: np.ndarray
    time_s: np.ndarray
    columns: dict[str, np.ndarray]
    meta: dict[str, Any]
    notes: list[str] = field(default_factory=list)
    rebuild: bool | float = False  # see TimeColumn
    lost: list[str] = field(default_factory=list)  # what of the file was damaged


def read_voyage(path: str | Path, by: Map | None = None) -> Voyage:
    """The voyage in an `.mcap` log or in a text file; `by` names a text file's own columns, units and signs.

    Positions come as north and east, velocities in the ship's axes, headings in [0, 360). Absent velocities,
    yaw rate or position are derived: `meta["derived"]` says how. `meta["notes"]` lists what was blanked or
    assumed, `meta["lost"]` what of the file was damaged.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError(
            f"{path}: {'is a folder' if path.is_dir() else 'there is no such file'}. Give a CSV or MCAP file."
        )
    if path.stat().st_size == 0:
        raise DataError(f"{path}: is empty (0 bytes). Export it again.")
    try:
        raw = from_log(path) if path.suffix.lower() == ".mcap" else from_text(path, by)
        return finished(raw)
    except MemoryError:
        raise DataError(f"{path}: does not fit into the memory. Cut it into shorter voyages.") from None


def from_log(path: Path) -> Raw:
    """The samples of an MCAP file: an imported voyage, the twin's own log, or one that Keelson recorded."""
    from twin.live.log.rows import read_rows

    notes, lost = list[str](), list[str]()
    time_s, columns = read_rows(path, notes, lost)
    clock = clock_from_numbers(path, time_s, TimeColumn())
    known = {name: x for name, x in columns.items() if name in BY_NAME}
    return Raw(
        path,
        np.arange(1, time_s.size + 1),
        clock.time_s,
        known,
        about(path, clock) | words(path),
        notes + list(clock.notes),
        lost=lost,
    )


def words(path: Path) -> dict[str, Any]:
    """What an imported voyage says about itself: where it came from, what in it is derived."""
    from twin.live.log.mcap_read import McapReader
    from twin.recording.write import ABOUT

    reader = McapReader(path)
    next(reader.messages(), None)
    return {key: json.loads(value) for key, value in reader.metadata.get(ABOUT, {}).items()}


def from_text(path: Path, by: Map | None) -> Raw:
    """The samples of a text file, through a map."""
    by, unused = (by, ()) if by else own_names(path)
    spec = by.time or TimeColumn()
    stamps: tuple[Key, ...] = spec.column if isinstance(spec.column, tuple) else (spec.column,)
    wanted = [c.column for c in by.columns.values()]
    optional = [c.column for c in by.columns.values() if c.optional]
    table = read_table(
        path,
        by.layout,
        [*({} if spec.is_text else stamps), *wanted],
        stamps if spec.is_text else (),
        optional,
    )
    clock = read_clock(path, table, stamps, spec)
    notes = [*table.notes, *unused, *clock.notes]
    columns, uses = dict[str, np.ndarray](), Counter(c.column for c in by.columns.values())
    for name, c in by.columns.items():
        if c.column in table.numbers:
            columns[name] = converted(name, table, c, by.name, notes)
        uses[c.column] -= 1
        if not uses[c.column]:  # no column is kept twice: a long voyage fills the memory
            table.numbers.pop(c.column, None)
    columns |= {name: np.full(table.lines.shape, x) for name, x in by.constant.items()}
    columns, facts, said = placed(clock.time_s, scaled(columns, by), by)
    slower = froude("time_s", by.froude_scale)
    step = spec.rebuild if isinstance(spec.rebuild, bool) else spec.rebuild * slower
    meta = about(path, clock) | {"map": by.name} | facts
    return Raw(path, table.lines, clock.time_s * slower, columns, meta, notes + said, step, list(table.lost))


def about(path: Path, clock: Clock) -> dict[str, Any]:
    return {"source": str(path), "start_time_utc": clock.start_time_utc}


def read_clock(path: Path, table: Table, stamps: tuple[Key, ...], spec: TimeColumn) -> Clock:
    if not spec.is_text:
        return clock_from_numbers(path, table.numbers[stamps[0]], spec)
    joint = " " if spec.format else "T"
    words = [joint.join(parts) for parts in zip(*(table.texts[s] for s in stamps), strict=True)]
    return clock_from_text(path, table.lines, words, spec)


def converted(name: str, table: Table, c: Column, where: str, notes: list[str]) -> np.ndarray:
    """One column with its sign, unit, offset and direction as the contract has them (not yet its frame)."""
    values = from_ddmm(table.numbers[c.column]) if c.unit == "ddmm" else table.numbers[c.column]
    scale = 1.0 if c.unit in (None, "ddmm") else factor(target(name, c), c.unit, where)
    values = values * (c.sign * scale) + c.offset + (180.0 if c.direction == "to" else 0.0)
    if c.despike and (at := spikes(values, BY_NAME[name].wraps)).size:
        notes.append(f"{name}: {at.size} spikes blanked (first in line {table.lines[at[0]]})")
        values[at] = np.nan
    return values


def finished(raw: Raw) -> Voyage:
    """The voyage: rows without a time left out, implausible samples blanked, what is absent derived."""
    with_time(raw)
    refuse_leaps(raw.path, raw.lines, raw.time_s)
    refuse_backwards(raw.path, raw.lines, raw.time_s)
    if raw.rebuild is not False:
        raw.time_s, how = rebuilt(raw.path, raw.time_s, raw.rebuild)
        raw.notes.append(how)
    for name, values in raw.columns.items():
        raw.columns[name], blanked = plausible(name, values, raw.lines)
        raw.notes += blanked
    require(raw)
    columns, derived = derive(raw.time_s, raw.columns)
    meta = {k: v for k, v in raw.meta.items() if v}
    meta["derived"] = meta.get("derived", {}) | derived
    meta["notes"] = (*meta.get("notes", ()), *raw.notes)
    meta["lost"] = (*meta.get("lost", ()), *raw.lost)
    return Voyage(meta.pop("name", raw.path.stem), raw.time_s, columns, meta)


def with_time(raw: Raw) -> None:
    """Leaves out the rows without a time; DataError when too few are left."""
    keep = np.isfinite(raw.time_s)
    rows = int(np.count_nonzero(keep))
    if rows < FEWEST_ROWS:
        raise DataError(
            f"{raw.path}: has {rows} rows with a time; at least {FEWEST_ROWS} are needed. Is it "
            "the right time column?"
        )
    if rows < keep.size:
        raw.notes.append(
            f"{keep.size - rows} rows without a time left out (first in line {raw.lines[~keep][0]})"
        )
        raw.time_s, raw.lines = raw.time_s[keep], raw.lines[keep]
        raw.columns = {name: x[keep] for name, x in raw.columns.items()}


def require(raw: Raw) -> None:
    """Heading, controls, and position or velocity must hold samples; DataError names all that do not."""
    needed = ("heading_true_north_deg", *CONTROLS)
    missing = [name for name in needed if not present(raw.columns, name)]
    if not present(raw.columns, *CHART) and not present(raw.columns, *FRAMED):
        missing.append(f"{' and '.join(CHART)} (or {' and '.join(PLACES)}, or {' and '.join(FRAMED)})")
    if missing:
        empty = [n for n in raw.columns if not present(raw.columns, n)]
        said = [f"{', '.join(empty)}: no usable sample"] * bool(empty) + raw.notes
        steady = " A shaft that kept one speed may stand under [constant]." * (CONTROLS[1] in missing)
        raise DataError(
            f"{raw.path}: needs {', '.join(missing)}. {'; '.join(said)}{'. ' if said else ''}Add the "
            f"column, or say in a map which one it is (--map).{steady}"
        )

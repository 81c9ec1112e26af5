"""Files to voyages: an MCAP log, or a text file by the contract's column names or by a map.

What cannot be used is a DataError; what was blanked, assumed or derived stands in the voyage's `meta`.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from twin.errors import DataError, did_you_mean
from twin.live.signals.channels import BY_NAME, of_actuators
from twin.recording.cells import converted, earlier, number_keys, optional_keys, sum_of, text_keys, there
from twin.recording.formats import Format, recognised
from twin.recording.formats.choose import Sources, chosen
from twin.recording.formats.rows import as_columns
from twin.recording.formats.tables import Packed
from twin.recording.formats.zipped import is_zip, unpacked
from twin.recording.headers import column_names, own_names
from twin.recording.map_file import parse_map
from twin.recording.mapping import PLACES, Column, Key, Map, TimeColumn
from twin.recording.place import CHART, FRAMED, derive, placed, present, scaled
from twin.recording.samples import plausible
from twin.recording.table import Table, read_packed, read_table
from twin.recording.timebase import (
    TimeAxis,
    clock_from_numbers,
    clock_from_text,
    rebuilt,
    refuse_backwards,
    refuse_leaps,
)
from twin.recording.units import froude
from twin.recording.voyage import Voyage

FEWEST_ROWS = 10
CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm")
NO_SOURCES: Sources = {}


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


def read_voyage(
    path: str | Path | Sequence[str | Path],
    by: Map | None = None,
    sources: Sources = NO_SOURCES,
    controls: bool = True,
) -> Voyage:
    """The voyage in a file of any known format (`formats`); `by` names a file's own columns, units and signs,
    `sources` which instrument is taken where several say the same. `controls` False: rudder and shaft need
    not be there.

    Positions come as north and east, velocities in the ship's axes, headings in [0, 360). Absent velocities,
    yaw rate or position are derived: `meta["derived"]` says how. `meta["notes"]` lists what was blanked or
    assumed, `meta["lost"]` what of the file was damaged.
    """
    if not isinstance(path, str | Path):
        if len(path) > 1:
            return read_several([Path(p) for p in path], by, controls)
        path = path[0]
    path = Path(path)
    if not path.exists():
        raise DataError(f"{path}: there is no such file. Give a table or a log.")
    if path.is_file() and path.stat().st_size == 0:
        raise DataError(f"{path}: is empty (0 bytes). Export it again.")
    try:
        return finished(raw_of(path, by, sources), controls)
    except MemoryError:
        raise DataError(f"{path}: does not fit into the memory. Cut it into shorter voyages.") from None


def read_several(paths: Sequence[Path], by: Map | None, controls: bool = True) -> Voyage:
    """The voyage in several tables, joined on their clocks."""
    from twin.recording.several import joined

    try:
        return finished(joined(paths, by), controls)
    except MemoryError:
        raise DataError(f"{paths[0]}: does not fit into the memory. Cut it into shorter voyages.") from None


def raw_of(path: Path, by: Map | None, sources: Sources) -> Raw:
    """The samples of a file in border units, by the reader of its format."""
    if is_zip(path):
        return of_zip(path, by, sources)
    kind = recognised(path)
    if kind is None and path.is_dir():
        from twin.recording.several import joined

        return joined([path], by)
    if kind is None:
        return from_log(path, by) if path.suffix.lower() == ".mcap" else from_text(path, by)
    return (
        from_series(path, kind, by, sources) if kind.series else from_text(path, by, opened_table(kind, path))
    )


def of_zip(path: Path, by: Map | None, sources: Sources) -> Raw:
    """What is packed in a .zip: one log or table, or several tables that are joined."""
    with TemporaryDirectory() as folder:
        files = unpacked(path, Path(folder))
        try:
            if len(files) == 1:
                return replace(raw_of(files[0], by, sources), path=path)
            from twin.recording.several import joined

            return replace(joined(files, by), path=path)
        except DataError as error:
            raise DataError(str(error).replace(folder, str(path))) from None


def opened_table(kind: Format, path: Path) -> Packed:
    assert kind.table is not None
    return kind.table(path, kind.says)


def from_log(path: Path, by: Map | None = None) -> Raw:
    """The samples of the twin's own MCAP: an imported voyage, or the log of a run; a map may replace channels
    of it."""
    from twin.live.log.rows import read_rows

    notes, lost = list[str](), list[str]()
    time_s, columns = read_rows(path, notes, lost)
    clock = clock_from_numbers(path, time_s, TimeColumn())
    known = {name: x for name, x in columns.items() if name in BY_NAME}
    lines, facts = np.arange(1, time_s.size + 1), words(path)
    if by is None:
        return Raw(
            path, lines, clock.time_s, known, about(path, clock) | facts, notes + list(clock.notes), lost=lost
        )
    own = {name: Column(name) for name in known if name not in by.columns and name not in by.constant}
    missing = [str(k) for k in number_keys(by.columns.values()) if k not in columns]
    if missing:
        raise DataError(
            f"{path}: this log of the twin holds no {missing[0]!r}.{did_you_mean(missing[0], columns)}"
        )
    table = Table(path, lines, dict(columns.items()), {}, lost=tuple(lost))
    return through(path, table, clock, replace(by, columns=own | dict(by.columns)), notes, facts)


def words(path: Path) -> dict[str, Any]:
    """What an imported voyage says about itself: where it came from, what in it is derived."""
    from twin.live.log.mcap_read import McapReader
    from twin.recording.write import ABOUT

    reader = McapReader(path)
    next(reader.messages(), None)
    return {key: json.loads(value) for key, value in reader.metadata.get(ABOUT, {}).items()}


def from_text(path: Path, by: Map | None, packed: Packed | None = None) -> Raw:
    """The samples of a table, text or packed, through a map."""
    by, unused = (by, ()) if by else own_names(path, packed.names if packed else column_names(path))
    table = table_of(path, by, packed)
    return through(
        path,
        table,
        read_clock(path, table, stamps_of(by), by.time or TimeColumn()),
        by,
        [*table.notes, *unused],
        {},
    )


def stamps_of(by: Map) -> tuple[Key, ...]:
    """The columns of a map's time."""
    column = (by.time or TimeColumn()).column
    return column if isinstance(column, tuple) else (column,)


def table_of(path: Path, by: Map, packed: Packed | None) -> Table:
    """The columns of a table that a map needs."""
    is_text, entries = (by.time or TimeColumn()).is_text, list(by.columns.values())
    words = list(dict.fromkeys([*(stamps_of(by) if is_text else ()), *text_keys(entries)]))
    numbers = list(dict.fromkeys([*(() if is_text else stamps_of(by)), *number_keys(entries)]))
    if packed:
        return read_packed(packed, numbers, words, optional_keys(entries))
    return read_table(path, by.layout, numbers, words, optional_keys(entries))


def from_series(path: Path, kind: Format, by: Map | None, sources: Sources) -> Raw:
    """The samples of a log of messages: by its own map, in which a person's map replaces what it names."""
    assert kind.series is not None
    signals = kind.series(path)
    choice = chosen(signals, sources)
    if not choice.columns and by is None:
        held = ", ".join(list(signals.series)[:12])
        raise DataError(
            f"{path}: this is {signals.says}, and nothing in it says what it is: {held} ... "
            "--suggest-map writes a map to begin with."
        )
    given = by or Map(name=f"what {path.name} says itself")
    by = replace(
        given,
        columns={
            **parse_map({"columns": beside_map(choice.columns, given)}, str(path)).columns,
            **given.columns,
        },
    )
    wanted = list(dict.fromkeys(number_keys(by.columns.values())))
    for name in wanted:
        if name not in signals.series:
            known = list(signals.series)
            raise DataError(
                f"{path}: this is {signals.says}, and it holds no "
                f"{name!r}.{did_you_mean(str(name), known)} It holds "
                f"{', '.join(known[:20])}."
            )
    time_s, columns = as_columns(signals, map(str, wanted))
    notes = [*signals.notes, *choice.notes]
    notes += [f"left out: {', '.join(f'{n} {what}' for what, n in signals.skipped.most_common(6))}"] * bool(
        signals.skipped
    )
    table = Table(path, np.arange(1, time_s.size + 1), dict(columns.items()), {})
    clock = clock_from_numbers(path, time_s, TimeColumn())
    return through(path, table, clock, by, notes, {"format": signals.says})


def beside_map(own: dict[str, Any], given: Map) -> dict[str, Any]:
    """The log's own columns, without those that a map gives: position and velocity go by whole pairs."""
    taken = set(given.columns) | set(given.constant)
    for pair in (FRAMED, PLACES, CHART):
        if taken & set(pair):
            taken |= {*pair, *((*PLACES, *CHART) if pair != FRAMED else ())}
    return {name: c for name, c in own.items() if name not in taken}


def through(
    path: Path, table: Table, clock: TimeAxis, by: Map, notes: list[str], facts: dict[str, Any]
) -> Raw:
    """A table through a map: every channel in its unit, then places and velocities in their frames."""
    columns = {
        name: converted(name, table, c, by.name, notes) for name, c in by.columns.items() if there(table, c)
    }
    for name, c in by.columns.items():
        if c.late_s and name in columns:
            ch = BY_NAME.get(name, BY_NAME["north_m"])
            columns[name] = earlier(clock.time_s, columns[name], c.late_s, ch.wraps, ch.stale_s)
    notes = [*notes, *clock.notes]
    columns |= {name: np.full(table.lines.shape, x) for name, x in by.constant.items()}
    given = sorted(columns)
    columns, known, said = placed(clock.time_s, scaled(columns, by), by)
    slower = froude("time_s", by.froude_scale)
    step = by.time.rebuild if by.time else False
    step = step if isinstance(step, bool) else step * slower
    frame = by.columns[FRAMED[0]].frame if FRAMED[0] in by.columns else ""
    meta = about(path, clock) | {
        "map": by.name,
        "given": given,
        "constant": sorted(by.constant),
        "velocity_frame": frame,
    }
    meta |= {"units": {name: c.unit for name, c in by.columns.items() if c.unit}} | facts | known
    return Raw(path, table.lines, clock.time_s * slower, columns, meta, notes + said, step, list(table.lost))


def about(path: Path, clock: TimeAxis) -> dict[str, Any]:
    return {"source": str(path), "start_time_utc": clock.start_time_utc}


def read_clock(path: Path, table: Table, stamps: tuple[Key, ...], spec: TimeColumn) -> TimeAxis:
    """The clock of a table: numbers (several are added up by `factors`), moments that a packed table keeps,
    or text."""
    if all(s in table.numbers for s in stamps):
        if spec.is_text:
            spec = TimeColumn(spec.column)
        return clock_from_numbers(path, sum_of([table.numbers[s] for s in stamps], spec.factors), spec)
    joint = " " if spec.format else "T"
    words = [joint.join(parts) for parts in zip(*(table.texts[s] for s in stamps), strict=True)]
    return clock_from_text(path, table.lines, words, spec)


def finished(raw: Raw, controls: bool = True) -> Voyage:
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
    require(raw, controls)
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
        kind = f"this is {raw.meta['format']}; it " if "format" in raw.meta else ""
        raise DataError(
            f"{raw.path}: {kind}has {rows} rows with a time; at least {FEWEST_ROWS} are needed. "
            "Is it the right time column?"
        )
    if rows < keep.size:
        raw.notes.append(
            f"{keep.size - rows} rows without a time left out (first in line {raw.lines[~keep][0]})"
        )
        raw.time_s, raw.lines = raw.time_s[keep], raw.lines[keep]
        raw.columns = {name: x[keep] for name, x in raw.columns.items()}


def require(raw: Raw, controls: bool = True) -> None:
    """Heading, controls, and position or velocity must hold samples; DataError names all that do not."""
    parts = any(present(raw.columns, name) for name in of_actuators(raw.columns))
    needed = ("heading_true_north_deg", *(CONTROLS if controls and not parts else ()))
    missing = [name for name in needed if not present(raw.columns, name)]
    if not present(raw.columns, *CHART) and not present(raw.columns, *FRAMED):
        missing.append(f"{' and '.join(CHART)} (or {' and '.join(PLACES)}, or {' and '.join(FRAMED)})")
    if missing:
        empty = [n for n in raw.columns if not present(raw.columns, n)]
        said = [f"{', '.join(empty)}: no usable sample"] * bool(empty) + [n[:200] for n in raw.notes[:8]]
        steady = " A shaft that kept one speed may stand under [constant]." * (CONTROLS[1] in missing)
        kind = f"this is {raw.meta['format']}; a voyage " if "format" in raw.meta else ""
        raise DataError(
            f"{raw.path}: {kind}needs {', '.join(missing)}. {'; '.join(said)}{'. ' if said else ''}Add the "
            f"column, or say in a map which one it is (--map).{steady}"
            + " What is judged without the controls is imported with "
            "--without-controls." * (set(missing) <= set(CONTROLS))
        )

"""The samples of a file of any known format, by its reader: a log of the twin, a table by the documented
names or by a map, a log of messages, and what is packed in a .zip.
"""

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from twin.errors import DataError, SettingsError, TwinError, did_you_mean
from twin.live.signals.channels import BY_NAME
from twin.recording.cells import number_keys
from twin.recording.formats import Format, recognised
from twin.recording.formats.binary_tables import Packed
from twin.recording.formats.choose import HEADING, MAGNETIC, SourceChoice, Sources, chosen, unused
from twin.recording.formats.series_table import as_columns
from twin.recording.formats.signals import Signals
from twin.recording.formats.zipped import is_zip, unpacked
from twin.recording.headers import column_names, names_by, overlaid, own_names
from twin.recording.long_table import widened
from twin.recording.map_file import parse_map
from twin.recording.mapping import PLACES, Column, Map, TimeColumn
from twin.recording.place import CHART, FRAMED
from twin.recording.raw import ABOUT, Raw, about, opened_table, read_clock, stamps_of, table_of, through
from twin.recording.several import joined
from twin.recording.table import Table
from twin.recording.timebase import (
    clock_from_numbers,
)


def raw_of(path: Path, by: Map | None, sources: Sources) -> Raw:
    """The samples of a file in border units, by the reader of its format. SettingsError: an instrument is to
    be chosen of a file that has one column for each quantity."""
    if is_zip(path):
        return of_zip(path, by, sources)
    kind = recognised(path)
    if sources and not (kind and kind.series):
        channel, name = next(iter(sources.items()))
        raise SettingsError(
            f"--source {channel}{'=' * bool(channel)}{name}: {path} has one column for each quantity and "
            "names no instruments. Choose the column by a map."
        )
    if kind is None and path.is_dir():
        return joined([path], by)
    if kind is None:
        return from_log(path, by) if path.suffix.lower() == ".mcap" else from_text(path, by)
    return (
        from_series(path, kind, by, sources) if kind.series else from_text(path, by, opened_table(kind, path))
    )


def of_zip(path: Path, by: Map | None, sources: Sources) -> Raw:
    """What is packed in a .zip: one log or table, or several tables that are joined. TwinError: what is
    packed cannot be read, or a setting does not fit it."""
    with TemporaryDirectory() as folder:
        files = unpacked(path, Path(folder))
        try:
            raw = raw_of(files[0], by, sources) if len(files) == 1 else joined(files, by)
        except TwinError as error:
            raise type(error)(str(error).replace(folder, str(path))) from None
        return replace(raw, path=path, meta=raw.meta | of_whole(path, Path(folder), raw.meta))


def of_whole(path: Path, folder: Path, meta: dict[str, Any]) -> dict[str, Any]:
    """Where samples come from that were unpacked into a folder: the .zip, and the names of its files. Nothing
    of a voyage that was imported from elsewhere before."""
    if not Path(meta["source"]).is_relative_to(folder):
        return {}
    files = [Path(file).relative_to(folder).as_posix() for file in meta.get("files", ())]
    return {"source": str(path)} | ({"files": files} if files else {})


def from_log(path: Path, by: Map | None = None) -> Raw:
    """The samples of the twin's own MCAP: an imported voyage, or the log of a run; a map may replace
    channels of it. DataError: it lacks a column of the map."""
    from twin.live.log.log_rows import read_rows

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

    reader = McapReader(path)
    next(reader.messages(), None)
    return {key: json.loads(value) for key, value in reader.metadata.get(ABOUT, {}).items()}


def from_text(path: Path, by: Map | None, packed: Packed | None = None) -> Raw:
    """The samples of a table, text or packed, by the documented names of its columns, and through a map
    where one is given."""
    if by is None:
        by, unused = own_names(path, packed.names if packed else column_names(path))
    elif not by.layout.long:
        by, unused = overlaid(by, packed.names if packed else names_by(path, by.layout)), ()
    else:
        unused = ()
    table = table_of(path, by, packed)
    clock = read_clock(path, table, stamps_of(by), by.time or TimeColumn())
    if by.layout.long:
        table, clock = widened(table, clock, by.layout.long, number_keys(by.columns.values()))
    return through(
        path,
        table,
        clock,
        by,
        [*table.notes, *unused],
        {},
    )


def from_series(path: Path, kind: Format, by: Map | None, sources: Sources) -> Raw:
    """The samples of a log of messages: by its own map, in which a person's map replaces what it names.
    DataError: nothing in it says what it is."""
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
    wanted = list(dict.fromkeys(map(str, number_keys(by.columns.values()))))
    for name in wanted:
        if name not in signals.series:
            known = list(signals.series)
            raise DataError(
                f"{path}: this is {signals.says}, and it holds no "
                f"{name!r}.{did_you_mean(name, known)} It holds "
                f"{', '.join(known[:20])}."
            )
    time_s, columns = as_columns(signals, wanted)
    notes = [*signals.notes, *of_own_map(signals, choice, by), *unused(signals, by.columns, wanted)]
    notes += [f"left out: {', '.join(f'{n} {what}' for what, n in signals.skipped.most_common(6))}"] * bool(
        signals.skipped
    )
    table = Table(path, np.arange(1, time_s.size + 1), dict(columns.items()), {})
    clock = clock_from_numbers(path, time_s, TimeColumn())
    return through(path, table, clock, by, notes, {"format": signals.says})


def of_own_map(signals: Signals, choice: SourceChoice, by: Map) -> list[str]:
    """What is to be said of the log's own choice, of those channels that a person's map left to it."""
    kept = set(map(str, number_keys(by.columns.values())))
    names = {c: e["column"] if isinstance(e, dict) else e for c, e in choice.columns.items()}
    lost = {c for c, name in names.items() if name not in kept}
    lost |= {signals.series[names[c]].quantity for c in lost}
    lost |= {MAGNETIC} if HEADING in lost else set()
    lost |= {s.quantity for s in signals.series.values() if s.name in kept - set(names.values())}
    return [note for note in choice.notes if note.partition(":")[0] not in lost]


def beside_map(own: dict[str, Any], given: Map) -> dict[str, Any]:
    """The log's own columns, without those that a map gives: position and velocity go by whole pairs."""
    taken = set(given.columns) | set(given.constant)
    for pair in (FRAMED, PLACES, CHART):
        if taken & set(pair):
            taken |= {*pair, *((*PLACES, *CHART) if pair != FRAMED else ())}
    return {name: c for name, c in own.items() if name not in taken}

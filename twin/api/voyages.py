"""Voyages from files."""

import glob
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from twin.api.result import PathLike
from twin.errors import DataError, UsageError
from twin.recording.import_voyage import accepted
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage as read
from twin.recording.voyage import Voyage


def read_voyage(
    path: PathLike, map: PathLike | None = None, *, controls: bool = True, accept: Sequence[str] = ()
) -> Voyage:
    """One voyage: an MCAP log, or a text file by the channels' names or by a `map` of its own columns.

    DataError (a line that says what, where and what to do) when the file cannot be used; SettingsError when
    the map is not valid. The format of a map: docs/import.md. `controls` False: rudder and shaft need
    not be there, as for `instruments`.

    Signs, units and frames are asked where the voyage is judged, as `twin import` asks them: `compare`,
    `diagnose`, `calibrate`, `add`, `tube` and `instruments` refuse one of which a mistake is proved
    (DataError; `check_voyage` says it at once). `accept`: names of checks that refuse it nowhere.
    """
    by = read_map(Path(map)) if map is not None else None
    return accepted(read(Path(path), by, controls=controls), accept)


def read_voyages(
    paths: PathLike | Iterable[PathLike], map: PathLike | None = None, *, accept: Sequence[str] = ()
) -> list[Voyage]:
    """Several voyages: paths, or one pattern such as "calm/*.mcap", in the order of their names; a file whose
    own name has such signs is itself. `accept` as for one.

    DataError when a pattern matches nothing or a file cannot be used.
    """
    if isinstance(paths, str | os.PathLike):
        name = os.fspath(paths)
        found = [name] if os.path.isfile(name) else sorted(glob.glob(name))
        if not found:
            raise DataError(f"{name}: no file has such a name. Check the folder and the pattern.")
        paths = found
    return [read_voyage(path, map, accept=accept) for path in paths]


def several(voyages: Voyage | Iterable[Voyage]) -> list[Voyage]:
    """One voyage or many, or none, as a list; UsageError for what is no voyage."""
    found = [voyages] if isinstance(voyages, Voyage | str | os.PathLike) else list(voyages)
    for one in found:
        if not isinstance(one, Voyage):
            raise UsageError(f"{one!r} is no voyage. Read the file first, with twin.read_voyage(...).")
    return found


def at_least_one(voyages: Voyage | Iterable[Voyage]) -> list[Voyage]:
    """The same, DataError where there is none."""
    found = several(voyages)
    if not found:
        raise DataError("no voyage was given. Name at least one.")
    return found

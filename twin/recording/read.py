"""Files to voyages: an MCAP log, or a text file by the column names of docs/import.md or by a map.

What cannot be used is a DataError; what was blanked, assumed or derived stands in the voyage's `meta`.
"""

from collections.abc import Sequence
from pathlib import Path

from twin.errors import DataError
from twin.recording.formats.choose import Sources
from twin.recording.mapping import Map
from twin.recording.samples_of import raw_of
from twin.recording.several import joined
from twin.recording.voyage import Voyage

NO_SOURCES: Sources = {}


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

    DataError: the file is not there, cannot be read, or lacks what a voyage needs."""
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
        return Voyage.of(raw_of(path, by, sources), controls)
    except MemoryError:
        raise DataError(f"{path}: does not fit into the memory. Cut it into shorter voyages.") from None


def read_several(paths: Sequence[Path], by: Map | None, controls: bool = True) -> Voyage:
    """The voyage in several tables, joined on their clocks. DataError: they do not fit into the memory."""
    try:
        return Voyage.of(joined(paths, by), controls)
    except MemoryError:
        raise DataError(f"{paths[0]}: does not fit into the memory. Cut it into shorter voyages.") from None

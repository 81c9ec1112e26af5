"""Which ships and which voyages: a TOML that lists them, or a folder with a folder for each ship.

The ships are read here, before any work is done; a voyage is only named, and a row says so when it cannot be
read.
"""

import glob
import hashlib
import os
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from twin.errors import DataError, SettingsError
from twin.physics.ship import Ship, load
from twin.recording.map_file import known, read_map

OF_A_SHIP = ("name", "file", "voyages", "map", "tags")
OF_VOYAGES = ("files", "map", "tags")
MAP = "map.toml"  # in a ship's folder: the map of its tables
# the last: arrays of a ship file
NO_VOYAGE = re.compile(r"^\.|\.(toml|md|html|png|pdf|onnx|py)$|\.[0-9a-f]{8}\.json$", re.I)


@dataclass(frozen=True)
class FleetVoyage:
    """A voyage's file, the map of its columns if it needs one, and what its owner noted."""

    path: Path
    map: Path | None = None
    tags: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class FleetShip:
    """A calibrated ship of the fleet; `sha256`: of its file, which names the hash of its arrays."""

    name: str
    file: Path
    sha256: str
    ship: Ship = field(repr=False)
    voyages: tuple[FleetVoyage, ...]


def read_fleet(path: str | os.PathLike[str]) -> list[FleetShip]:
    """The ships of a list or of a folder. SettingsError: the list is not valid, a name or a ship file stands
    twice, a ship was never calibrated. DataError: no voyage."""
    path = Path(path)
    ships = _of_folder(path) if path.is_dir() else _of_list(path)
    for what, names in (
        ("name", [s.name for s in ships]),
        ("ship file", [str(s.file.resolve()) for s in ships]),
    ):
        if twice := next((n for n in names if names.count(n) > 1), None):
            raise SettingsError(
                f"{path}: the {what} {twice} stands there twice. Give each ship once, with a name of its own."
            )
    return ships


def sha256_of(path: Path | None) -> str | None:
    """Of a file's bytes; None where it cannot be read."""
    try:
        with open(path or "", "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return None


def _of_list(path: Path) -> list[FleetShip]:
    try:
        table = known(tomllib.loads(path.read_text(encoding="utf-8")), ("ships",), str(path))
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read ({error.strerror}). Give a list or a folder.") from None
    except ValueError as error:
        raise SettingsError(f"{path}: is not valid TOML: {error}.") from None
    entries = table.get("ships")
    if not isinstance(entries, list) or not entries:
        raise SettingsError(f"{path}: lists no ship. Begin each with a line [[ships]]; see docs/fleet.md.")
    return [_listed(entry, path, f"{path}: ship {i}") for i, entry in enumerate(entries, 1)]


def _listed(entry: Any, path: Path, where: str) -> FleetShip:
    """One [[ships]] of a list; paths are meant from the list's folder."""
    entry = known(entry, OF_A_SHIP, where)
    for key in ("file", "voyages"):
        if not entry.get(key):
            raise SettingsError(f"{where}: needs {key} = ... Add it; see docs/fleet.md.")
    voyages = entry["voyages"] if isinstance(entry["voyages"], list) else [entry["voyages"]]
    asked = []
    for v in voyages:
        one = known(v if isinstance(v, Mapping) else {"files": v}, OF_VOYAGES, f"{where}: voyages")
        for pattern in _texts(one.get("files"), f"{where}: voyages: files"):
            mapped = one.get("map", entry.get("map"))
            tags = {**_tags(entry, where), **_tags(one, where)}
            asked += [
                FleetVoyage(p, _map(path.parent, mapped), tags) for p in _found(path.parent, pattern, where)
            ]
    return _made(str(entry.get("name", "")), path.parent / str(entry["file"]), asked, where)


def _of_folder(folder: Path) -> list[FleetShip]:
    inner = [p for p in sorted(folder.iterdir()) if p.is_dir() and any(p.glob("*.toml"))]
    if not inner:
        raise SettingsError(
            f"{folder}: no folder in it holds a ship file. Make one for each ship, with its ship file and "
            "its voyages, or give a list; see docs/fleet.md."
        )
    return [_in_folder(p) for p in inner]


def _in_folder(folder: Path) -> FleetShip:
    files = [p for p in sorted(folder.glob("*.toml")) if p.name != MAP and _of_a_ship(p)]
    if len(files) != 1:
        raise SettingsError(
            f"{folder}: holds {len(files)} ship files ({', '.join(p.name for p in files) or 'none'}). Leave "
            f"one; the map of its tables is called {MAP}."
        )
    by = folder / MAP if (folder / MAP).exists() else None
    voyages = [p for p in sorted(folder.iterdir()) if p.is_file() and not NO_VOYAGE.search(p.name)]
    return _made(folder.name, files[0], [FleetVoyage(p, by) for p in voyages], str(folder))


def _of_a_ship(path: Path) -> bool:
    """Whether a TOML is a ship file, and no map or setting; of one that is not valid its reader says why."""
    try:
        return "particulars" in tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return True


def _made(name: str, file: Path, voyages: Sequence[FleetVoyage], where: str) -> FleetShip:
    ship = load(file)
    if "structural" not in ship.notes:
        raise SettingsError(
            f"{file}: was never calibrated, so nothing can be called wrong on its voyages. "
            f"twin calibrate REFERENCE... --ship {file} -o CALIBRATED.toml"
        )
    if not voyages:
        raise DataError(f"{where}: no voyage of {name or ship.name}. Put some there, or correct the pattern.")
    for by in {v.map for v in voyages if v.map}:
        read_map(by)
    once = {os.path.abspath(v.path): v for v in voyages}  # a file that two patterns name
    return FleetShip(name or ship.name, file, sha256_of(file) or "", ship, tuple(once.values()))


def _found(folder: Path, pattern: str, where: str) -> list[Path]:
    """Files of a pattern in the order of their names; a plain name stands for itself, there or not."""
    found = sorted(glob.glob(os.fspath(folder / pattern), recursive=True))
    if not found and glob.has_magic(pattern):
        raise DataError(f"{where}: voyages: no file is like {pattern!r}. Check the folder and the pattern.")
    return [Path(p) for p in found] or [folder / pattern]


def _texts(value: Any, where: str) -> list[str]:
    texts = value if isinstance(value, list) else [value]
    if not texts or not all(isinstance(t, str) and t for t in texts):
        raise SettingsError(f"{where} = {value!r} must be a file, a pattern, or a list of them.")
    return texts


def _tags(entry: Mapping[str, Any], where: str) -> dict[str, str]:
    tags = entry.get("tags", {})
    if not isinstance(tags, Mapping):
        raise SettingsError(f"{where}: tags = {tags!r} must be a table of names and words.")
    return {str(k): str(v) for k, v in tags.items()}


def _map(folder: Path, name: Any) -> Path | None:
    return folder / str(name) if name else None

"""The long arrays of a ship file (covariances that calibration found), in a file of their own beside it.

What a person reads and edits stays in the TOML. A list or table of many entries moves to NAME.HASH.json in
the same folder; the TOML names that file and its SHA-256 under [arrays], so that neither can be changed or
lost without a word. A ship file of an earlier version has its arrays in itself; it is read as it is, and a
line of the log says so."""

import json
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from twin import whole
from twin.checksum import sha256_hex
from twin.errors import SettingsError

from .ship_pair import MAX_BYTES

SECTION = "arrays"
LONG = 24  # entries from which a list or table is no reading for a person


def divided(table: Mapping[str, Any], people: Sequence[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """(table without its long arrays, {"section.key": array}) of a ship file's content; the sections for
    `people` stay as they are."""
    short: dict[str, Any] = {}
    arrays: dict[str, Any] = {}
    for section, entries in table.items():
        if section in people or not isinstance(entries, Mapping):
            short[section] = entries
            continue
        long = {key for key, value in entries.items() if _count(value) >= LONG}
        arrays |= {f"{section}.{key}": entries[key] for key in sorted(long)}
        short[section] = {key: value for key, value in entries.items() if key not in long}
    return short, arrays


def write(path: Path, arrays: Mapping[str, Any]) -> dict[str, str]:
    """Writes the arrays of the ship file `path` beside it; what the ship file says of them: the file's name
    and hash."""
    data = json.dumps(arrays, separators=(",", ":"), allow_nan=False)
    digest = sha256_hex(data.encode())
    name = f"{path.stem}.{digest[:8]}.json"
    whole.write(path.with_name(name), data)
    return {"file": name, "sha256": digest}


def joined(table: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """The content of the ship file `path` with its arrays; SettingsError where the file of them is not there
    or is not the one that belongs to it."""
    told = table.get(SECTION)
    if told is None:
        return dict(table)
    beside = path.with_name(_name(told, path))
    try:
        data = whole.read(beside, MAX_BYTES)
    except OSError as error:
        raise SettingsError(
            f"{path}: its calibration's arrays are in {beside.name}, which cannot be read beside it "
            f"({error.strerror}). Copy both files, or calibrate again."
        ) from None
    if sha256_hex(data) != told.get("sha256"):
        raise SettingsError(
            f"{beside}: not the file that {path.name} was written with (its SHA-256 differs). Copy both "
            "files again, or calibrate again."
        )
    whole_table = {k: dict(v) if isinstance(v, Mapping) else v for k, v in table.items() if k != SECTION}
    for where, array in json.loads(data).items():
        section, _, key = where.partition(".")
        whole_table.setdefault(section, {})[key] = array
    return whole_table


def arrays_file(path: Path) -> str:
    """The name of the file that holds the arrays of the ship file `path`; "" where it has none."""
    told = tomllib.loads(path.read_text(encoding="utf-8")).get(SECTION)
    return "" if told is None else _name(told, path)


def said_of_old(table: Mapping[str, Any], people: Sequence[str], path: Path) -> None:
    """A warning in the log `twin` where a ship file holds its arrays itself, as earlier versions wrote it."""
    if SECTION in table or not divided(table, people)[1]:
        return
    import logging  # of the study: nothing on board reads these arrays

    logging.getLogger("twin").warning(
        "%s: a ship file of an earlier version, with its arrays in its own lines. It is read as it is; what "
        "`twin calibrate` or `twin add` writes has them in a file beside it.",
        path,
    )


def _name(told: Any, path: Path) -> str:
    name = told.get("file") if isinstance(told, Mapping) else None
    if not isinstance(name, str) or Path(name).name != name or not name:
        raise SettingsError(
            f"{path}: [{SECTION}] names no file beside it: file = {name!r}. Copy the file again."
        )
    return name


def _count(value: Any) -> int:
    """How many numbers and words stand in lists and tables within one another."""
    items = list(value.values()) if isinstance(value, Mapping) else value
    if not isinstance(items, (list, tuple)):
        return 1
    count = 0
    for item in items:
        count += _count(item)
    return count

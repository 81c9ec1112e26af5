"""A file looked at before it is imported: format, map, every channel, and what the checks say of it."""

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from twin import whole
from twin.errors import TwinError
from twin.physics.ship import Ship, load
from twin.recording.checks import run_checks
from twin.recording.columns_seen import columns_seen
from twin.recording.formats import recognised
from twin.recording.formats.choose import sources_of
from twin.recording.map_file import parse_map
from twin.recording.mapping import NAMES, Map
from twin.recording.read import read_voyage
from twin.recording.suggest_map import suggestion
from twin.recording.units import UNITS, unit_of
from twin.recording.voyage import Voyage
from twin.studio.project import text_of
from twin.studio.remedies import channels_of, remedies_of

MOST_CHOICES = 60  # columns that are offered
MOST_SAMPLES = 200_000  # of a channel that a page is given; of longer ones every so-manieth


def looked(folder: Path, file: str, map_name: str | None, ship: str | None, job: Path) -> dict[str, Any]:
    """Everything that Data shows of a file; the samples go to `series.f32` of the job."""
    path = folder / file
    told: dict[str, Any] = {"file": file, "map": map_name, "problem": None, "checks": [], "columns": []}
    voyage = None
    try:
        kind = recognised(path)
        told["format"] = kind.says if kind else "MCAP" if path.suffix == ".mcap" else "a text table"
        text = _map_text(path, folder / map_name if map_name else None)
        told["map_text"] = text
        table = parse_map(tomllib.loads(text), map_name or "the proposed map") if text else None
        told["entries"] = _entries(table)
        told |= _choices(path, table) if table else {}
        voyage = read_voyage(path, table)
    except (TwinError, tomllib.TOMLDecodeError) as error:
        told["problem"] = str(error).replace(f"{folder}/", "")
    if voyage is not None:
        known, said = _ship(folder, ship)
        told |= _of_voyage(voyage, known, job)
        told["notes"] = [*said, *told["notes"]]
    return told


def _ship(folder: Path, name: str | None) -> tuple[Ship | None, list[str]]:
    """The ship that lets the checks say more; one that cannot be read is left out, and it is said."""
    try:
        return (load(folder / name) if name else None), []
    except TwinError as error:
        return None, [f"{error} The checks are made without the ship.".replace(f"{folder}/", "")]


def _map_text(path: Path, map_file: Path | None) -> str:
    """The map's own text; the proposed one where there is none; "" for a log that needs none."""
    if map_file is not None:
        return text_of(map_file)
    if path.suffix.lower() == ".mcap":
        return ""
    return suggestion([path], sources_of([]))


def _entries(table: Map | None) -> list[dict[str, Any]]:
    """The map as rows of a table: which column fills which channel, and how."""
    if table is None:
        return []
    return [
        {
            "channel": channel,
            "column": ", ".join(map(str, c.parts)),
            "unit": c.unit,
            "sign": c.sign,
            "offset": c.offset,
            "frame": c.frame if c.frame != "body" else None,
        }
        for channel, c in table.columns.items()
    ]


def _choices(path: Path, table: Map) -> dict[str, Any]:
    """The columns that no channel takes, with their values, and what a column may be: channel -> units."""
    used = {part for c in table.columns.values() for part in (*c.parts, c.hemisphere)}
    time = table.time.column if table.time else None
    used |= {*(time if isinstance(time, tuple) else (time,))}
    kind = recognised(path)
    if kind is not None and kind.series is not None:
        return {}
    seen = columns_seen(path)
    free = [name for name in seen.names if name not in used and seen.has_numbers(name)]
    return {
        "unused": [{"column": name} | _range(seen.numbers(name)) for name in free[:MOST_CHOICES]],
        "channels": {name: list(UNITS.get(unit_of(name), {})) for name in NAMES},
    }


def _range(x: np.ndarray) -> dict[str, float]:
    """Least and greatest of what is a number."""
    there = x[np.isfinite(x)]
    return (
        {"low": float(there.min()), "high": float(there.max())} if there.size else {"low": 0.0, "high": 0.0}
    )


def _of_voyage(voyage: Voyage, ship: Ship | None, job: Path) -> dict[str, Any]:
    names = [name for name in voyage.columns if voyage.has(name)]
    checks = run_checks(voyage, ship)
    every = max(1, -(-len(voyage) // MOST_SAMPLES))
    series = np.stack(
        [(voyage.time_s - voyage.time_s[0])[::every], *(voyage.columns[n][::every] for n in names)]
    )
    whole_bytes(job / "series.f32", np.ascontiguousarray(series, dtype="<f4").tobytes())
    return {
        "voyage": voyage.name,
        "rows": len(voyage),
        "duration_s": voyage.duration_s,
        "step_s": voyage.step_s,
        "samples": int(series.shape[1]),
        "every": every,
        "columns": [_column(voyage, name) for name in names],
        "absent": list(voyage.absent()),
        "notes": [str(n) for n in voyage.meta.get("notes", ())],
        "checks": [_check(c, names) for c in checks],
        "refused": [c.name for c in checks if c.unusable],
    }


def _column(voyage: Voyage, name: str) -> dict[str, Any]:
    x = voyage.columns[name]
    return {
        "name": name,
        "low": float(np.nanmin(x)),
        "high": float(np.nanmax(x)),
        "there": float(np.isfinite(x).mean()),
        "derived": voyage.meta.get("derived", {}).get(name),
    }


def _check(check: Any, names: list[str]) -> dict[str, Any]:
    return check.as_json() | {"channels": channels_of(check, names), "remedies": remedies_of(check, names)}


def whole_bytes(path: Path, data: bytes) -> None:
    """Written aside and renamed."""
    aside = path.with_name(f".{path.name}")
    aside.write_bytes(data)
    aside.replace(path)


def write_result(job: Path, name: str, result: Any) -> None:
    """A JSON file of a job, whole or not at all, in the words of `--json`."""
    whole.write(job / name, json.dumps(result, indent=2, allow_nan=False) + "\n")

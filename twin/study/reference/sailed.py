"""The voyages a verb works on: read, put on the ship's grid, and with the effects that their recordings can
feed."""

import hashlib
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from twin.errors import DataError
from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.progress import Progress, silent
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.study.reference.derivatives import with_one_step_core
from twin.study.reference.seaway import swung
from twin.study.track.track import Track, track


@dataclass(frozen=True)
class Sailed:
    """One voyage file, its track, and the hash that provenance keeps of it."""

    voyage: Voyage
    track: Track
    sha256: str

    def provenance(self) -> dict[str, Any]:
        """What a ship file notes of a voyage: its name, the hash of its samples, its start."""
        start = self.voyage.meta.get("start_time_utc")
        return {"name": self.track.name, "sha256": self.sha256} | (
            {"start_time_utc": str(start)} if start else {}
        )


def sailed(voyage: Voyage, ship: Ship, sha256: str = "") -> Sailed:
    """A voyage on the ship's grid; `sha256`: of its file, else of its samples."""
    about = Model.of(with_one_step_core(ship))  # as its filter reads a voyage
    return Sailed(voyage, swung(track(voyage, ship), about), sha256 or samples_hash(voyage))


def samples_hash(voyage: Voyage) -> str:
    """SHA-256 of a voyage's samples, that tells it from every other."""
    known = hashlib.sha256(voyage.time_s.tobytes())
    for name in sorted(voyage.columns):
        known.update(name.encode())
        known.update(voyage.columns[name].tobytes())
    return known.hexdigest()


def own_references(ship: Ship, voyages: Sequence[Voyage], files: Sequence[str] = ()) -> list[str]:
    """Names of the voyages that the ship was calibrated on. Its file has the hash of their files, or of their
    samples where Python calibrated it; `files`: where the voyages were read from, if they were."""
    known = {str(v.get("sha256")) for v in ship.notes.get("structural", {}).get("voyages", [])}
    hashes = [_sha256(path) for path in files] or [""] * len(voyages)
    return [v.name for v, of in zip(voyages, hashes, strict=True) if {of, samples_hash(v)} & known]


def read_all(paths: Sequence[str], ship: Ship, progress: Progress = silent) -> list[Sailed]:
    """Every voyage, ready; DataError names the file that cannot be used, or that was given twice. `progress`
    is told which file is read."""
    out: list[Sailed] = []
    for path in paths:
        progress(f"reading {path}")
        out.append(sailed(read_voyage(path), ship, _sha256(path)))
    refuse_twice(zip(paths, (s.sha256 for s in out), strict=True))
    return out


def refuse_twice(given: Iterable[tuple[str, str]]) -> None:
    """DataError where a voyage (what it is called, its hash) was given twice: it would count as twice as much
    evidence, and judge a fit by what was fitted."""
    known: dict[str, str] = {}
    for name, of in given:
        if of in known:
            raise DataError(f"{name}: is the same voyage as {known[of]}. Give each voyage once.")
        known[of] = name


def _sha256(path: str) -> str:
    """Of a file; nothing of a folder, whose voyage is known by its samples."""
    if os.path.isdir(path):
        return ""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def fed(model: Model, t: Track) -> tuple[Model, tuple[Effect, ...]]:
    """The model without the effects whose inputs this track lacks, and those effects."""
    return model.without_inputs(t.missing())


def switched_off(model: Model, tracks: Sequence[Track]) -> list[dict[str, Any]]:
    """Which effects of the model are switched off on which voyages, and for want of what."""
    out = []
    for t in tracks:
        for effect in fed(model, t)[1]:
            lacks = sorted(t.missing().intersection(effect.needs))
            out.append({"effect": type(effect).__name__, "voyage": t.name, "not_measured": lacks})
    return out

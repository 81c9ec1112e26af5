"""One voyage of one ship, asked: how wrong the model is on it, and what is missing. It runs in a process of
its own, on this computer or another, and answers in rows of plain types."""

import json
import os
import time
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import twin
from twin.errors import TwinError
from twin.study.fleet.listing import FleetShip, FleetVoyage, sha256_of

Row = dict[str, Any]
Key = tuple[Any, ...]
CHANGED = "changed while the fleet was asked, or is another file for this worker. Ask again."
OF_DIAGNOSIS = ("verdict", "reason", "sentence", "more", "one_of", "p_value", "p_value_at_best")
OF_CAUSE = ("belongs_to", "probability", "posterior", "parameters", "cannot_be_told_from", "says")
AS_JSON = ("facts", "rivals", "weather", "moments", "next_manoeuvre")  # too various for columns


@dataclass(frozen=True)
class Job:
    """A question: a ship and one of its voyages, by their files and hashes, and the version that is asked."""

    ship: str
    ship_file: str
    ship_sha256: str
    voyage_file: str
    voyage_sha256: str | None
    map_file: str | None
    map_sha256: str | None
    version: str


def key_of(asked: Mapping[str, Any]) -> Key:
    """What an answer holds for: another ship file, voyage, map or version is another question. Of a voyage
    that cannot be opened only its path is known."""
    file = None if asked["voyage_sha256"] else asked["voyage_file"]
    return (asked["ship_sha256"], asked["voyage_sha256"], asked["map_sha256"], asked["version"], file)


def job_of(ship: FleetShip, voyage: FleetVoyage) -> Job:
    """The question of one voyage, with paths that another process finds from wherever it works."""
    of_map = os.path.abspath(voyage.map) if voyage.map else None
    return Job(
        ship.name, os.path.abspath(ship.file), ship.sha256, os.path.abspath(voyage.path),
        sha256_of(voyage.path), of_map, sha256_of(voyage.map), twin.__version__,
    )  # fmt: skip


def ask(job: Job) -> list[Row]:
    """Rows of one voyage: one a cause that is likely, named ones first, or one without a cause; what cannot
    be asked is a row that says why."""
    began = time.process_time()
    try:
        about, causes = _answered(job)
    except TwinError as error:
        return [failed(job, " ".join(str(error).split()), type(error).__name__)]
    about |= {"seconds": time.process_time() - began, "failed": None, "failed_as": None}
    return [about | cause for cause in causes or [{"effect": None, "named": False}]]


def failed(job: Job, why: str, kind: str) -> Row:
    """The row of a voyage that could not be asked. `kind`: DataError and SettingsError hold until a file
    changes; anything else is asked again by the next run."""
    return _about(job) | {"voyage": Path(job.voyage_file).stem, "failed": why, "failed_as": kind}


def _about(job: Job) -> Row:
    now = datetime.now(UTC).isoformat(timespec="seconds")
    return {**vars(job), "asked_utc": now, "effect": None, "named": False}


def _answered(job: Job) -> tuple[Row, list[Row]]:
    from twin.physics.model import Model
    from twin.physics.ship import load
    from twin.recording.map_file import read_map
    from twin.recording.read import read_voyage
    from twin.study.diagnosis.effect_diagnosis import diagnose
    from twin.study.prediction.open_loop_comparison import compare
    from twin.study.reference.sailed import own_references, sailed

    if job.version != twin.__version__:
        raise TwinError(f"this worker has shiptwin {twin.__version__}, not {job.version}. Install the same.")
    voyage = read_voyage(job.voyage_file, read_map(Path(job.map_file)) if job.map_file else None)
    ship = load(job.ship_file)
    for file, known in (
        (job.ship_file, job.ship_sha256),
        (job.voyage_file, job.voyage_sha256),
        (job.map_file, job.map_sha256),
    ):
        if file and known and sha256_of(Path(file)) != known:
            raise TwinError(f"{file}: {CHANGED}")
    about = _about(job) | {
        "voyage": voyage.name,
        "start_time_utc": voyage.meta.get("start_time_utc"),
        "duration_s": voyage.duration_s,
    }
    if own_references(ship, [voyage], [job.voyage_file]):
        return about | {"verdict": "reference", "sentence": "The ship was calibrated on it."}, []
    compared = compare([sailed(voyage, ship)], Model.of(ship)).result
    found = diagnose([voyage], ship).result
    return about | _of_voyage(compared, found), [_cause(c, found) for c in found["candidates"]]


def _of_voyage(compared: Mapping[str, Any], found: Mapping[str, Any]) -> Row:
    """What holds for the whole voyage."""
    last = compared["horizons"][-1]
    return {
        **{k: found[k] for k in OF_DIAGNOSIS},
        "references": found["p_value_references"],
        "score": found["p_value_score"],
        "compare_verdict": compared["verdict"],
        "horizon_s": last["horizon_s"],
        "position_mae_m": last["position_mae_m"],
        "position_expected_m": last["noise_floor"]["position_mae_m"],
        "heading_mae_deg": last["heading_mae_deg"],
        "heading_expected_deg": last["noise_floor"]["heading_mae_deg"],
        "data_checks": [c["text"] for c in found["data_checks"] if not c["ok"]],
        **{k: json.dumps(found[k]) for k in AS_JSON},
    }


def _cause(c: Mapping[str, Any], found: Mapping[str, Any]) -> Row:
    """One likely cause: its numbers, and how much nearer the model comes with it."""
    return {
        "effect": c["effect"],
        "named": c["effect"] in found["missing"],
        "lasting": c["effect"] in found["answer"]["lasting"],
        **{k: c[k] for k in OF_CAUSE},
        **c["typical_force"],
        "error_horizon_s": c["error_horizon_s"],
        "error_without_m": c["error_without"],
        "error_with_m": c["error_with"],
        "error_expected_m": c["error_floor"],
    }

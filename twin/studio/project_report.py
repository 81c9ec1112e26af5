"""One page of a project as it stands: ship, voyages, error before and now, diagnosis, history.

Nothing is computed for it: it holds what the work done in the folder has found, each answer with its command.
"""

import os
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

from twin import __version__, whole
from twin.errors import SettingsError, TwinError
from twin.num import as_given, num
from twin.physics.ship import load
from twin.recording.jsonable import plain
from twin.report.page import html
from twin.studio.jobs import END, JOB, Jobs, read
from twin.studio.project import Project
from twin.studio.trials import described
from twin.studio.verbs import files_of

SCRIPTS = ("number.js", "dom.js", "sections.js", "diagnosis.js", "project.js")
OVER = ("done", "refused")  # states of a job that has an answer
LATER_S = 1.0  # a file changed so long after an answer is another than the one it was about


class JobAnswer(NamedTuple):
    """What a job has found, of what, and when it ended [s, UTC]."""

    name: str
    asked: Mapping[str, Any]
    command: str
    result: Mapping[str, Any]
    ended_s: float


def write(folder: str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """The page of the project in `folder`, written to `path`, aside and renamed; UsageError: no such folder,
    SettingsError: a ship file of it is not valid."""
    whole.write(path, page(Project(folder)), "--report")


def page(project: Project) -> str:
    """The page as one self-contained HTML file."""
    return html(content(project), SCRIPTS)


def content(project: Project) -> dict[str, Any]:
    """Everything that the page shows, as JSON."""
    files, all_found = project.listing(), answers(project)
    ships = sorted((f for f in files if f["kind"] == "ship"), key=lambda f: f["changed_s"])
    file = ships[-1]["name"] if ships else ""
    ship = described(load(project.existing(file))) if file else {}
    now = _now(all_found, file)
    diagnosis = newest(all_found, "diagnose", lambda a: "sentence" in a.result)
    calibration = newest(all_found, "calibrate", lambda a: bool(a.result.get("held_out")))
    result = dict(diagnosis.result) if diagnosis else {}
    result |= {"horizons": [], "where": [], "history": ship.get("history", []), "ship": ship.get("ship", "")}
    if now:
        result |= {key: now.result.get(key) or [] for key in ("horizons", "where")}
        result["unexplained_force"] = now.result.get("unexplained_force", {})
    added = _added(result, ship)
    if added:  # what is in the model is not asked for again
        result |= {"missing": [], "answer": {}}
    name = ship.get("ship") or project.folder.name
    return plain(
        {
            "kind": "project",
            "title": f"{name}: the project {project.folder.name}",
            "verdict": _sentence(now, name),
            "result": result,
            "voyages": [],
            "made_s": round(time.time()),
            "version": __version__,
            "files": files,
            "file": file,
            "began": _began(all_found),
            "added": added,
            "about": ship,
            "now": _said(project, now),
            "diagnosed": _said(project, diagnosis),
            "calibrated": _said(project, calibration),
            "held_out": calibration.result["held_out"] if calibration else [],
            "comparisons": [row for a in all_found if (row := _compared(project, a))],
        }
    )


def answers(project: Project) -> list[JobAnswer]:
    """What the work done here has found, the oldest first; an answer whose files are damaged is left out."""
    jobs, out = Jobs(project), []
    for name in jobs.names():
        with suppress(SettingsError):  # a job that was forgotten since
            note, end, result = (read(jobs.at(name) / f) for f in (JOB, END, "result.json"))
            if note and end and result and jobs.state(name) in OVER:
                asked, command = note.get("asked", {}), str(note.get("command", ""))
                out.append(JobAnswer(name, asked, command, result, float(end.get("ended_s", 0.0))))
    return out


def newest(found: list[JobAnswer], verb: str, good: Callable[[JobAnswer], bool]) -> JobAnswer | None:
    """The last answer of a verb that is good for the page."""
    return next((a for a in reversed(found) if a.asked.get("verb") == verb and good(a)), None)


def _now(found: list[JobAnswer], file: str) -> JobAnswer | None:
    """What tells the error of today's ship: the proof of what was added to it, else its newest comparison,
    else the newest comparison of any ship."""
    return (
        newest(found, "add", lambda a: bool(file) and a.result.get("output") == file)
        or newest(found, "compare", lambda a: a.asked.get("ship") == file)
        or newest(found, "compare", lambda a: True)
    )


def _sentence(now: JobAnswer | None, ship: str) -> str:
    if now is None or not now.result.get("horizons"):
        return f"{ship}: nothing was compared with measurements yet"
    last = now.result["horizons"][-1]
    if "before" not in last:
        return str(now.result.get("verdict", ""))
    before, after, expected = (last[k]["position_mae_m"] for k in ("before", "after", "noise_floor"))
    return (
        f"{as_given(last['horizon_s'])} s ahead the error was {num(before, 3)} m and is {num(after, 3)} m "
        f"now, where {num(expected, 2)} m is expected: {' and '.join(now.asked['effects'])} was added"
    )


def _said(project: Project, answer: JobAnswer | None) -> dict[str, Any] | None:
    """Of what an answer is, its command, its sentence, and which of its files are others since."""
    if answer is None:
        return None
    result = answer.result
    return {
        "job": answer.name,
        "ended_s": answer.ended_s,
        "ship": answer.asked.get("ship"),
        "voyages": answer.asked.get("voyages", []),
        "judged": answer.asked.get("held_outs") or answer.asked.get("voyages", []),
        "command": answer.command,
        "sentence": result.get("sentence") or result.get("verdict") or "",
        "changed": [n for n in files_of(answer.asked) if _changed_s(project, n) > answer.ended_s + LATER_S],
    }


def _changed_s(project: Project, name: str) -> float:
    """When a file was last written; infinitely late for one that is gone."""
    try:
        return project.existing(name).stat().st_mtime
    except TwinError:
        return float("inf")


def _compared(project: Project, answer: JobAnswer) -> dict[str, Any] | None:
    """A row of the table of comparisons: the errors at the longest horizon."""
    if answer.asked.get("verb") != "compare" or not answer.result.get("horizons"):
        return None
    last = answer.result["horizons"][-1]
    row = {key: last.get(key) for key in ("horizon_s", "position_mae_m", "heading_mae_deg")}
    expected = (last.get("noise_floor") or {}).get("position_mae_m")
    return (_said(project, answer) or {}) | row | {"expected_m": expected}


def _added(diagnosis: Mapping[str, Any], ship: Mapping[str, Any]) -> list[str]:
    """What the diagnosis named, where all of it is in today's ship file."""
    missing = list(diagnosis.get("missing") or [])
    there = {effect["name"] for effect in ship.get("effects", [])}
    return missing if there.issuperset(missing) else []


def _began(found: list[JobAnswer]) -> dict[str, str]:
    """When each voyage began, as far as an answer has told it."""
    told = [v for a in found for key in ("voyages", "held_out") for v in a.result.get(key) or []]
    return {v["name"]: v["start_time_utc"] for v in told if isinstance(v, dict) and v.get("start_time_utc")}

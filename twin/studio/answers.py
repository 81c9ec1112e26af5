"""What a worker does for each verb: the Python interface's function, its JSON, and what the pages draw."""

import difflib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from twin import whole
from twin.api import calibration, comparison
from twin.errors import DataError
from twin.physics.effects import find_for
from twin.physics.model import Model
from twin.physics.ship import load
from twin.recording.checks.proved_wrong import refusal
from twin.recording.import_voyage import import_voyage
from twin.recording.jsonable import plain
from twin.recording.progress import Progress
from twin.recording.read import read_voyage
from twin.recording.ship_file_writer import save
from twin.recording.write import write_voyage
from twin.report.page import content, html
from twin.studio.causes import MAX_CAUSES_TRIED, cause_view
from twin.studio.forces import force_view
from twin.studio.last_step import last_step, not_there
from twin.studio.looked import looked, write_result
from twin.studio.project import text_of
from twin.studio.verbs import command_of
from twin.study.prediction.openloop import HORIZONS_S
from twin.study.reference.sailed import Sailed, own_references, read_all
from twin.study.track.track import Track

Request = dict[str, Any]
LONGEST_LINE = 200  # of a ship file's difference: a covariance stands on one line


def look(asked: Request, job: Path, tell: Progress) -> None:
    tell(f"reading {asked['file']}")
    write_result(
        job, "result.json", plain(looked(Path(), asked["file"], asked.get("map"), asked.get("ship"), job))
    )


def import_(asked: Request, job: Path, tell: Progress) -> None:
    tell(f"reading {asked['file']}")
    not_there(asked["output"])
    accept = asked.get("accept", ())
    found = import_voyage(asked["file"], asked.get("map"), asked.get("ship"), accept=accept)
    refused = found.refused()
    write_result(job, "result.json", found.as_json() | {"output": None if refused else asked["output"]})
    if refused:
        raise DataError(refusal(asked["file"], refused, asked.get("map")))
    tell(f"writing {asked['output']}")
    last_step(asked["output"])
    write_voyage(found.voyage, asked["output"])


def compare(asked: Request, job: Path, tell: Progress) -> None:
    ship, sailed = load(asked["ship"]), _read(asked["voyages"], asked["ship"], tell)
    tell("predicting")
    found = comparison.of_sailed(ship, sailed, HORIZONS_S)
    result = found.to_dict() | {
        "command": command_of(asked),
        "files": {"ship": asked["ship"], "voyages": asked["voyages"]},
    }
    write_result(job, "result.json", result)
    _view("compare", result, job, tell, found.model, sailed)


def diagnose(asked: Request, job: Path, tell: Progress) -> None:
    from twin.study.diagnosis.effect_diagnosis import diagnose as judged

    ship = load(asked["ship"])
    tell("reading")
    voyages, references = ([read_voyage(p) for p in asked.get(key, [])] for key in ("voyages", "references"))
    done = judged(voyages, ship, references, tell)
    result = done.result | {
        "command": command_of(asked),
        "calibrated_on": own_references(ship, voyages, asked["voyages"]),
        "verdict_text": done.result["sentence"],
        "files": {"ship": asked["ship"], "voyages": asked["voyages"]},
    }
    write_result(job, "result.json", result)
    tell("drawing")
    tracks, model = list(done.case.tracks), done.case.model
    drawn = content("diagnose", result, tracks, model, voyages=voyages)
    whole.write(job / "report.html", html(drawn))
    shown = [*result["candidates"], *result["resembles"], *result["weather"]][:MAX_CAUSES_TRIED]
    causes = []
    for candidate in shown:
        tell(f"predicting with {candidate['effect']}")
        causes.append(cause_view(tracks, model, candidate, drawn["longest_s"]))
    write_view(job, drawn, {"causes": causes, "forces": [force_view(t, model) for t in tracks]})


def calibrate(asked: Request, job: Path, tell: Progress) -> str | None:
    not_there(asked["output"])
    ship = load(asked["ship"])
    every = _read([*asked["voyages"], *asked.get("held_outs", [])], asked["ship"], tell)
    used = len(asked["voyages"])
    done = calibration.of_sailed(ship, every[:used], every[used:], tell)
    if done.accepted:
        last_step(asked["output"])
        save(done.ship, asked["output"], asked["ship"])
    output = asked["output"] if done.accepted else None
    write_result(job, "result.json", done.to_dict() | {"output": output})
    changes = difference(asked["ship"], asked["output"]) if done.accepted else []
    write_result(job, "view.json", {"difference": changes})
    return None if done.accepted else f"{done.refused} {asked['output']} was not written."


def add(asked: Request, job: Path, tell: Progress) -> str | None:
    from twin.study.update.added import refused
    from twin.study.update.addition import add as fitted

    not_there(asked["output"])
    ship = load(asked["ship"])
    effects = [find_for(name, ship) for name in dict.fromkeys(asked["effects"])]
    every = _read([*asked["voyages"], *asked.get("held_outs", [])], asked["ship"], tell)
    sailed, held = every[: len(asked["voyages"])], every[len(asked["voyages"]) :]
    made = fitted(ship, effects, sailed, held, bool(asked.get("force")), False, tell)
    accepted = made.result["accepted"]
    result = made.result | {
        "command": command_of(asked),
        "files": {
            "ship": asked["ship"],
            "voyages": asked["voyages"],
            "judged": asked.get("held_outs") or asked["voyages"],
        },
        "output": asked["output"] if accepted else None,
    }
    tell("drawing")
    told = result | {"history": made.ship.notes["history"]}
    voyages = [s.voyage for s in held or sailed]
    drawn = content("add", told, made.held, made.model, Model.of(ship), voyages)
    page = html(drawn)
    if accepted:
        last_step(asked["output"])
        save(made.ship, asked["output"], asked["ship"])
    write_result(job, "result.json", result)
    whole.write(job / "report.html", page)
    changes = difference(asked["ship"], asked["output"]) if accepted else []
    write_view(job, drawn, {"difference": changes, "history": plain(list(made.ship.notes["history"]))})
    return (
        None
        if accepted
        else f"{refused(made.proof, made.fall, bool(held))} {asked['output']} was not written."
    )


DO: dict[str, Callable[[Request, Path, Progress], str | None]] = {
    "look": look,
    "import": import_,
    "compare": compare,
    "diagnose": diagnose,
    "calibrate": calibrate,
    "add": add,
}


def _read(paths: list[str], ship: str, tell: Progress) -> list[Sailed]:
    tell(f"reading {', '.join(paths)}")
    return read_all(paths, load(ship))


def _view(kind: str, result: Request, job: Path, tell: Progress, model: Model, sailed: list[Sailed]) -> None:
    tell("drawing")
    tracks: list[Track] = [s.track for s in sailed]
    drawn = content(kind, result, tracks, model, voyages=[s.voyage for s in sailed])
    whole.write(job / "report.html", html(drawn))
    write_view(job, drawn, {"forces": [force_view(t, model) for t in tracks]})


def write_view(job: Path, drawn: dict[str, Any], more: dict[str, Any]) -> None:
    """What the pictures need beside the result itself."""
    view = {k: drawn[k] for k in ("title", "verdict", "voyages", "longest_s")} | more
    shown = {k: drawn["result"].get(k) for k in ("horizons", "where", "worst_windows", "channels")}
    write_result(job, "view.json", plain(view | {"shown": shown}))


def difference(before: str, after: str) -> list[str]:
    """The two ship files, line by line, as `diff -u` shows them; long lines are cut. SettingsError: one is no
    text."""
    one, other = (text_of(Path(name)).splitlines() for name in (before, after))
    lines = difflib.unified_diff(one, other, fromfile=before, tofile=after, n=1, lineterm="")
    return [line if len(line) <= LONGEST_LINE else f"{line[:LONGEST_LINE]} ..." for line in lines]

"""Long work in processes of its own, its state in files: a reload or a dead worker loses nothing.

jobs/0007-diagnose/   job.json       what is asked (verbs.py), and the command line that does the same
                      worker.json    which process does it, since when
                      progress.jsonl a line a step: seconds since it began, words
                      result.json    the documented JSON of the verb, as `--json` writes it
                      view.json      what the pictures are drawn from; report.html: the same as one page
                      end.json       how it ended: exit code and, when not 0, the one line that says why
"""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from twin import whole
from twin.errors import SettingsError
from twin.physics.ship_pair import tidy
from twin.studio.project import JOBS, Project
from twin.studio.verbs import command_of

AT_ONCE = 2  # workers
START_S = 2.0  # until a worker has loaded what it needs
NAME = re.compile(r"\d{4}-[a-z]+")
JOB, WORKER, PROGRESS, END = "job.json", "worker.json", "progress.jsonl", "end.json"
CANCELLED = 130
LAST_STEP_S = 10.0  # a worker may write its files that long after it was cancelled
SHOWN = ("result.json", "view.json", "report.html", "series.f32")
MOST_LINES = 400  # of progress that are read


class Jobs:
    """The jobs of a project."""

    def __init__(self, project: Project):
        self.project = project
        self.folder = project.folder / JOBS
        self._ours: dict[str, subprocess.Popen[bytes]] = {}
        self._over: dict[str, dict[str, Any]] = {}  # what is shown of a job that ended: it stays as it is
        self._tidied: set[str] = set()  # jobs that died, whose half of a ship is removed
        self._turning = threading.Lock()  # no job begins while one is cancelled

    def add(self, asked: Mapping[str, Any]) -> str:
        """Notes what is asked; it begins at the next `turn`. The job's name. A look takes the place of the
        older ones at that file."""
        command = command_of(asked)  # refuses what cannot be meant, before anything is written
        self.folder.mkdir(exist_ok=True)
        number = 1 + max((int(name[:4]) for name in self.names()), default=0)
        while True:
            name = f"{number:04d}-{asked['verb']}"
            try:
                (self.folder / name).mkdir()
                break
            except FileExistsError:
                number += 1
        self._over.pop(name, None)  # of one that was forgotten
        note = {"asked": dict(asked), "command": command, "created_s": round(time.time(), 3)}
        whole.write(self.folder / name / JOB, json.dumps(note, indent=1) + "\n")
        if asked["verb"] == "look":
            self._forget_looks(asked["file"])
        return name

    def _forget_looks(self, file: str) -> None:
        """Those at a file that are over: nobody asks for them again, and their samples are large."""
        for told in self.all_told():
            if told["verb"] == "look" and told["asked"]["file"] == file:
                with suppress(SettingsError):  # it is at work
                    self.forget(told["name"])

    def turn(self) -> None:
        """Starts what waits, as many at once as may; takes leave of our workers that ended."""
        with self._turning:
            self._turn()

    def _turn(self) -> None:
        for name, worker in list(self._ours.items()):
            if worker.poll() is not None:
                del self._ours[name]
        states = self._states()
        for name in [n for n, state in states.items() if state == "died" and n not in self._tidied]:
            self._tidy(name)
        free = AT_ONCE - sum(state == "running" for state in states.values())
        waiting = [n for n, state in states.items() if state == "waiting" and n not in self._ours]
        for name in waiting[: max(free, 0)]:
            self._start(name)

    def _states(self) -> dict[str, str]:
        """Of all jobs, but those that were forgotten since they were listed."""
        found = {}
        for name in self.names():
            with suppress(SettingsError):
                found[name] = self._over[name]["state"] if name in self._over else self.state(name)
        return found

    def _tidy(self, name: str) -> None:
        """What the worker of a job that died left beside the ship file that it was writing."""
        self._tidied.add(name)
        output = (read(self.folder / name / JOB) or {}).get("asked", {}).get("output")
        if output:
            tidy(self.project.folder / Path(str(output)).name)

    def _start(self, name: str) -> None:
        folder = self.folder / name
        command = [sys.executable, "-m", "twin.studio.work", str(folder)]
        few = {key: os.environ.get(key, "1") for key in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}
        with open(folder / "log.txt", "ab") as log:
            worker = subprocess.Popen(
                command,
                cwd=self.project.folder,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
                env=os.environ | few,
            )
        self._ours[name] = worker
        note = {"pid": worker.pid, "born": born(worker.pid), "began_s": round(time.time(), 3)}
        whole.write(folder / WORKER, json.dumps(note) + "\n")

    def names(self) -> list[str]:
        """Of all jobs, oldest first."""
        if not self.folder.is_dir():
            return []
        return sorted(p.name for p in self.folder.iterdir() if NAME.fullmatch(p.name) and (p / JOB).is_file())

    def at(self, name: str) -> Path:
        if not NAME.fullmatch(name) or not (self.folder / name / JOB).is_file():
            raise SettingsError(f"{name[:80]!r}: there is no such job in this project.")
        return self.folder / name

    def state(self, name: str) -> str:
        """waiting, running, done, refused (done, but a threshold is not met), failed, cancelled, or died."""
        folder = self.at(name)
        end = read(folder / END)
        if end is not None:
            code = int(end.get("exit_code", 1))
            return {0: "done", 3: "refused", CANCELLED: "cancelled"}.get(code, "failed")
        worker = read(folder / WORKER)
        if worker is None:
            return "waiting"
        return "running" if alive(worker) else "died"

    def report(self, name: str) -> dict[str, Any]:
        """What the page shows of a job."""
        if name in self._over:
            return self._over[name]
        folder, state = self.at(name), self.state(name)
        note, worker, end = (read(folder / f) or {} for f in (JOB, WORKER, END))
        began_s = worker.get("began_s")
        over_s = end.get("ended_s") or time.time()
        took_s = None if began_s is None else round(over_s - began_s, 1)
        told = {
            "name": name,
            "state": state,
            "verb": note.get("asked", {}).get("verb"),
            "asked": note.get("asked"),
            "command": note.get("command"),
            "created_s": note.get("created_s"),
            "took_s": took_s,
            "usual_s": self._usual_s(note) if state in ("running", "waiting") else None,
            "progress": lines_of(folder / PROGRESS),
            "said": end.get("said"),
            "exit_code": end.get("exit_code"),
            "has": [f for f in SHOWN if (folder / f).is_file()],
        }
        if state not in ("waiting", "running", "died"):  # which may have ended since
            self._over[name] = told
        return told

    def all_told(self) -> list[dict[str, Any]]:
        told = []
        for name in self.names():
            with suppress(SettingsError):  # forgotten meanwhile
                told.append(self.report(name))
        return told

    def cancel(self, name: str) -> None:
        """Ends the worker of a job, and notes it: it has written nothing into the project. A worker that is
        writing already ends its `last_step` and its job is done; SettingsError when that takes long."""
        with self._turning:
            folder, worker = self.at(name), read(self.folder / name / WORKER)
            if self.state(name) not in ("waiting", "running"):
                return
            if worker is not None:
                _ended(worker, name)
            if not (folder / END).exists():
                note = {"exit_code": CANCELLED, "said": "cancelled", "ended_s": round(time.time(), 3)}
                whole.write(folder / END, json.dumps(note) + "\n")

    def forget(self, name: str) -> None:
        """Takes a job that is over out of the project, with what it found."""
        with self._turning:
            if self.state(name) in ("waiting", "running"):
                raise SettingsError(f"{name}: is at work. Cancel it first.")
            shutil.rmtree(self.at(name))
            self._over.pop(name, None)

    def _usual_s(self, note: Mapping[str, Any]) -> float | None:
        """How long this verb took in this project, by the bytes that it read; None before the first."""
        verb, size = note.get("asked", {}).get("verb"), self._bytes(note)
        rates = []
        for name in self.names()[::-1]:
            done = read(self.folder / name / JOB) or {}
            end, worker = read(self.folder / name / END), read(self.folder / name / WORKER)
            if (
                done.get("asked", {}).get("verb") != verb
                or not end
                or not worker
                or end.get("exit_code") not in (0, 3)
            ):
                continue
            read_then = self._bytes(done)
            if read_then:
                rates.append(max(end["ended_s"] - worker["began_s"] - START_S, 0.0) / read_then)
            if len(rates) == 5:
                break
        return round(START_S + size * sum(rates) / len(rates), 1) if rates and size else None

    def _bytes(self, note: Mapping[str, Any]) -> int:
        """Size of the voyages that a job reads."""
        total = 0
        for value in note.get("asked", {}).values():
            for name in value if isinstance(value, list) else [value]:
                path = self.project.folder / str(name)
                with suppress(OSError, ValueError):
                    total += path.stat().st_size if path.is_file() and path.suffix != ".toml" else 0
        return total


def _ended(worker: Mapping[str, Any], name: str) -> None:
    """Ends a worker and waits until it is gone."""
    with suppress(ProcessLookupError):
        os.killpg(int(worker["pid"]), signal.SIGTERM)
    until_s = time.monotonic() + LAST_STEP_S
    while alive(worker):
        if time.monotonic() > until_s:
            raise SettingsError(f"{name}: is writing its files and is not cancelled any more. Wait for it.")
        time.sleep(0.02)


def read(path: Path) -> dict[str, Any] | None:
    """A JSON object of a file; None when it is not there (yet)."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) else None


def lines_of(path: Path) -> list[dict[str, Any]]:
    """The progress so far; a last line that is being written is left for the next look."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return []
    out = []
    for line in text.split("\n")[:-1][-MOST_LINES:]:
        with suppress(ValueError):
            out.append(json.loads(line))
    return out


def born(pid: int) -> str:
    """When a process began, by the system's own count; "" where the system does not say it."""
    try:
        after_name = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return ""
    return "" if after_name[0] in "ZX" else after_name[19]


def alive(worker: Mapping[str, Any]) -> bool:
    """Whether the process of a worker's note is there, and not another that got its number."""
    pid = int(worker.get("pid", 0))
    if Path("/proc/self/stat").exists():
        return bool(worker.get("born")) and born(pid) == worker["born"]
    try:
        os.kill(pid, 0)
    except OSError:
        return False
    return True

"""A ship is two files; `kill -9` at any step of writing them leaves the old ship or the new one, and what a killed
writer left is removed by the next."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

import twin
from tests import command_lines
from tests.thorough import one_of, thorough
from twin.physics import ship as ships
from twin.physics.ship_pair import tidy
from twin.recording.read import read_voyage
from twin.recording.write import write_voyage
from twin.studio.jobs import Jobs
from twin.studio.project import Project

HERE = Path(__file__).parent
BUNDLED = Path(twin.__file__).parent / "voyages"
VOYAGES = ("held.mcap", "short.mcap")
ADD = ["add", "HullFouling", "--ship", "mine.toml", "--voyage", "short.mcap", "--held-out", "held.mcap"]
VERBS = {
    "init": command_lines.init("Alma", "-o", "mine.toml", "--force"),
    "calibrate": ["calibrate", "short.mcap", "--ship", "mine.toml", "-o", "mine.toml", "--force"],
    "add": [*ADD, "-o", "mine.toml", "--force"],
}


@pytest.fixture
def folder(tmp_path):
    """The bundled calibrated tanker under another name, and the first minutes of a voyage."""
    folder = tmp_path / "project"
    folder.mkdir()
    ships.save(ships.load(BUNDLED / "tanker.toml"), folder / "mine.toml")
    for name, day, until_s in (("short", "monday", 300.0), ("held", "tuesday", 700.0)):
        write_voyage(read_voyage(BUNDLED / f"{day}.mcap").between(0.0, until_s), folder / f"{name}.mcap")
    return folder


def killed(folder, words, **how):
    few = {"PYTHONPATH": str(HERE / "kill_each"), "KILL_STEM": "mine"}
    return subprocess.run(
        [sys.executable, *words], cwd=folder, env=os.environ | few | how, capture_output=True, text=True
    )


def files(folder):
    return sorted(path.name for path in folder.iterdir() if path.is_file())


def whole(folder, *ours):
    """The files of a folder in which a ship and its arrays are all that there is."""
    text = (folder / "mine.toml").read_text() if (folder / "mine.toml").exists() else ""
    arrays = [name for name in files(folder) if name.endswith(".json")]
    assert all(name in text for name in arrays)
    assert files(folder) == sorted([*ours, *arrays, *(["mine.toml"] if text else [])])
    return True


@pytest.mark.parametrize("verb", one_of(VERBS))
def test_a_kill_at_any_step_leaves_the_old_ship_or_the_new_and_the_next_writer_tidies(verb, folder, tmp_path):
    """Test: real SIGKILL before each opening, renaming and removing of a file of the ship. Expected: what is
    there loads and is the old or the new ship; after the next write no file is there that nobody names."""
    states = tmp_path / "states"
    states.mkdir()
    old = (folder / "mine.toml").read_text()
    done = killed(folder, ["-m", "twin", *VERBS[verb]], KILL_STATES=str(states))
    assert done.returncode in (0, 3), done.stderr
    new = (folder / "mine.toml").read_text()
    assert new != old and whole(folder, *VOYAGES)
    steps = sorted(states.iterdir(), key=lambda path: int(path.name))
    seen = []
    for state in steps:
        said = (state / "mine.toml").read_text()
        assert said in (old, new), state
        seen.append((said == new, len(files(state))))
        ship = ships.load(state / "mine.toml")
        ships.save(ship, state / "mine.toml")
        assert whole(state, *VOYAGES), state
    assert {is_new for is_new, _ in seen} == {False, True}
    assert max(count for _, count in seen) > len(files(folder))  # so that there was something to tidy


def test_a_writer_tidies_nothing_while_another_writes_nor_what_another_ship_file_names(folder):
    """Test: arrays that a copy of the ship file names, ones that nobody names, ones that are a person's own
    by the same kind of name, and a writer at work. Expected: only the second go, and only when nobody
    writes."""
    shutil.copyfile(folder / "mine.toml", folder / "copy.toml.bak")
    (named,) = folder.glob("mine.*.json")
    ships.save(ships.load("kvlcc2"), folder / "mine.toml")
    own = folder / "mine.0123abcd.json"
    own.write_text("{}")
    assert named.exists() and own.exists()
    (folder / "copy.toml.bak").unlink()
    script = (
        "import sys, fcntl, os\nfcntl.flock(os.open('.', os.O_RDONLY), fcntl.LOCK_SH)\nprint(1, flush=True)\n"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", script + "sys.stdin.read()"],
        cwd=folder,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    assert other.stdout.readline()
    tidy(folder / "mine.toml")
    assert named.exists()
    other.communicate()
    tidy(folder / "mine.toml")
    assert files(folder) == sorted([own.name, "mine.toml", *VOYAGES])


@thorough
def test_what_a_killed_worker_of_the_studio_left_is_gone_at_the_next_look(folder, monkeypatch):
    """Test: the worker of a calibration is killed between the arrays and the ship file. Expected: the arrays
    are there and no ship; once the studio looks at its jobs again, neither, and the job is said to have died."""
    project = Project(folder)
    (folder / "mine.toml").rename(folder / "tanker.toml")  # its arrays keep their name
    jobs = Jobs(project)
    asked = {"verb": "calibrate", "ship": "tanker.toml", "voyages": ["short.mcap"], "output": "mine2.toml"}
    name = jobs.add(asked)
    monkeypatch.setenv("PYTHONPATH", str(HERE / "kill_each"))
    monkeypatch.setenv("KILL_STEM", "mine2")
    monkeypatch.setenv("KILL_AT", "3")
    before = files(folder)
    jobs.turn()
    until_s = time.monotonic() + 120.0
    while jobs.state(name) == "running" and time.monotonic() < until_s:
        time.sleep(0.1)
    assert jobs.state(name) == "died", (folder / "jobs" / name / "log.txt").read_text()
    left = sorted(set(files(folder)) - set(before))
    assert [n[:6] for n in left] == [".mine2", "mine2."] and left[1].endswith(".json")
    jobs.turn()
    assert files(folder) == before and jobs.state(name) == "died"
    assert json.loads((folder / "jobs" / name / "job.json").read_text())["asked"] == asked

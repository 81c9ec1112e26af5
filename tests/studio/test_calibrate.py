"""Calibrate in a real Chromium: pressed, cancelled, done; the numbers are those of the command line to the last
digit. Three short voyages of the reference sea on a ship that is not calibrated yet."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

import twin
from bench.bundled import recorded
from bench.reference import SeaCase, simulate
from tests.studio.by_mouse import OVER, answer, ended, go, opened, press, shown, typed
from tests.thorough import thorough
from twin.errors import SettingsError
from twin.recording.write import write_voyage
from twin.studio.jobs import Jobs, born
from twin.studio.last_step import last_step
from twin.studio.project import Project

TAGS = {"zigzag_20": "reference", "speed_changes": "reference", "mixed": "held_out"}
AT_WORK = "[...document.querySelectorAll('#work .job')].find((e) => e.dataset.job === {name})?.innerText"


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Two reference voyages and one to measure on, 7.5 min each, and the published tanker."""
    folder = tmp_path_factory.mktemp("calibrate") / "voyages"
    folder.mkdir()
    shutil.copyfile(Path(twin.__file__).parent / "ships" / "kvlcc2.toml", folder / "kvlcc2.toml")
    sailed = simulate([SeaCase("kvlcc2", m, seed=960 + i, duration_s=450.0) for i, m in enumerate(TAGS)])
    project = Project(folder)
    for (name, tag), r in zip(TAGS.items(), sailed, strict=True):
        write_voyage(recorded(name, r.columns, every=10), folder / f"{name}.mcap")
        project.tag(f"{name}.mcap", tag)
    return project


@pytest.fixture(scope="module")
def page(tab, served):
    return opened(tab, served)


def begun(page):
    """Calibrate with what the page proposes, measured on the voyage that is held out: the job's name."""
    go(page, "#/calibrate")
    page.wait("!!document.querySelector('#calibrate-output')", 30)
    held = "[...document.querySelectorAll('fieldset')].at(-1).querySelectorAll('label')"
    page.value(
        f"[...{held}].find((l) => l.innerText.includes('mixed.mcap')).querySelector('input:not(:checked)')?.click()"
    )
    press(page, "Calibrate")
    page.wait("location.hash.startsWith('#/calibrate/0')", 30)
    return page.value("location.hash.split('/')[2].split('?')[0]")


def files(project):
    """What lies in the project beside its jobs, with every byte."""
    return {p.name: p.read_bytes() for p in project.folder.iterdir() if p.is_file()}


def test_a_cancelled_calibration_leaves_every_file_as_it_was_and_says_so(page, project):
    before = files(project)
    name = begun(page)
    page.wait(f"({AT_WORK.format(name=json.dumps(name))} || '').includes('fitting the core')", 60)
    pid = json.loads((project.folder / "jobs" / name / "worker.json").read_text())["pid"]
    assert born(pid)
    page.value("document.querySelector('#work [aria-label=\"Cancel calibrate\"]').click()")
    page.wait("document.querySelector('main').innerText.includes('This was cancelled')", 30)
    assert "its files are as they were" in shown(page) and "Do it again" in shown(page)
    assert page.value(OVER.format(name=json.dumps(name))) == "cancelled" and not born(pid)
    assert files(project) == before
    assert not [p.name for p in (project.folder / "jobs" / name).iterdir() if p.name.startswith(".")]
    assert not page.said


@thorough
def test_a_calibration_by_mouse_is_that_of_the_command_line(page, project, tmp_path):
    """Test: the two reference voyages fitted, the third held out. Expected: steps told while it works; the error
    before and after, every number of it and the ship file are those of the command beside them."""
    name = begun(page)
    listed = f"document.querySelector('[data-steps=\"{name}\"]')?.innerText || ''"
    for step in (
        "reading speed_changes.mcap, zigzag_20.mcap",
        "fitting the core",
        "estimating the noise model",
    ):
        page.wait(f"({listed}).includes({json.dumps(step)})", 60)
    assert "so far" in page.value(AT_WORK.format(name=json.dumps(name)))
    assert ended(page, "calibrate") == name
    done = answer(project, name)
    last = done["held_out"][-1]
    assert done["accepted"] and last["position_m"] < 0.8 * last["before_m"]
    digits = page.value("[...document.querySelectorAll('main td span[title]')].map((s) => Number(s.title))")
    keys = ("before_m", "position_m", "before_deg", "heading_deg")
    assert digits == [h[key] for h in done["held_out"] for key in keys]
    assert f"Written to {done['output']}." in shown(page) and done["held_out_is"] in shown(page)
    command = json.loads((project.folder / "jobs" / name / "job.json").read_text())["command"]
    assert f"{command} --json calibrate.json" in shown(page)
    assert "--held-out mixed.mcap" in command and not page.said
    mine = project.folder / done["output"]
    text = mine.read_text()
    os.rename(mine, tmp_path / mine.name)
    assert typed(project, command, tmp_path / "typed.json") == done
    assert mine.read_text() == text


WRITES = """
import sys, time, pathlib
from twin.studio.last_step import last_step
last_step("new.toml")
print("writing", flush=True)
time.sleep(0.5)
pathlib.Path("new.toml").write_text("whole")
pathlib.Path(sys.argv[1], "end.json").write_text('{"exit_code": 0, "ended_s": 0}')
"""


def test_a_job_that_is_writing_already_is_done_and_not_cancelled(tmp_path):
    """Test: cancelled in its last step. Expected: the step is finished, and the job says done, not cancelled."""
    project = Project(tmp_path)
    jobs = Jobs(project)
    name = jobs.add({"verb": "calibrate", "ship": "a.toml", "voyages": ["a.mcap"], "output": "new.toml"})
    words = [sys.executable, "-c", WRITES, str(jobs.at(name))]
    worker = subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, start_new_session=True)
    assert worker.stdout.readline() == b"writing\n"
    note = {"pid": worker.pid, "born": born(worker.pid), "began_s": time.time()}
    (jobs.at(name) / "worker.json").write_text(json.dumps(note))
    jobs.cancel(name)
    assert jobs.state(name) == "done" and (tmp_path / "new.toml").read_text() == "whole"
    worker.wait(10)
    worker.stdout.close()


def test_a_file_that_came_while_a_job_worked_is_not_written_over(tmp_path):
    (tmp_path / "new.toml").write_text("another's")
    words = [sys.executable, "-c", "from twin.studio.last_step import last_step\nlast_step('new.toml')"]
    ended = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert ended.returncode and SettingsError.__name__ in ended.stderr and last_step.__name__ in ended.stderr

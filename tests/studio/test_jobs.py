"""The turn that starts work: it goes on whatever happens to one job, and starts none twice."""

import subprocess

import anyio
import pytest

from twin import whole
from twin.errors import SettingsError, TwinError
from twin.studio.app import Studio
from twin.studio.jobs import Jobs
from twin.studio.project import Project

ASKED = {"verb": "look", "file": "monday.mcap"}


class Worker:
    """A worker that never ends."""

    pid = 2**22 + 1  # beyond the greatest that there is

    def __init__(self, *_, **__):
        started.append(self)

    def poll(self):
        return None


started: list[Worker] = []


@pytest.fixture
def jobs(tmp_path, monkeypatch):
    started.clear()
    monkeypatch.setattr(subprocess, "Popen", Worker)
    return Jobs(Project(tmp_path))


def test_a_job_that_is_forgotten_in_the_middle_of_a_turn_holds_up_no_other(jobs, monkeypatch):
    names = jobs.names
    jobs.add(ASKED)
    monkeypatch.setattr(
        jobs, "names", lambda: ["0000-look", *names()]
    )  # listed, and gone when it is looked at
    with pytest.raises(SettingsError, match="no such job"):
        jobs.state("0000-look")
    jobs.turn()
    assert len(started) == 1
    assert [told["name"] for told in jobs.all_told()] == names()


def test_a_worker_whose_note_cannot_be_written_is_not_started_again(jobs, monkeypatch):
    """Test: the disk is full when it is noted which process does the job. Expected: one worker all the same."""
    jobs.add(ASKED)
    full = TwinError("cannot be written (No space left on device)")
    monkeypatch.setattr(whole, "write", lambda *_: (_ for _ in ()).throw(full))
    with pytest.raises(TwinError, match="No space left"):
        jobs.turn()
    jobs.turn()
    assert len(started) == 1


@pytest.mark.parametrize("harm", [TwinError("disk full"), OSError(11, "too many processes")])
def test_the_server_goes_on_taking_turns_after_one_that_failed(tmp_path, monkeypatch, harm):
    studio, turns = Studio(tmp_path), []

    def turn():
        turns.append(len(turns))
        if len(turns) == 1:
            raise harm

    async def served():
        async with studio._lifespan(studio.app()):
            with anyio.fail_after(20.0):
                while len(turns) < 3:
                    await anyio.sleep(0.05)

    monkeypatch.setattr(studio.jobs, "turn", turn)
    anyio.run(served)
    assert turns[:3] == [0, 1, 2]


def over(jobs, name):
    """A job that is done."""
    whole.write(jobs.folder / name / "end.json", '{"exit_code": 0, "ended_s": 1.0}')


def test_a_new_look_at_a_file_takes_the_place_of_the_older_ones(jobs):
    """Expected: those that are over are forgotten with their samples; one at work, other files and verbs stay."""
    old, other, compared, busy = (
        jobs.add(asked)
        for asked in (
            ASKED,
            ASKED | {"file": "tuesday.mcap"},
            {"verb": "compare", "ship": "s.toml", "voyages": ["monday.mcap"]},
            ASKED,
        )
    )
    for name in (old, other, compared):
        over(jobs, name)
    new = jobs.add(ASKED)
    assert jobs.names() == [other, compared, busy, new]


def test_what_ended_is_not_read_again_at_every_turn(jobs, monkeypatch):
    """Expected: a job that is over is read once; its name, given to a new one, is that of the new one."""
    name, read_files = jobs.add({"verb": "import", "file": "a.csv", "output": "a.mcap"}), []
    over(jobs, name)
    jobs.turn()
    first = jobs.all_told()
    monkeypatch.setattr("twin.studio.jobs.read", lambda path: read_files.append(path))
    jobs.turn()
    assert jobs.all_told() == first and first[0]["state"] == "done" and not read_files
    monkeypatch.undo()
    monkeypatch.setattr(subprocess, "Popen", Worker)
    jobs.forget(name)
    assert jobs.add({"verb": "import", "file": "a.csv", "output": "a.mcap"}) == name
    assert jobs.all_told()[0]["state"] == "waiting"

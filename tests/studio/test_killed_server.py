"""The workbench's server killed in the middle of a calibration: whole files, and the work goes on or is said to be gone."""

import signal
import time

import pytest

from tests.studio.test_server import Client
from twin.physics.ship import load

ASKED = {"verb": "calibrate", "ship": "tanker.toml", "voyages": ["monday.mcap"], "output": "mine.toml"}


@pytest.fixture(scope="module")
def servers(project, serve):
    """Starts a server of the project; all that still run are stopped at the end."""
    started = []

    def one():
        started.append(serve(project.folder))
        return started[-1]

    yield one
    for served in started:
        if served.process.poll() is None:
            served.stop()


def test_a_server_that_is_killed_in_a_calibration_leaves_whole_files_and_its_work_is_found_again(
    servers, project
):
    """Test: kill -9 while the worker fits; a new server. Expected: every ship file is whole and as it was, no half file
    beside it; the new server knows the job, and a cancel leaves nothing of it."""
    before = {path.name: path.read_bytes() for path in project.folder.iterdir() if path.is_file()}
    first = servers()
    client = Client(first)
    status, said = client.json("/api/jobs", ASKED)
    assert status == 200
    job, until = f"/api/jobs/{said['job']}", time.monotonic() + 60.0
    while len(client.json(job)[1]["progress"]) < 2:
        assert time.monotonic() < until
        time.sleep(0.1)
    first.process.send_signal(signal.SIGKILL)
    first.process.wait(20)
    first.process.stdout.close()
    again = Client(servers())
    state = again.json(job)[1]["state"]
    assert state in ("running", "died", "done")
    if state == "running":
        assert again.ask(f"{job}/cancel", {})[0] == 200
        until = time.monotonic() + 30.0
        while (state := again.json(job)[1]["state"]) == "running":
            assert time.monotonic() < until
            time.sleep(0.1)
        assert state == "cancelled"
    now = {path.name: path.read_bytes() for path in project.folder.iterdir() if path.is_file()}
    assert {name: now.get(name) for name in before} == before
    if state != "done":
        assert set(now) == set(before)
    assert load(project.folder / "tanker.toml").name
    assert again.json("/api/project")[0] == 200

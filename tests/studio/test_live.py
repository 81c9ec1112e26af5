"""Live against a real `twin run` on the bus of this computer: the estimate moves, and what is old is marked."""

import json
import math
import os
import shlex
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.studio.by_mouse import go, opened
from twin.live.demonstration import UNDER_WAY, ticks_of
from twin.studio.live import Live

HULL = "kvlcc2"
FRAME = "document.querySelector('iframe')?.contentWindow.twinView?.frame()"
OLD = "document.querySelector('iframe').contentDocument.documentElement.classList.contains('old')"
INSIDE = "document.querySelector('iframe').contentDocument.body.innerText"


class Aboard:
    """A twin and the sea that it hears, each in a process of its own."""

    def __init__(self, folder):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.folder, self.place = folder, f"tcp/127.0.0.1:{self.port}"
        (folder / "twin.toml").write_text(
            "[loop]\nrate_hz = 10.0\npriority = 0\nlock_memory = false\n"
            f'[bus]\nlisten = "{self.place}"\n[ship]\nfile = "{HULL}"\n'
            f'[log]\nfolder = "{folder}/logs"\n[state]\nfolder = "{folder}/state"\n'
        )
        self.twin = self.sea = None

    def start(self):
        command = [sys.executable, "-m", "twin", "run", "--config", str(self.folder / "twin.toml")]
        self.twin = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        assert "KVLCC2" in self.twin.stderr.readline()
        if self.sea is None:
            command = [sys.executable, "-m", "bench.sea_process", "--connect", self.place, "--hull", HULL]
            command += ["--manoeuvre", "zigzag_20", "--after", "60"]
            self.sea = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            assert any(UNDER_WAY in line for line in self.sea.stdout)

    def stop(self):
        """Told to stop, as a service is; the last tick that it logged."""
        self.twin.send_signal(signal.SIGTERM)
        assert self.twin.wait(20) == 0
        self.twin.stderr.close()
        return list(ticks_of(max((self.folder / "logs").glob("*.mcap"))))[-1]

    def end(self):
        for process in (self.twin, self.sea):
            if process and process.poll() is None:
                process.kill()
                process.wait()
            if process:
                (process.stdout or process.stderr).close()


@pytest.fixture(scope="module")
def aboard(tmp_path_factory):
    aboard = Aboard(tmp_path_factory.mktemp("aboard"))
    aboard.start()
    yield aboard
    aboard.end()


@pytest.fixture
def page(tab, tmp_path, serve):
    """An empty project, open at Live."""
    served = serve(tmp_path)
    tab.size(1400, 900)
    tab.leave()
    tab.open(served.links[0] + "#/live")
    tab.wait("!!window.twinStudio?.drawn && !!document.getElementById('attach')", 30)
    tab.served = served
    yield tab
    if served.process.poll() is None:
        served.stop()


def attach(page, place):
    page.value(
        f"(() => {{ const i = document.getElementById('connect'); i.value = {json.dumps(place)};"
        "i.dispatchEvent(new Event('input')); document.getElementById('attach').click(); })()"
    )


def hears(page, number):
    """Whether the process of the studio holds a connection to that port of this computer."""
    inodes = {os.readlink(f"/proc/{page.served.process.pid}/fd/{fd.name}") for fd in _files(page)}
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    return any(int(r[2].partition(":")[2], 16) == number and f"socket:[{r[9]}]" in inodes for r in rows)


def _files(page):
    return list(Path(f"/proc/{page.served.process.pid}/fd").iterdir())


def test_the_estimate_moves_and_a_stopped_twin_is_marked_until_it_speaks_again(page, aboard):
    """Test: attached to a running twin, which is stopped and started. Expected: the pictures are its ticks;
    within two seconds of its end the whole picture is marked, and no longer when it speaks again."""
    attach(page, aboard.place)
    page.wait(f"!!{FRAME}?.place && ['hybrid', 'physics'].includes({FRAME}.mode.name)", 60)
    assert page.value("document.querySelector('main .command code').textContent").endswith(aboard.place)
    before = page.value(FRAME)
    page.wait(f"{FRAME}.wall_s > {before['wall_s'] + 2.0}", 30)
    after = page.value(FRAME)
    moved = math.hypot(*(after["place"][k] - before["place"][k] for k in ("n", "e")))
    assert after["ship"]["ship"] == "KVLCC2" and moved / (after["wall_s"] - before["wall_s"]) > 1.0
    assert not page.value(OLD) and not page.value("document.title").startswith("OLD")
    last, stopped = aboard.stop(), time.monotonic()
    page.wait(OLD, 10)
    assert time.monotonic() - stopped < 5.0
    shown = page.value(FRAME)
    assert shown["wall_s"] == round(last.wall_s, 1)
    assert shown["place"]["n"] == round(last.estimate.north_m, 2)
    assert "NOTHING HEARD FOR" in page.value(INSIDE)
    assert (
        page.value("document.querySelector('iframe').contentDocument.querySelector('.stamp').textContent")
        == "OLD"
    )
    page.wait("document.title.startsWith('OLD')", 5)
    aboard.start()
    page.wait(f"!{OLD} && {FRAME}.wall_s > {shown['wall_s'] + 2.0}", 60)
    page.wait("!document.title.startsWith('OLD')", 5)
    assert not page.said


def test_a_reload_keeps_listening_and_leaving_ends_it(page, aboard):
    attach(page, aboard.place)
    page.wait(f"!!{FRAME}?.place", 60)
    page.value("location.reload()")
    time.sleep(0.3)
    page.wait(f"!!{FRAME}?.place && {FRAME}.feed.silent === false", 30)
    assert hears(page, aboard.port)
    page.value("document.getElementById('leave').click()")
    page.wait("!document.querySelector('iframe')", 10)
    until = time.monotonic() + 10.0
    while hears(page, aboard.port):
        assert time.monotonic() < until, "it listens after it was told to leave"
        time.sleep(0.1)
    assert not page.said


def test_work_that_ends_does_not_begin_the_picture_anew(page, aboard):
    """Test: a file that cannot be read, looked at meanwhile. Expected: its end is heard, the picture goes on."""
    attach(page, aboard.place)
    page.wait(f"!!{FRAME}?.place", 60)
    page.value("document.querySelector('iframe').contentWindow.same = true")
    (page.served.folder / "none.csv").write_text("what\n")
    asked = "{method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({verb: 'look', file: 'none.csv'})}"
    page.value(f"fetch('/api/jobs', {asked})")
    page.wait("twinStudio.state.jobs.some((j) => !['waiting', 'running'].includes(j.state))", 60)
    assert page.value("document.querySelector('iframe').contentWindow.same") is True


def test_the_colours_of_the_studio_are_those_of_its_bridge(page, aboard):
    attach(page, aboard.place)
    page.wait(f"!!{FRAME}?.place", 60)
    for theme in ("night", "light"):
        page.value(f"document.querySelector('[data-theme-name={theme}]').click()")
        page.wait(
            f"document.querySelector('iframe').contentDocument.documentElement.dataset.theme === '{theme}'", 5
        )


def test_the_workbench_ends_while_it_listens(page, aboard):
    """Expected: told to stop with the bus open and a page looking on, it ends by itself."""
    attach(page, aboard.place)
    page.wait(f"!!{FRAME}?.place", 60)
    page.served.stop()


@pytest.mark.parametrize("place", ["nowhere", "tcp/127.0.0.1", "tcp/127.0.0.1:7447, tcp/x:1"])
def test_a_place_that_is_none_is_said_in_one_line(page, place):
    attach(page, place)
    said = page.wait("document.getElementById('said').textContent", 20)
    assert (
        "\n" not in said
        and "as in 'tcp/127.0.0.1:7447'" in said
        and not page.value("!!document.querySelector('iframe')")
    )


def test_the_command_for_a_log_takes_its_name_as_one_word(tab, tmp_path, serve):
    (tmp_path / "monday $(reboot).mcap").touch()
    served = serve(tmp_path)
    try:
        page = opened(tab, served)
        go(page, "#/live")
        page.value(
            "(() => { const s = document.querySelector('#live-log'); s.selectedIndex = 1;"
            "s.dispatchEvent(new Event('change')); })()"
        )
        said = page.value("document.querySelector('main .command code').textContent")
        assert shlex.split(said) == ["twin", "view", "monday $(reboot).mcap"]
    finally:
        served.stop()


def test_where_nobody_speaks_nothing_looks_alive(page):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        attach(page, f"tcp/127.0.0.1:{probe.getsockname()[1]}")
        page.wait(f"!!{FRAME} && {OLD}", 20)
        assert "NOTHING HEARD YET" in page.value(INSIDE)


def test_a_twin_that_is_looked_at_no_more_is_left():
    """Test: one place on the bus, another, and none. Expected: the session with each is closed when it is left."""
    live, sessions = Live(), []
    for place in ("tcp/127.0.0.1:1", "tcp/127.0.0.1:2"):
        live.attach(place, None)
        sessions.append(live.watch.feed._session)
    live.leave()
    until = time.monotonic() + 10.0
    while not all(s.is_closed() for s in sessions) and time.monotonic() < until:
        time.sleep(0.05)
    assert [s.is_closed() for s in sessions] == [True, True]

"""The demo: a ship sails, its twin listens, the log replays to the same states; and what a terminal shows."""

import os
import signal
import subprocess
import sys
import time
from io import StringIO
from pathlib import Path

import pytest

from twin.live import demonstration, terminal
from twin.live.keelson.messages import Tick

DEMO = [sys.executable, "-m", "twin.cli", "demo"]


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """One short demo: (finished process, its folder)."""
    folder = tmp_path_factory.mktemp("demo")
    env, command = os.environ | {"HOME": str(folder)}, [*DEMO, "--seconds", "8"]
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, timeout=110), folder


def test_the_demo_ends_by_itself_and_well(done):
    assert done[0].returncode == 0, done[0].stdout + done[0].stderr


def test_without_a_terminal_it_says_plain_lines(done):
    said = done[0].stdout
    assert "\x1b" not in said
    assert "heading" in said and "known" in said and "learned" in said


def test_the_twin_heard_the_ship(done):
    """Expected: most ticks ran on measurements, so the sea, the bus and the loop found each other."""
    (log,) = done[1].glob("logs/demo-*/twin-*.mcap")
    ticks = list(demonstration.ticks_of(log))
    assert len(ticks) > 100
    name = "heading_true_north_deg"
    heard = [t for t in ticks if t.measured.HasField(name) and t.estimate.HasField(name)]
    assert len(heard) > 0.7 * len(ticks)


def test_the_replay_gives_the_states_that_were_said_live(done):
    assert "the same estimates as live, bit for bit" in done[0].stdout


def test_it_says_where_the_log_is_and_the_next_command(done):
    lines = done[0].stdout.splitlines()
    log = next(i for i, line in enumerate(lines) if line.startswith("log: "))
    assert any(line.startswith("next: twin ") for line in lines[log:])


def test_an_interrupt_ends_the_demo_and_the_sea(tmp_path):
    """Test: Ctrl-C while it sails. Expected: exit code 130 soon, and no process of the sea left."""
    process = subprocess.Popen([*DEMO, "--seconds", "60"], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    for line in process.stdout:
        if "Hz" in line:
            break
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    process.send_signal(signal.SIGINT)
    assert process.wait(20) == 130
    time.sleep(0.5)
    assert children and not [pid for pid in children if os.path.exists(f"/proc/{pid}/cmdline")]


@pytest.mark.parametrize(("words", "code"), [(["--seconds", "1"], 2), (["--ship", "usw"], 5)])
def test_what_cannot_be_shown_is_refused_in_one_line(words, code, tmp_path):
    refused = subprocess.run([*DEMO, *words], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert refused.returncode == code
    assert refused.stderr.count("\n") == 1 and words[1] in refused.stderr


def test_why_the_sea_did_not_start_is_said(tmp_path):
    refused = subprocess.run(
        [*DEMO, "--manoeuvre", "zigzack"], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert refused.returncode == 1 and "zigzack" in refused.stderr and "zigzag_20" in refused.stderr


def tick(time_s=0.0):
    """A tick with a bit of everything."""
    made = Tick(time_s=time_s, mode="hybrid", rate_hz=10.0, step_us=800.0, slack_us=99200.0)
    made.reasons.append("a reason")
    made.measured.heading_true_north_deg, made.estimate.heading_true_north_deg = 359.9, 0.1
    made.known.add(name="hull", X_N=-3.0, Y_N=2.0, N_Nm=1.0)
    made.known.add(name="rudder", X_N=1.0, Y_N=1.0, N_Nm=-4.0)
    made.learned.X_N, made.learned.share = 0.5, 0.25
    return made


def test_a_page_shows_known_and_learned_apart_and_why():
    page = terminal.page(tick(), "title", 1.0, 40.0, "logs", [])
    assert "known: hull" in page and "learned" in page and "25 % of all" in page
    assert "359.9" in page and "0.1" in page and "- a reason" in page


def test_the_known_forces_are_summed():
    row = next(
        line for line in terminal.page(tick(), "t", 0.0, 1.0, "", []).splitlines() if "known, all" in line
    )
    assert row.split()[-3:] == ["-2.000", "+3.000", "-3.000"]


def test_what_was_not_measured_is_a_dash_and_not_a_number():
    assert "speed ahead -/- m/s" in terminal.line(tick(), 0.0)


def test_pages_are_drawn_four_times_a_second_and_lines_every_five():
    for pages, expected in ((True, 40), (False, 2)):
        stream = StringIO()
        show = terminal.View(stream, "t", 10.0, "logs", pages).show
        for i in range(100):
            show(tick(i * 0.1))
        drawn = stream.getvalue().count(terminal.CLEAR_SCREEN) if pages else stream.getvalue().count("\n")
        assert drawn == pytest.approx(expected, abs=7 if pages else 0)

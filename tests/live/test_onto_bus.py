"""A recorded voyage on the bus, at a pace, with pauses, and what a viewer in another process sees of it."""

import json
import os
import signal
import socket
import subprocess
import sys
import time

import pytest

from tests.command_lines import hears_interrupts
from twin.live.bridge.feed import BusFeed
from twin.live.keelson.messages import Row
from twin.live.log.logfile import LogFile
from twin.live.paced import FASTEST, SLOWEST, PacedClock, Player
from twin.live.signals.config import Settings

TWIN = [sys.executable, "-m", "twin.cli"]


def timed(clock):
    """(seconds it took, instants)."""
    began = time.monotonic()
    instants = []
    while (instant := clock.wait()) is not None:
        instants.append(instant)
    return time.monotonic() - began, instants


def times(seconds, start=50.0):
    return [(start + 0.1 * i, 1e9 + 0.1 * i) for i in range(round(10 * seconds) + 1)]


def test_a_voyage_of_two_seconds_at_speed_five_takes_four_tenths():
    took, instants = timed(PacedClock(times(2.0), Player(5.0)))
    assert took == pytest.approx(0.4, abs=0.2) and [i.number for i in instants] == list(range(21))
    assert (instants[0].time_s, instants[-1].wall_s) == (50.0, 1e9 + 2.0)


def test_a_hole_of_an_hour_is_jumped_over():
    took, instants = timed(PacedClock([*times(0.2), *times(0.2, 5000.0)], Player(1.0)))
    assert took < 2.0 and len(instants) == 6


def test_a_pause_is_not_made_up_for_when_the_voyage_goes_on():
    """Test: a pause of half a second in a voyage of one. Expected: it takes half a second longer."""
    player = Player(1.0)
    player.pause()
    signal.signal(signal.SIGALRM, player.pause)
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    took, _ = timed(PacedClock(times(1.0), player))
    assert took == pytest.approx(1.5, abs=0.35)


def test_keys_pause_change_the_speed_within_bounds_and_end():
    said = []
    player = Player(1.0, said.append)
    for _ in range(20):
        player.key("+")
    assert player.speed == FASTEST
    for _ in range(20):
        player.key("-")
    assert player.speed == SLOWEST
    player.key(" ")
    assert player.paused and said[-1] == "paused"
    player.key("")
    player.key("x")
    player.key("q")
    assert player.over and timed(PacedClock(times(9.0), player))[1] == []


@pytest.fixture
def voyage(sailing, tmp_path, on_file):
    """Sixty seconds as an import writes them, and settings that need no network and a certificate on file."""
    with LogFile(tmp_path / "voyage.mcap") as log:
        for _ in range(600):
            row = Row(time_s=sailing.t, **{r.channel: r.value for r in sailing.readings(sailing.t)})
            log.add("shiptwin/voyage/row", "shiptwin.Row", row.SerializeToString(), round(sailing.t * 1e9))
            sailing.advance()
    (tmp_path / "twin.toml").write_text(
        f'[residual]\nfile = "none"\n[observer]\ncertificate = "{on_file}/onto_bus.json"\n'
    )
    return tmp_path / "voyage.mcap"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def heard(feed, seconds, enough=10**9):
    """Ticks that come in that time."""
    ticks, until = [], time.monotonic() + seconds
    while time.monotonic() < until and len(ticks) < enough:
        ticks += feed.poll(time.monotonic())
        time.sleep(0.02)
    return ticks


def test_a_recorded_voyage_is_seen_on_the_bus_paused_and_to_its_end(voyage, tmp_path):
    """Test: replay in one process, a viewer in the terminal in another, and this one listening; Ctrl-Z twice.
    Expected: ticks with the voyage's numbers, none in the pause, the origin said, exit code 0."""
    place = f"tcp/127.0.0.1:{free_port()}"
    options = ["--config", tmp_path / "twin.toml", "--to-bus", "--speed", "8", "--listen", place]
    replay = subprocess.Popen(
        [*TWIN, "replay", voyage, *options, "--json", tmp_path / "summary.json"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    view = subprocess.Popen(
        [*TWIN, "view", "--text", "--connect", place],
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=hears_interrupts,
    )
    feed = BusFeed(Settings({"bus.listen": "", "bus.connect": [place]}))
    try:
        first = heard(feed, 120.0, 5)
        assert len(first) >= 5
        replay.send_signal(signal.SIGTSTP)
        heard(feed, 0.5)
        assert heard(feed, 1.0) == []
        replay.send_signal(signal.SIGTSTP)
        rest = heard(feed, 30.0, 100)
        assert len(rest) >= 100 and rest[0].index > first[-1].index
        assert (feed.about.origin, feed.about.ship, feed.about.length_m) == ("replay", "KVLCC2", 320.0)
        assert rest[-1].estimate.surge_velocity_mps == pytest.approx(
            rest[-1].measured.surge_velocity_mps, abs=0.3
        )
        out, err = replay.communicate(timeout=60)
        assert replay.returncode == 0, err
        assert "paused" in err and "next: twin compare" in out
        assert json.loads((tmp_path / "summary.json").read_text())["ticks"] == 600
    finally:
        for process in (replay, view):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        lines = view.communicate(timeout=30)[0].splitlines()
        feed._session.close()
    assert view.returncode == 130
    assert any(line.startswith("RECORDED") and "physics only" in line for line in lines), lines


def test_a_taken_port_is_one_line_and_nothing_is_replayed(voyage, tmp_path):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        place = f"tcp/127.0.0.1:{taken.getsockname()[1]}"
        options = ["--config", tmp_path / "twin.toml", "--to-bus", "--listen", place]
        done = subprocess.run([*TWIN, "replay", voyage, *options], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and place in done.stderr and len(done.stderr.strip().splitlines()) == 1


@pytest.mark.parametrize(
    "more, said",
    [
        (["--speed", "2"], "--to-bus"),
        (["--to-bus", "--speed", "0"], "--speed"),
        (["--to-bus", "--speed", "nan"], "--speed"),
    ],
)
def test_what_cannot_be_meant_is_a_usage_error(voyage, more, said):
    done = subprocess.run([*TWIN, "replay", voyage, *more], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and said in done.stderr and len(done.stderr.strip().splitlines()) == 1


@pytest.mark.parametrize(
    "options, code",
    [
        (["{log}", "--speed", "0"], 2),
        (["--speed", "2", "--text"], 2),
        (["{log}", "--connect", "tcp/1.2.3.4:1"], 2),
        (["none.mcap"], 4),
        (["{log}"], 4),
        (["--connect", "nonsense"], 5),
        (["{ticks}", "--port", "99999"], 2),
    ],
)
def test_a_view_of_what_is_not_there_is_one_line(voyage, tmp_path, options, code):
    ticks = tmp_path / "ticks.mcap"
    if "{ticks}" in options:
        done = subprocess.run(
            [*TWIN, "replay", voyage, "--config", tmp_path / "twin.toml", "-o", ticks], timeout=120
        )
        assert done.returncode == 0
    words = [word.format(log=voyage, ticks=ticks) for word in options]
    done = subprocess.run(
        [*TWIN, "view", *words], cwd=tmp_path, capture_output=True, text=True, timeout=60, env=os.environ
    )
    assert done.returncode == code, done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_the_text_of_a_replayed_log_to_its_end(voyage, tmp_path):
    """Test: replay into a log, then view it in the terminal, fast. Expected: lines with mode, speeds and
    forces, marked as recorded; exit code 0."""
    ticks = tmp_path / "ticks.mcap"
    made = subprocess.run(
        [*TWIN, "replay", voyage, "--config", tmp_path / "twin.toml", "-o", ticks],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert made.returncode == 0, made.stderr
    done = subprocess.run(
        [*TWIN, "view", ticks, "--text", "--speed", "100"], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0 and "the log is over" in done.stderr
    first = done.stdout.splitlines()[0]
    assert (
        first.startswith("RECORDED") and "physics only" in first and "speed ahead" in first and "kn" in first
    )

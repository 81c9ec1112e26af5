"""The service as a process: it starts without a file, stops when told, and ends by itself when something
breaks."""

import itertools
import json
import os
import signal
import socket
import subprocess
import sys
import time

import pytest

from bench.endurance.killed_service import SERVE
from twin.live.demonstration import free_port
from twin.live.log.mcap_read import McapReader

STARTED: list[subprocess.Popen] = []


@pytest.fixture(autouse=True)
def no_process_is_left():
    yield
    for process in STARTED:
        if process.poll() is None:
            process.kill()
            process.wait()
    STARTED.clear()


def popen(*words, **how):
    STARTED.append(subprocess.Popen(words, text=True, **how))
    return STARTED[-1]


@pytest.fixture
def place(tmp_path):
    """A folder with settings of its own: port, log, state."""
    (tmp_path / "twin.toml").write_text(
        "[loop]\nrate_hz = 20.0\npriority = 0\nlock_memory = false\n[bus]\nlisten = "
        f'"tcp/127.0.0.1:{free_port()}"\n'
        f'[log]\nfolder = "{tmp_path}/logs"\n[state]\nfolder = "{tmp_path}/state"\n'
    )
    return tmp_path


def start(place, *more, **env):
    command = [sys.executable, "-m", "twin.cli", "run", "--config", str(place / "twin.toml"), *more]
    return popen(*command, stderr=subprocess.PIPE, env=os.environ | env)


def started(process):
    """Waits for the greeting."""
    line = process.stderr.readline()
    assert "KVLCC2" in line, line
    return line


def ticks(place):
    from twin.live.keelson import messages

    path = max((place / "logs").glob("*.mcap"))
    return [
        messages.Tick.FromString(m.data)
        for m in McapReader(path).messages()
        if m.type_name == "shiptwin.Tick"
    ]


def test_C7_told_to_stop_it_finishes_cleanly_within_two_seconds(place):
    process = start(place)
    started(process)
    time.sleep(1.5)
    asked = time.monotonic()
    process.send_signal(signal.SIGTERM)
    assert process.wait(10.0) == 0
    assert time.monotonic() - asked < 2.0 * slowness()
    made = ticks(place)
    assert made[0].index == 0 and made[-1].index == len(made) - 1 > 10
    assert made[-1].mode == "starting"
    assert json.loads((place / "state" / "adaptation.json").read_text())["rows"]


def test_an_interrupt_says_so_in_the_exit_code(place):
    process = start(place)
    started(process)
    process.send_signal(signal.SIGINT)
    assert process.wait(10.0) == 130


def slowness():
    """How many times slower than it should be this machine is now (others may be busy on it)."""
    began = time.perf_counter()
    x = 0.0
    for i in range(100_000):
        x += i * 1.1
    return max(1.0, (time.perf_counter() - began) / 0.008)


def test_C4_an_uncaught_exception_ends_the_process_and_does_not_hang(place):
    """Test: a bug on the tenth tick, bus and log open. Expected: exit code not 0 within a second,
    traceback said."""
    hook = "if tick.index == 10: print('BROKEN', file=sys.stderr, flush=True); raise RuntimeError('planted')"
    process = popen(
        sys.executable, "-c", SERVE.format(hook=hook), str(place / "twin.toml"), stderr=subprocess.PIPE
    )
    while "BROKEN" not in process.stderr.readline():
        pass
    broke = time.monotonic()
    assert process.wait(20.0) == 1
    assert time.monotonic() - broke < 1.0 + 0.5 * slowness()
    assert "planted" in process.stderr.read()


def test_C2_a_stall_of_200_ms_is_counted_and_followed_by_no_burst(place):
    process = start(place)
    started(process)
    time.sleep(1.0)
    process.send_signal(signal.SIGSTOP)
    time.sleep(0.2)
    process.send_signal(signal.SIGCONT)
    time.sleep(0.6)
    process.terminate()
    process.wait(10.0)
    made = ticks(place)
    gaps = [b.time_s - a.time_s for a, b in itertools.pairwise(made)]
    assert max(gaps) > 0.15 and made[-1].overruns >= 2
    assert not [g for g in gaps if g < 0.02 and slowness() < 2.0]


def test_C3_the_watchdog_is_fed_after_good_steps_and_not_while_the_loop_hangs(place, tmp_path):
    """Test: a service manager's socket; the loop hangs at tick 20. Expected: READY, then WATCHDOG, then
    silence."""
    address = str(tmp_path / "notify")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(address)
        manager.settimeout(60.0)
        hook = "import time; time.sleep(60) if tick.index == 20 else None"
        command = sys.executable, "-c", SERVE.format(hook=hook), str(place / "twin.toml")
        popen(*command, stderr=subprocess.DEVNULL, env=os.environ | {"NOTIFY_SOCKET": address})
        heard = [manager.recv(1000).decode()]
        assert heard[0].startswith("READY=1\nSTATUS=")
        manager.settimeout(3.0)
        with pytest.raises(TimeoutError):
            while True:
                heard.append(manager.recv(1000).decode())
    assert sum(word == "WATCHDOG=1" for word in heard) >= 2
    assert any(word.startswith("STATUS=starting") for word in heard)


NO_SHIP, NO_RESIDUAL = '[ship]\nfile = "no_such_ship"\n', '[residual]\nfile = "no.onnx"\nrequired = true\n'
UNUSABLE = {"[loop]\nrate_hzz = 10\n": "line 2", NO_SHIP: "no_such_ship", NO_RESIDUAL: "no.onnx"}


@pytest.mark.parametrize("text, words", UNUSABLE.items())
def test_F1_M1_settings_that_cannot_be_used_end_it_with_exit_code_5_and_one_line(place, text, words):
    (place / "twin.toml").write_text(
        text + f'[bus]\nlisten = "tcp/127.0.0.1:{free_port()}"\n[log]\nfolder = ""\n'
    )
    process = start(place)
    assert process.wait(30.0) == 5
    said = process.stderr.read()
    assert words in said and len(said.strip().splitlines()) == 1


def test_M13_a_residual_of_another_ship_that_was_asked_for_ends_it(place):
    from twin.live.learning.residual import bundled
    from twin.physics.ship import load

    path = bundled(load("kvlcc2"))
    (place / "twin.toml").write_text(
        f'[ship]\nfile = "usv"\n[residual]\nfile = "{path}"\n[bus]\nlisten = '
        f'"tcp/127.0.0.1:{free_port()}"\n[log]\nfolder = ""\n'
    )
    process = start(place)
    assert process.wait(30.0) == 5 and "made for the ship 'KVLCC2'" in process.stderr.read()


def test_the_example_settings_can_be_printed():
    done = subprocess.run(
        [sys.executable, "-m", "twin.cli", "run", "--example-config"],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0 and done.stdout.startswith("[ship]\n")


def test_health_hears_the_twin_and_says_when_it_does_not(place):
    process = start(place)
    started(process)
    health = [sys.executable, "-m", "twin.cli", "health", "--config", str(place / "twin.toml"), "--json", "-"]
    done = subprocess.run(health, capture_output=True, text=True, timeout=60)
    told = json.loads(done.stdout)
    assert done.returncode == 1 and told["mode"] == "starting" and "waiting for heading" in told["text"]
    process.terminate()
    process.wait(10.0)
    done = subprocess.run([*health[:-2], "--timeout", "0.5"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "not heard" in done.stdout


@pytest.mark.parametrize(
    "words, code",
    (
        (["run", "--duration", "-3"], 2),
        (["health", "--timeout", "0"], 2),
        (["health", "--timeout", "0.2", "--json", "nowhere/x.json"], 1),
    ),
)
def test_what_cannot_be_meant_or_written_is_one_line(words, code, tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "twin.cli", *words], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == code and done.stderr.count("\n") == 1 and words[-1] in done.stderr


def test_N6_the_service_waits_for_a_port_that_is_taken_and_runs_meanwhile(place):
    """Test: something else listens on the bus's port. Expected: it ticks and says why nobody hears it; heard
    once the port is free."""
    port = int((place / "twin.toml").read_text().partition("127.0.0.1:")[2].partition('"')[0])
    health = [
        sys.executable,
        "-m",
        "twin.cli",
        "health",
        "--config",
        str(place / "twin.toml"),
        "--timeout",
        "10",
    ]
    with socket.socket() as taken:
        taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        taken.bind(("127.0.0.1", port))
        taken.listen()
        process = start(place)
        assert "in use" in started(process)
        time.sleep(1.5)
        assert process.poll() is None
    done = subprocess.run(health, capture_output=True, text=True, timeout=60)
    assert "starting" in done.stdout
    process.terminate()
    assert process.wait(10.0) == 0
    assert any("in use" in reason for tick in ticks(place) for reason in tick.reasons)


@pytest.mark.parametrize(
    "text",
    (
        '[bus]\nlisten = "nonsense"\n',
        '[bus]\nlisten = "tcp/127.0.0.1:99999"\n',
        "[loop]\nrate_hz = 1" + "0" * 400 + "\n",
    ),
)
def test_F1_places_and_numbers_that_can_never_be_end_it_with_exit_code_5_and_one_line(place, text):
    (place / "twin.toml").write_text(text + '[log]\nfolder = ""\n')
    process = start(place)
    assert process.wait(30.0) == 5
    assert len(process.stderr.read().strip().splitlines()) == 1


def test_N5_a_second_twin_on_the_same_state_folder_is_refused(place):
    first = start(place)
    started(first)
    (place / "other.toml").write_text(
        f'[bus]\nlisten = "tcp/127.0.0.1:0"\n[log]\nfolder = ""\n[state]\nfolder = "{place}/state"\n'
    )
    command = [sys.executable, "-m", "twin.cli", "run", "--config", str(place / "other.toml")]
    second = popen(*command, stderr=subprocess.PIPE)
    assert second.wait(30.0) == 1
    said = second.stderr.read()
    assert "another twin" in said and len(said.strip().splitlines()) == 1
    first.kill()
    first.wait()
    third = popen(*command, stderr=subprocess.PIPE)
    started(third)

"""The systemd units: they parse, say what the design demands, and leave little of the computer open."""

import configparser
import shutil
import subprocess
from pathlib import Path

import pytest

from twin.errors import SettingsError

DEPLOY = Path(__file__).parents[2] / "deploy"
UNITS = ("shiptwin.service", "shiptwin-alarm@.service")
MAX_EXPOSURE = 0.9

missing = not shutil.which("systemd-analyze")
needs_systemd = pytest.mark.skipif(missing, reason="systemd-analyze is not installed")


def unit(name):
    parser = configparser.RawConfigParser(strict=False, comment_prefixes="#", delimiters="=")
    parser.optionxform = str
    parser.read_string((DEPLOY / name).read_text())
    return parser


@needs_systemd
@pytest.mark.parametrize("name", UNITS)
def test_exposure_is_at_most_0_9(name, tmp_path):
    """Test: `systemd-analyze security`. Expected: overall exposure of each unit <= 0.9 (threshold: 9)."""
    shutil.copy(DEPLOY / name, tmp_path)
    command = [
        "systemd-analyze",
        "security",
        "--offline=true",
        "--no-pager",
        f"--threshold={MAX_EXPOSURE * 10:.0f}",
    ]
    done = subprocess.run([*command, tmp_path / name], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr


@needs_systemd
@pytest.mark.parametrize("name", UNITS)
def test_systemd_knows_every_setting(name, tmp_path):
    """Expected: nothing but the programs that are not installed here is complained about."""
    shutil.copy(DEPLOY / name, tmp_path / name.replace("@", "@x"))
    done = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", tmp_path / name.replace("@", "@x")],
        capture_output=True,
        text=True,
    )
    mine = [line for line in done.stderr.splitlines() if "shiptwin" in line and "not executable" not in line]
    assert not mine


def test_the_service_is_watched_restarted_and_bounded():
    service = unit("shiptwin.service")["Service"]
    assert service["Type"] == "notify"
    assert float(service["WatchdogSec"]) <= 2.0
    assert service["Restart"] == "on-failure"
    assert service["CPUSchedulingPolicy"] == "fifo"
    assert service["LimitCORE"] == "0"
    assert int(service["MemoryMax"].rstrip("M")) <= 128


def test_settings_that_are_wrong_are_not_tried_again():
    final = unit("shiptwin.service")["Service"]["RestartPreventExitStatus"].split()
    assert str(SettingsError.exit_code) in final


def test_a_crash_loop_ends_in_an_alarm():
    section = unit("shiptwin.service")["Unit"]
    assert section["OnFailure"] == "shiptwin-alarm@%n.service"
    assert int(section["StartLimitBurst"]) <= 5 and int(section["StartLimitIntervalSec"]) <= 300


def test_the_alarm_says_what_failed_and_calls_the_owners_program(tmp_path):
    hook = tmp_path / "on-alarm"
    hook.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/called\n')
    hook.chmod(0o755)
    env = {"RUNTIME_DIRECTORY": str(tmp_path), "SHIPTWIN_ON_ALARM": str(hook), "PATH": "/usr/bin:/bin"}
    done = subprocess.run([DEPLOY / "alarm.sh", "shiptwin.service"], env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "shiptwin.service has failed" in (tmp_path / "alarm").read_text()
    assert (tmp_path / "called").read_text().strip() == "shiptwin.service"

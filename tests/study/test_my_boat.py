"""The tutorial "my boat": every command as it stands, in order; on a real boat's logs where they are at hand,
else on simulated ones."""

import io
import json
import os
import re
import shlex
import subprocess
import sys
from contextlib import chdir, redirect_stderr
from pathlib import Path

import pytest

from tests.thorough import thorough
from twin import cli
from twin.physics.ship import load

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "tutorials" / "my-boat.md"
REAL = Path(os.environ.get("SHIPTWIN_DATA", "")) / "blueboat"
RUNS = {"run1": 220, "run2": 216, "run3": 230, "held": 228, "later": 223}
ROWS = 600  # at most, of a real run: a minute, in which the boat sails a hundred lengths


def steps():
    """Of the page in order: (file, its text), or (None, command)."""
    for kind, block in re.findall(r"```(toml|sh)\n(.*?)```", PAGE.read_text(), re.S):
        if kind == "toml":
            yield block.split("\n", 1)[0].removeprefix("# "), block
        else:
            yield from ((None, line) for line in block.splitlines())


def done(program, words, folder):
    """(exit code, what it said) of a command in that folder."""
    if program == "twin":
        with chdir(folder), redirect_stderr(io.StringIO()) as said:
            return cli.main(words), said.getvalue()
    env = os.environ | {"PYTHONPATH": str(ROOT)}
    ended = subprocess.run([sys.executable, *words], cwd=folder, capture_output=True, text=True, env=env)
    return ended.returncode, ended.stderr


pytestmark = thorough


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the whole page was done."""
    path = tmp_path_factory.mktemp("boat")
    real = "SHIPTWIN_DATA" in os.environ and REAL.is_dir()
    for name, text in steps():
        if name:
            (path / name).write_text(text)
            continue
        command, _, expected = text.partition("  # exit code ")
        program, *words = shlex.split(command)
        if program == "python" and real:
            run = words[words.index("--csv") + 1]
            rows = (REAL / f"fixed_00000{RUNS[run.removesuffix('.csv')]}.csv").read_text().splitlines(True)
            (path / run).write_text("".join(rows[: ROWS + 1]))
            continue
        code, said = done(program, words, path)
        assert code == int(expected or 0), f"{command}\n{said[-800:]}"
        if expected:
            (path / "refused.txt").write_text(said)
    return path


def test_exchanged_sides_are_refused_by_name(folder):
    assert "port and starboard are exchanged, that is believed" in (folder / "refused.txt").read_text()


def test_the_stop_of_the_controllers_is_read_from_where_the_boat_lies_still(folder):
    checks = json.loads((folder / "run1.json").read_text())["data_checks"]
    (zero,) = [c for c in checks if c["check"] == "actuator_zero"]
    assert not zero["ok"] and re.search(
        r"zero = 0\.0[23]\d* for port, 0\.0[23]\d* for starboard", zero["text"]
    )


def test_the_calibrated_boat_is_nearer_and_its_thrusters_are_alike(folder):
    said = json.loads((folder / "calibrate.json").read_text())
    first = said["held_out"][0]
    assert said["accepted"] and first["position_m"] < 0.9 * first["before_m"]
    gains = [float(a.gain) for a in load(folder / "calibrated.toml").actuators]
    assert max(gains) < 2.0 * min(gains)


def test_on_a_run_with_nothing_wrong_nothing_is_said_to_be_missing(folder):
    said = json.loads((folder / "later.json").read_text())
    assert said["verdict"] != "missing" and said["missing"] == []


def test_the_proposed_map_names_both_thrusters(folder):
    text = (folder / "proposed.toml").read_text()
    assert '"port.pwm_us" = "thr_left"' in text and '"starboard.pwm_us" = "thr_right"' in text
    assert 'unit = "rad/s"' in text and "NOT FOUND" not in text

"""A ship of actuators on board: the loop does not take it, and says so in one line."""

import subprocess
import sys

import numpy as np
import pytest

from twin.physics.ship import from_table, load, save, to_table
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage

PORT = {"name": "port", "kind": "fixed_thruster", "channels": ["command"], "ahead_n": 50.0, "astern_n": 25.0}


@pytest.fixture
def files(tmp_path):
    """A small craft with a thruster, and 30 s of it."""
    save(from_table(to_table(load("usv")) | {"actuators": [PORT]}), tmp_path / "ship.toml")
    t = np.arange(0.0, 30.0, 0.5)
    columns = {"north_m": 1.2 * t, "east_m": 0.0 * t, "heading_true_north_deg": 0.0 * t}
    columns["port.command"] = np.full(t.size, 0.4)
    write_voyage(Voyage("thirty seconds", t, columns), tmp_path / "voyage.mcap")
    return tmp_path


@pytest.mark.parametrize("words", [("run", "--duration", "2"), ("replay", "voyage.mcap", "-o", "said.mcap")])
def test_the_loop_refuses_a_ship_of_actuators_in_one_line(files, words):
    """Expected: exit code 5, one line that names the file and what can be done, and no log."""
    done = subprocess.run(
        [sys.executable, "-m", "twin", *words, "--ship", "ship.toml"],
        cwd=files, capture_output=True, text=True, timeout=60.0, check=False,
    )  # fmt: skip
    assert done.returncode == 5, done.stderr
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1
    assert "ship.toml" in lines[0] and "[[actuators]]" in lines[0] and "twin calibrate" in lines[0]
    assert not (files / "said.mcap").exists()

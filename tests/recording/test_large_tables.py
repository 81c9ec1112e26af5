"""A large table is imported in memory that its size bounds."""

import subprocess
import sys

import numpy as np
import pytest

from tests.thorough import thorough

COLUMNS = ("north_m", "east_m", "heading_true_north_deg", "surge_velocity_mps", "sway_velocity_mps",
           "yaw_rate_degps", "rudder_angle_deg", "propeller_rate_rpm")  # fmt: skip
CHILD = """
import sys
from pathlib import Path
from twin.recording.read import read_voyage
def high_kb():
    return int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0])
before = high_kb()
voyage = read_voyage(Path(sys.argv[1]))
print(len(voyage), high_kb() - before)
"""
MB = 60


def written(path, separator, point):
    """A zigzag at 10 Hz, until the file is that large."""
    with open(path, "w", encoding="ascii") as out:
        out.write(separator.join(("time_s", *COLUMNS)) + "\n")
        t, rows = np.arange(20_000) * 0.1, 0
        tail = np.column_stack(
            [7.0 * t, np.sin(t), 45 + 20 * np.sin(t / 60), 7 + 0.05 * np.sin(3 * t), 0.05 * np.cos(t),
             0.33 * np.cos(t / 60), 10 * np.cos(t / 60), 100 + 0 * t]
        )  # fmt: skip
        cells = [separator.join(f"{x:.6f}" for x in row).replace(".", point) for row in tail]
        while out.tell() < MB << 20:
            out.write(
                "".join(
                    f"{0.1 * (rows + i):.1f}".replace(".", point) + f"{separator}{cell}\n"
                    for i, cell in enumerate(cells)
                )
            )
            rows += len(cells)
    return rows


@pytest.mark.parametrize(
    "separator, point",
    [
        pytest.param(",", ".", id="the quick reader"),
        pytest.param(";", ",", id="the careful one", marks=thorough),
    ],
)
def test_R15_a_table_of_60_megabytes_takes_no_more_than_four_times_its_size(tmp_path, separator, point):
    """Test: 60 MB of CSV, with points and with decimal commas, read by a process that tells its own peak.
    Expected: every row, and at most four times the file's size above what was there before."""
    rows = written(tmp_path / "large.csv", separator, point)
    done = subprocess.run(
        [sys.executable, "-c", CHILD, tmp_path / "large.csv"], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    read, peak_kb = map(int, done.stdout.split())
    assert read == rows
    assert peak_kb / 1024 <= 4 * MB, f"{peak_kb / 1024:.0f} MB"

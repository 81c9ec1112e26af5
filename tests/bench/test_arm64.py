"""The same log on arm64, under an emulator; skipped where its root was not made (bench/arm64/root.sh)."""

import os
from pathlib import Path

import pytest

from bench.arm64.run import SHIPS, apart, compared, page
from bench.cli import main

ROOT = os.environ.get("SHIPTWIN_ARM64")
needs_root = pytest.mark.skipif(
    not ROOT, reason="SHIPTWIN_ARM64 is not set: sh bench/arm64/root.sh FOLDER makes an arm64 Python"
)


@needs_root
@pytest.mark.parametrize("ship", ("container", "usv"))
def test_C12_a_replay_on_arm64_gives_the_same_numbers_to_the_last_digit(ship):
    """Test: ten seconds of a log here and on an emulated Cortex-A72. Expected: no digit differs."""
    (row,) = compared(Path(ROOT).resolve(), 10.0, {ship: SHIPS[ship]})
    assert row.ticks > 90 and row.here == row.there and set(row.apart.values()) == {0.0}
    assert "| yes | 0 |" in page([row], 10.0, "Python")


def test_a_difference_in_the_last_digit_of_one_number_is_seen():
    here = ["0.1 2.0 3.0 4.0 5.0 6.0", "0.1 2.0 3.0 4.0 5.0 6.0"]
    there = [here[0], "0.1 2.0 3.0 4.0 5.0 6.000000000000001"]
    found = apart(here, there)
    assert found.pop("rate of turn [rad/s]") > 0.0 and set(found.values()) == {0.0}


def test_a_folder_without_an_arm64_python_is_said_in_one_line(tmp_path, capsys):
    assert main(["arm64", "--root", str(tmp_path)]) == 4
    said = capsys.readouterr().err.strip()
    assert "root.sh" in said and "\n" not in said

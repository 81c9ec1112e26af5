"""The long arrays of a ship file stand in a file beside it, and neither is read without the other."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import twin
from twin.errors import SettingsError
from twin.physics import ship as ships
from twin.physics.ship_arrays import LONG

LONG_ARRAY = [[0.1 * i + j for j in range(6)] for i in range(6)]


@pytest.fixture
def calibrated():
    """A ship with a covariance and a short list, as a calibration leaves them."""
    ship = ships.load("kvlcc2")
    return replace(
        ship, notes=dict(ship.notes) | {"structural": {"covariance": LONG_ARRAY, "share": [0.1, 0.2]}}
    )


def beside(path):
    return sorted(p for p in path.parent.iterdir() if p.suffix == ".json")


def test_a_calibrated_ship_comes_back_the_same_and_no_line_of_its_file_is_long(calibrated, tmp_path):
    path = tmp_path / "alma.toml"
    ships.save(calibrated, path)
    assert ships.load(path).notes["structural"] == calibrated.notes["structural"]
    lines = path.read_text().splitlines()
    assert "share = [0.1, 0.2]" in lines and not any(line.startswith("covariance") for line in lines)
    assert json.loads(beside(path)[0].read_text()) == {"structural.covariance": LONG_ARRAY}
    assert sum(len(row) for row in LONG_ARRAY) >= LONG


def test_what_was_written_over_leaves_no_arrays_behind(calibrated, tmp_path):
    path = tmp_path / "alma.toml"
    ships.save(calibrated, path)
    (first,) = beside(path)
    other = replace(
        calibrated, notes=dict(calibrated.notes) | {"structural": {"covariance": LONG_ARRAY[::-1]}}
    )
    ships.save(other, path)
    (second,) = beside(path)
    assert first != second and ships.load(path).notes["structural"]["covariance"] == LONG_ARRAY[::-1]
    ships.save(other, path)
    assert beside(path) == [second]
    ships.save(replace(other, notes={}), path)
    assert beside(path) == [] and "structural" not in ships.load(path).notes


@pytest.mark.parametrize("damage", ["gone", "changed", "named elsewhere"])
def test_arrays_that_are_gone_or_changed_are_one_clear_line(calibrated, tmp_path, damage):
    path = tmp_path / "alma.toml"
    ships.save(calibrated, path)
    (arrays,) = beside(path)
    if damage == "gone":
        arrays.unlink()
    elif damage == "changed":
        arrays.write_text(arrays.read_text().replace("0.1", "0.2", 1))
    else:
        path.write_text(path.read_text().replace(f'file = "{arrays.name}"', f'file = "../{arrays.name}"'))
    with pytest.raises(SettingsError, match="again") as refused:
        ships.load(path)
    assert str(refused.value).startswith(str(tmp_path)) and "\n" not in str(refused.value)


def test_the_loop_needs_no_arrays(calibrated, tmp_path):
    path = tmp_path / "alma.toml"
    ships.save(calibrated, path)
    beside(path)[0].unlink()
    assert ships.load(path, arrays=False).derivatives == calibrated.derivatives


def test_a_file_of_an_earlier_version_is_read_as_it_is_and_a_line_says_so(calibrated, tmp_path, caplog):
    path = tmp_path / "old.toml"
    path.write_text(ships.text(ships.to_table(calibrated)))
    old = ships.load(path)
    assert old.notes["structural"]["covariance"] == LONG_ARRAY
    (line,) = caplog.messages
    assert str(path) in line and "earlier version" in line and "\n" not in line
    caplog.clear()
    ships.save(old, path)
    assert ships.load(path).notes["structural"]["covariance"] == LONG_ARRAY and not caplog.messages


def test_a_verb_says_that_a_ship_file_is_of_an_earlier_version(calibrated, tmp_path):
    """Expected: one line on standard error, and what the verb was asked for."""
    path = tmp_path / "old.toml"
    path.write_text(ships.text(ships.to_table(calibrated)))
    verb = [sys.executable, "-m", "twin", "history", str(path)]
    done = subprocess.run(verb, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout
    assert done.stderr.count("\n") == 1 and "earlier version" in done.stderr


def test_no_line_of_a_bundled_ship_file_is_long():
    """Expected: each line can be read, and no bundled file is of the old form."""
    folder = Path(twin.__file__).parent
    files = sorted([*(folder / "ships").glob("*.toml"), *(folder / "voyages").glob("*.toml")])
    assert "tanker.toml" in [path.name for path in files]
    long = {path.name for path in files for line in path.read_text().splitlines() if len(line) > 1000}
    assert not long


@pytest.mark.parametrize("notes", [{}, {"structural": {"covariance": LONG_ARRAY}}])
def test_a_ship_shows_itself_in_one_short_line(calibrated, notes):
    ship = replace(calibrated, notes=notes)
    words = "calibrated>" if notes else "not calibrated>"
    assert repr(ship).startswith(f"<Ship {ship.name!r}: 320 m, ") and repr(ship).endswith(f", {words}")
    assert len(repr(ship)) < 200

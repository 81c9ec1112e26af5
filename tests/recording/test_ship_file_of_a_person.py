"""A person's ship file through the verbs that write it: comments and order stay, numbers change where they
stand."""

import os
import subprocess
import sys
import tomllib

import pytest

from twin.cli import main
from twin.physics.effects import find
from twin.physics.ship import load, text, to_table
from twin.recording.ship_file_writer import kept, save

PERSONS = """# Alma, as the yard told us on 3 May
name = "Alma"  # call sign WXYZ
schema_version = 1

[effects.RudderOffset]  # seen in the dock
offset = { value = 0.02, unit = "rad" }  # 1.146 deg, by the second mate

[particulars]
B = { value = 58.0, unit = "m", source = "tape" }
L_pp = { value = 320, unit = "m" }  # not overall
"""


@pytest.fixture
def alma(tmp_path):
    """A file with a person's words, in a person's order; the numbers are those of the bundled tanker."""
    plain = text(to_table(load("kvlcc2"))).splitlines()
    start = plain.index("[particulars]")
    rest = [line for line in plain[start + 1 :] if not line.startswith(("B =", "L_pp ="))]
    path = tmp_path / "alma.toml"
    path.write_text(PERSONS + "\n".join(rest) + "\n")
    return path


def test_a_file_of_which_nothing_changes_is_the_same_to_the_byte(alma, tmp_path):
    save(load(alma), tmp_path / "again.toml", alma)
    assert (tmp_path / "again.toml").read_text() == alma.read_text()


def test_an_effect_that_is_added_has_its_own_lines_and_the_others_stand_where_they_stood(alma, tmp_path):
    better, ship = tmp_path / "better.toml", load(alma)
    ship = ship.with_effects(find("Wind").plausible(ship))
    save(ship, better, alma)
    was, now = alma.read_text().splitlines(), better.read_text().splitlines()
    at = now.index("[effects.Wind]")
    entries = len(find("Wind").params())
    assert [line for line in now[:at] + now[at + 1 + entries :] if line] == [line for line in was if line]
    assert to_table(load(better)) == to_table(ship)


def test_a_number_that_changes_keeps_its_comment_and_its_degrees_follow(alma, tmp_path):
    """Test: an offset of 0.02 rad becomes 0.05. Expected: the line's words stay, 1.146 deg become 2.865."""
    ship = load(alma)
    turned = ship.without_effects("RudderOffset").with_effects(
        find("RudderOffset").plausible(ship).but(offset=0.05)
    )
    save(turned, tmp_path / "turned.toml", alma)
    lines = (tmp_path / "turned.toml").read_text().splitlines()
    assert 'offset = { value = 0.05, unit = "rad" }  # 2.865 deg, by the second mate' in lines
    assert "[effects.RudderOffset]  # seen in the dock" in lines
    assert len(lines) == len(alma.read_text().splitlines())


def test_an_effect_that_is_removed_takes_its_lines_and_no_others(alma, tmp_path):
    without = tmp_path / "without.toml"
    assert main(["remove", "RudderOffset", "--ship", str(alma), "-o", str(without)]) == 0
    said = without.read_text()
    assert "RudderOffset]" not in said and "2 deg" not in said
    for words in (
        "as the yard told us on 3 May",
        "call sign WXYZ",
        "# not overall",
        "L_pp = { value = 320, unit",
    ):
        assert words in said
    assert tomllib.loads(said)["history"][-1]["removed"] == ["RudderOffset"]
    assert main(["remove", "RudderOffset", "--ship", str(without), "-o", str(tmp_path / "c.toml")]) == 5


def test_a_bare_number_of_an_old_file_stays_bare(alma, tmp_path):
    alma.write_text(alma.read_text().replace('L_pp = { value = 320, unit = "m" }', "L_pp = 320"))
    save(load(alma), tmp_path / "again.toml", alma)
    assert "L_pp = 320  # not overall" in (tmp_path / "again.toml").read_text()


@pytest.mark.parametrize("before", ["", "no = toml = at all", "a = 1"])
def test_where_nothing_can_be_kept_the_plain_text_is_written(before):
    assert kept(before, to_table(load("kvlcc2"))) == ""


def test_an_angle_has_its_degrees_beside_it(tmp_path):
    ship = load("kvlcc2")
    gyro = find("GyroBias").plausible(ship).but(bias=0.001)
    ship.with_effects(find("HeadingBias").plausible(ship), gyro).save(tmp_path / "a.toml")
    said = (tmp_path / "a.toml").read_text()
    assert 'bias = { value = 0.001, unit = "rad/s" }  # 0.0573 deg/s' in said
    assert said.count(" deg\n") >= 1 and load(tmp_path / "a.toml").effects


def test_it_is_written_without_tomlkit_too(alma, tmp_path):
    """Test: a process in which tomlkit cannot be imported. Expected: the ship, in the plain text."""
    out = tmp_path / "b.toml"
    code = f"""
import sys
sys.modules["tomlkit"] = None
from twin.cli import main
sys.exit(main(["remove", "RudderOffset", "--ship", {str(alma)!r}, "-o", {str(out)!r}]))
"""
    done = subprocess.run([sys.executable, "-c", code], env=os.environ, capture_output=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "call sign" not in out.read_text() and not load(out).effects

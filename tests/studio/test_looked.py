"""A file looked at before it is imported: what is wrong with its map, or with the ship file, is said."""

import pytest

from twin.studio.looked import looked
from twin.studio.project import Project


@pytest.fixture
def folder(tmp_path):
    Project(tmp_path).take_demo()
    (tmp_path / "job").mkdir()
    return tmp_path


def test_a_ship_file_that_is_not_valid_is_said_and_left_out(folder):
    """Expected: the voyage is looked at all the same, by the checks that need no ship."""
    (folder / "half.toml").write_text('name = "Half"\n\n[particulars]\n')
    told = looked(folder, "monday.mcap", None, "half.toml", folder / "job")
    assert told["problem"] is None and told["rows"] > 100
    assert any("half.toml" in note and "without the ship" in note for note in told["notes"])
    whole = looked(folder, "monday.mcap", None, "tanker.toml", folder / "job")
    assert not any("without the ship" in note for note in whole["notes"])


def test_a_map_that_is_no_text_in_utf_8_is_a_sentence(folder):
    (folder / "log.csv").write_text("t,R\n0,1\n1,2\n")
    (folder / "log-map.toml").write_bytes(b'[columns]\nrudder_angle_deg = "Ruderlage \xb0"\n')
    told = looked(folder, "log.csv", "log-map.toml", None, folder / "job")
    assert told["problem"].startswith("log-map.toml: is no text in UTF-8")

"""The files of a project: names, tags, and the bundled voyages."""

import os
import tomllib

import pytest

from twin.errors import SettingsError
from twin.studio.project import Project


@pytest.mark.parametrize("name", ["project.toml", "jobs"])
def test_no_file_takes_a_name_of_the_projects_own(tmp_path, name):
    """Test: a ship saved as project.toml was not listed, and the next tag was written over it."""
    with pytest.raises(SettingsError, match="is the project's own"):
        Project(tmp_path).new(name)


@pytest.mark.parametrize("name", ["🚢.csv", "a\x7fb.csv", 'quoted ".csv', "été.mcap"])
def test_a_tag_is_read_back_whatever_letters_are_in_a_name(tmp_path, name):
    (tmp_path / name).write_text("time_s\n0\n")
    Project(tmp_path).tag(name, "reference")
    assert Project(tmp_path).tags() == {name: "reference"}
    assert tomllib.loads((tmp_path / "project.toml").read_text(encoding="utf-8"))["tags"]


def test_a_file_whose_name_is_no_text_is_left_out(tmp_path):
    """Test: a name in Latin-1, from an old disk. Expected: the others are listed, and it is refused in one line."""
    (tmp_path / "a.csv").write_text("time_s\n0\n")
    with open(os.fsencode(tmp_path) + b"/f\xe9vrier.csv", "wb") as file:
        file.write(b"time_s\n0\n")
    project = Project(tmp_path)
    assert [row["name"] for row in project.listing()] == ["a.csv"]
    with pytest.raises(SettingsError, match="is no name of a file here"):
        project.existing("f\udce9vrier.csv")


def test_the_demo_taken_again_leaves_a_tag_as_its_owner_set_it(tmp_path):
    project = Project(tmp_path)
    assert "tuesday.mcap" in project.take_demo() and project.tags() == {"tuesday.mcap": "held_out"}
    project.tag("tuesday.mcap", "voyage")
    assert project.take_demo() == [] and project.tags() == {"tuesday.mcap": "voyage"}

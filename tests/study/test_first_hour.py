"""The tutorial "my ship's first hour": every command as it stands, in order, and the story it promises."""

import json
import re
import shlex
from contextlib import chdir
from pathlib import Path

import pytest

import bench.cli
import twin.cli
from tests.thorough import thorough
from twin.physics.ship import load

PAGE = Path(__file__).parents[2] / "docs" / "tutorials" / "first-hour.md"
COMMANDS = [
    line for block in re.findall(r"```sh\n(.*?)```", PAGE.read_text(), re.S) for line in block.splitlines()
]
PROGRAMS = {"twin": twin.cli.main, "twin-bench": bench.cli.main}

pytestmark = thorough


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the whole hour was sailed."""
    path = tmp_path_factory.mktemp("alma")
    with chdir(path):
        for command in COMMANDS:
            program, *words = shlex.split(command)
            assert PROGRAMS[program](words) == 0, command
    return path


def test_june_is_explained_by_fouling(folder):
    said = json.loads((folder / "june.json").read_text())
    assert said["verdict"] == "missing" and said["missing"] == ["HullFouling"]


def test_the_page_is_there_and_needs_no_network(folder):
    page = (folder / "june.html").read_text()
    assert "HullFouling" in page and 'src="http' not in page


def test_the_corrected_ship_holds_the_effect_and_its_history(folder):
    ship = load(folder / "alma3.toml")
    assert "HullFouling" in {type(e).__name__ for e in ship.effects}
    assert ship.notes["history"]

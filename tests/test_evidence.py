"""The evidence page: every test, fault, page and file that it names exists, and no answer stands alone."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "evidence.md").read_text()
FAULTS = tomllib.loads((ROOT / "docs" / "faults.toml").read_text())
ANSWERS = ("met", "partly", "not met", "the ship's", "does not apply, because")
ROWS = [
    [cell.strip() for cell in line.strip("|").split(" | ")]
    for line in PAGE.splitlines()
    if line.startswith("|") and "what is asked" not in line and not line.startswith("|---")
]


def exists(named):
    """Whether a fault with tests, a file, or a test of a file of that name is there."""
    if re.fullmatch(r"[A-Z]\d+", named):
        return bool(FAULTS.get(named, {}).get("tests"))
    path, _, test = named.partition("::")
    file = ROOT / path
    return file.is_file() and (not test or f"def {test}(" in file.read_text())


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[1][:40])
def test_every_answer_is_one_of_five_and_stands_beside_what_can_be_looked_up(row):
    assert len(row) == 4, "clause | what is asked | answer | where"
    assert row[2].startswith(ANSWERS)
    links = re.findall(r"\]\(([^)#]+)", row[3])
    named = re.findall(r"`([^`]+)`", row[3])
    assert links or named
    assert not [name for name in named if not exists(name)]
    assert not [link for link in links if not (ROOT / "docs" / link).is_file()]


def test_what_is_not_met_says_so():
    """Expected: a page that admits something, for each of the rules that were read."""
    assert sum(row[2].startswith("not met") for row in ROWS) >= 5
    assert sum(row[2].startswith("partly") for row in ROWS) >= 10
    for rule in ("E26", "E27", "61162-460", "A204", "19847", "19848", "23247"):
        assert re.search(rf"^##.*{rule}", PAGE, re.M), rule


def test_a_name_that_is_not_there_is_found():
    assert exists("Q3") and not exists("Q99") and not exists("R0")
    assert exists("deploy/sbom.json") and not exists("deploy/none.json")
    assert not exists("tests/test_evidence.py::test_that_is_none")

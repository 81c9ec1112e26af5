"""The table of faults: every row is injected by the test it names."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
ROWS = re.findall(r"^\| ([A-Z]\d+) \|.*\| (.+) \|$", (ROOT / "docs" / "faults.md").read_text(), re.M)
TESTS = "".join(path.read_text() for path in (ROOT / "tests").rglob("test_*.py"))


@pytest.mark.parametrize("fault, named", ROWS)
def test_every_fault_in_the_table_is_injected_by_the_test_it_names(fault, named):
    for name in re.findall(r"`(\w+)`", named):
        assert f"_{fault}_" in name and f"def {name}(" in TESTS
    assert "`test_" in named


def test_the_table_is_read():
    assert len(ROWS) > 30

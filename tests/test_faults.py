"""The one table of faults (docs/faults.toml): every named fault is there, and is injected by tests that
exist."""

import ast
import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
spec = importlib.util.spec_from_file_location("faults_page", ROOT / "docs" / "faults_page.py")
faults_page = importlib.util.module_from_spec(spec)
spec.loader.exec_module(faults_page)
FAULTS = faults_page.table()
NAMED = {"I": 28, "M": 13, "C": 12, "S": 8, "N": 8, "F": 4, "Q": 10, "R": 19}  # how many have been named
MOST_OPEN = 0  # without a test; this number only falls


def names_in(path):
    """Names of the tests of a file."""
    return {
        node.name
        for node in ast.walk(ast.parse((ROOT / "tests" / path).read_text()))
        if isinstance(node, ast.FunctionDef)
    }


@pytest.fixture(scope="module")
def every():
    """Every test that there is, as the table names it."""
    return {
        f"{path.relative_to(ROOT / 'tests')}::{name}"
        for path in (ROOT / "tests").rglob("test_*.py")
        for name in names_in(path.relative_to(ROOT / "tests"))
    }


def test_every_fault_that_was_named_stands_in_the_table():
    assert list(FAULTS) == [
        f"{group}{number}" for group, many in NAMED.items() for number in range(1, many + 1)
    ]


@pytest.mark.parametrize("name", FAULTS)
def test_every_fault_has_an_answer_and_tests_that_exist(name, every):
    fault = FAULTS[name]
    assert fault["what"] and fault["expected"] and "alarm" in fault
    assert bool(fault["tests"]) != bool(fault.get("open")), "either tests, or why there are none"
    assert not [test for test in fault["tests"] if test not in every]


def test_every_test_that_bears_a_faults_name_stands_in_the_table(every):
    for test in every:
        if borne := re.search(r"::test_((?:[IMCSNFQR]\d+_)+)", test):
            for name in borne[1].split("_")[:-1]:
                assert name in FAULTS and test in FAULTS[name]["tests"], (
                    f"{test} is not under [{name}]: python docs/faults_page.py --take-in"
                )


def test_no_more_faults_are_without_a_test_than_there_were(capsys):
    still = {name: fault["open"] for name, fault in FAULTS.items() if fault.get("open")}
    with capsys.disabled():
        print(f"\n{len(still)} of {len(FAULTS)} faults have no test: {', '.join(still)}")
    assert len(still) <= MOST_OPEN


def test_the_page_is_made_of_the_table():
    assert (ROOT / "docs" / "faults.md").read_text() == faults_page.page(FAULTS), (
        "run: python docs/faults_page.py"
    )

"""docs/diagnosis.md says what the decision is made of."""

import importlib.util
import re
from pathlib import Path

import pytest

from twin.study.diagnosis import criteria
from twin.study.diagnosis.decision import RULES, VERDICTS

DOCS = Path(__file__).parents[3] / "docs"
spec = importlib.util.spec_from_file_location("decision_page", DOCS / "decision_page.py")
decision_page = importlib.util.module_from_spec(spec)
spec.loader.exec_module(decision_page)
PAGE = (DOCS / "diagnosis.md").read_text()


def test_the_tables_of_the_page_are_those_of_the_code():
    """Expected: equal to what `python docs/decision_page.py` writes."""
    assert decision_page.page(PAGE) == PAGE


@pytest.mark.parametrize("name", decision_page.TABLES)
def test_a_table_stands_in_the_page_once(name):
    assert PAGE.count(decision_page.TABLES[name]()) == 1


def test_every_verdict_is_given_for_a_reason_and_every_rule_gives_one_of_the_four():
    assert {rule.verdict for rule in RULES} == set(VERDICTS)


def test_every_number_that_decides_is_in_the_table():
    numbers = {name for name, value in vars(criteria).items() if isinstance(value, float)}
    assert numbers and numbers == set(re.findall(r"^\| `([A-Z]+)` \|", decision_page.constants(), re.M))

"""docs/results/cases.csv: a row a case, as recorded; the pages say what its rows say."""

import importlib.util
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
spec = importlib.util.spec_from_file_location("results_page", DOCS / "results_page.py")
results_page = importlib.util.module_from_spec(spec)
spec.loader.exec_module(results_page)
ROWS = results_page.read()


def test_every_recorded_answer_is_a_row_with_the_mark_that_its_benchmark_gives_it():
    """Expected: equal to what `python docs/results_page.py --take-in` writes."""
    assert results_page.taken_in() == ROWS


def test_the_page_of_cases_is_made_of_the_rows():
    assert results_page.CASES_PAGE.read_text() == results_page.cases_page(ROWS)


def test_the_table_before_and_after_is_made_of_the_rows():
    page = results_page.DECISION_PAGE.read_text()
    assert results_page.decision_page(page, ROWS) == page
    assert page.count(results_page.decisions(ROWS)) == 1


def test_a_row_that_is_turned_shows_on_both_pages():
    """Test: a right answer marked wrong. Expected: other text on the page of cases and in the table."""
    turned = [ROWS[0]._replace(right="wrong"), *ROWS[1:]]
    assert ROWS[0].right == "right"
    assert results_page.cases_page(turned) != results_page.cases_page(ROWS)
    assert results_page.decisions(turned) != results_page.decisions(ROWS)

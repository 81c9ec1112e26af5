"""docs/results/cases.csv and fleet.csv: a row an answer, as recorded; the pages say what their rows say."""

import csv
import importlib.util
import json
from dataclasses import asdict
from pathlib import Path

from bench.fleet import keep_answers, kept_rows
from bench.fleet.answer_score import right
from bench.fleet.fleet_figures import figures
from twin.study.diagnosis.facts import Facts

DOCS = Path(__file__).parents[1] / "docs"
spec = importlib.util.spec_from_file_location("results_page", DOCS / "results_page.py")
results_page = importlib.util.module_from_spec(spec)
spec.loader.exec_module(results_page)
ROWS, ANSWERS = results_page.read(), results_page.answers()


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


def test_the_page_on_the_judgement_is_made_of_the_fleets_answers():
    """Expected: down to what is written by hand, what `python docs/results_page.py` writes."""
    assert results_page.JUDGEMENT_PAGE.read_text() == results_page.judgement_page(ANSWERS)


def test_an_answer_of_the_fleet_bears_the_mark_that_its_score_gives_it():
    for table, facts in (keep_answers.FLEET, keep_answers.NEW_SHIPS):
        with table.open(newline="") as file:
            marks = [row["right"] == "right" for row in csv.DictReader(file)]
        assert marks == [right(row) for row in kept_rows.read(table, facts)]
        assert 0.5 < sum(marks) / len(marks) < 0.85


def test_an_answer_of_the_fleet_that_is_turned_shows_in_the_figures():
    """Test: a right name left out of one answer. Expected: one right single cause less on the page."""
    k = next(i for i, row in enumerate(ANSWERS) if row["kind"] == "single" and right(row))
    turned = [*ANSWERS[:k], {**ANSWERS[k], "missing": [], "weather": []}, *ANSWERS[k + 1 :]]
    name = "single cause named, alone and right"
    assert figures(turned)[name].k == figures(ANSWERS)[name].k - 1


def test_answers_of_the_fleet_that_are_read_and_written_again_are_the_same(tmp_path):
    """Expected: all that stands there; and the facts are whole, so that a decision can be made again."""
    table, facts = tmp_path / "fleet.csv", tmp_path / "facts.jsonl"
    kept_rows.write(ANSWERS, table, facts)
    assert table.read_bytes() == keep_answers.FLEET[0].read_bytes()
    once, twice = (path.read_text().splitlines() for path in (keep_answers.FLEET[1], facts))
    assert list(map(json.loads, once)) == list(map(json.loads, twice))
    of = Facts.read(ANSWERS[0]["facts"])
    assert asdict(of)["causes"][0]["effect"] == "TowForce" and of.explanation == (
        "TowForce",
        "VaryingCurrent",
    )

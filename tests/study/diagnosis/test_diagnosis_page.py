"""docs/diagnosis.md says what the decision is made of."""

from pathlib import Path

from twin.study.diagnosis.decision import RULES

PAGE = (Path(__file__).parents[3] / "docs/diagnosis.md").read_text()


def test_the_page_has_every_rule_in_its_order():
    page = PAGE.split("| constant |")[0]
    rows = [line.split("|") for line in page.splitlines() if line.startswith("| `")]
    told = [(row[1].strip(" `"), row[3].strip()) for row in rows]
    assert told == list(dict.fromkeys((rule.reason, rule.verdict) for rule in RULES))

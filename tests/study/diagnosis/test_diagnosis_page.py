"""docs/diagnosis.md says what the decision is made of."""

from pathlib import Path

from twin.study.diagnosis.decision import RULES

PAGE = (Path(__file__).parents[3] / "docs/diagnosis.md").read_text()


def test_the_page_has_every_rule_in_its_order():
    table = PAGE.split("| `", 1)[1].split("\n\n", 1)[0]
    rows = [line.split("|") for line in ("| `" + table).splitlines() if line.startswith("| `")]
    told = [(row[1].strip(" `"), row[3].strip()) for row in rows]
    assert told == list(dict.fromkeys((rule.reason, rule.verdict) for rule in RULES))

"""The tables of the decision in docs/diagnosis.md, made of the rows in the code:

python docs/decision_page.py
"""

import re
from pathlib import Path

from twin.study.diagnosis import criteria
from twin.study.diagnosis.decision import RULES, VERDICTS
from twin.study.diagnosis.naming import CAUSE_RULES, SECOND_NOT_SURE, SECOND_WHEN

PAGE = Path(__file__).resolve().parent / "diagnosis.md"
CONSTANT = re.compile(r"^([A-Z]+) = [\d.]+  # (.+)$", re.M)


def table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [f"| {' | '.join(cells)} |" for cells in (head, *rows)]
    return "\n".join([lines[0], "|---" * len(head) + "|", *lines[1:]])


def verdicts() -> str:
    """What each verdict says, and for which reasons it is given."""
    reasons = {v: dict.fromkeys(f"`{r.reason}`" for r in RULES if r.verdict == v) for v in VERDICTS}
    rows = [(f"`{v}`", said, ", ".join(reasons[v])) for v, said in VERDICTS.items()]
    return table(("verdict", "what it says", "reasons"), rows)


def rules() -> str:
    """The rules in their order."""
    return table(("reason", "when", "verdict"), [(f"`{r.reason}`", r.when, r.verdict) for r in RULES])


def causes() -> str:
    """Why a cause is not named, in the order in which it is asked."""
    rows = [(f"`{r.reason}`", r.when) for r in CAUSE_RULES]
    return table(("reason", "when"), [*rows, (f"`{SECOND_NOT_SURE}`", SECOND_WHEN)])


def constants() -> str:
    """The numbers that decide."""
    lines = CONSTANT.findall(Path(criteria.__file__).read_text())
    rows = [(f"`{name}`", f"{getattr(criteria, name)}", meaning) for name, meaning in lines]
    return table(("constant", "value", "question"), rows)


TABLES = {"verdicts": verdicts, "rules": rules, "causes": causes, "constants": constants}


def page(text: str) -> str:
    """The page with each table between its marks as the code has it now."""
    for name, made in TABLES.items():
        begin, end = f"<!-- {name}: made by docs/decision_page.py -->", f"<!-- end of {name} -->"
        before, _, rest = text.partition(begin)
        _, _, after = rest.partition(end)
        text = f"{before}{begin}\n{made()}\n{end}{after}"
    return text


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text()))

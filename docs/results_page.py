"""docs/results/cases.csv, a row a case, and the pages that are made of it:

    python docs/results_page.py

writes docs/results/cases.md and the table in docs/results/decision.md; and docs/results/judgement.md down to
what is written by hand there, of the fleet's answers that `python -m bench.fleet keep` put down. With
--take-in the table of cases is made first, of the answers in tests/study/diagnosis/recorded_facts.json: which
of them are right is asked of the two benchmarks by which the voyages were made."""

import csv
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from bench.decisions.__main__ import right as right_of_decisions
from bench.fleet import keep_answers, kept_rows
from bench.fleet.answer_score import right as right_of_fleet
from bench.fleet.fleet_page import by_hand
from bench.fleet.hidden_causes import OUTSIDE
from bench.fleet.judgement_page import judgement

ROOT = Path(__file__).resolve().parents[1]
RECORDED = ROOT / "tests" / "study" / "diagnosis" / "recorded_facts.json"
RESULTS = ROOT / "docs" / "results"
CASES, CASES_PAGE, DECISION_PAGE = RESULTS / "cases.csv", RESULTS / "cases.md", RESULTS / "decision.md"
JUDGEMENT_PAGE = RESULTS / "judgement.md"
BEGIN, END = "<!-- cases: made by docs/results_page.py -->", "<!-- end of cases -->"
DECISIONS, FLEET = "python -m bench.decisions FOLDER", "python -m bench.fleet run FOLDER"
REAL, POND = "twin-bench real", "python -m bench.real.esso_osaka FOLDER"


class Voyages(NamedTuple):
    """Where voyages come from, and how and when they were answered."""

    origin: str
    source: str
    recorded: str


OF_DECISIONS = {  # first word of a case's name -> its voyages
    "bundled": Voyages("bundled with the twin", DECISIONS, "2026-11-28"),
    "container": Voyages("reference sea", DECISIONS, "2026-11-25"),
    "kvlcc2": Voyages("reference sea", DECISIONS, "2026-11-28"),
    "esso": Voyages("a tanker's model in a pond", DECISIONS, "2026-11-25"),
    "others": Voyages("third-party simulations", DECISIONS, "2026-11-25"),
    "hsva": Voyages("a 7 m model in a tank, faults put into its readings", REAL, "2026-11-26"),
    "marin": Voyages("a tank model at ship scale, faults put into its readings", REAL, "2026-11-26"),
    "pond": Voyages("a tanker's model in a pond, faults put into its readings", POND, "2026-11-26"),
}
OF_FLEET = Voyages("random ships of many forms", FLEET, "2026-11-26")


class CaseRow(NamedTuple):
    """One voyage with a known truth, and what was answered; `before`: by the decision of commit 64d5c94."""

    case: str
    origin: str
    family: str
    hidden: str
    in_ship_file: str
    verdict: str
    named: str
    reason: str
    right: str
    verdict_before: str
    named_before: str
    right_before: str
    source: str
    recorded: str


def case_row(name: str, recorded: Mapping[str, Any]) -> CaseRow:
    """The row of one recorded answer."""
    truth, before = recorded["truth"], recorded.get("before")
    first, _, rest = name.partition(" ")
    fleet = first == "fleet"
    voyages = OF_FLEET if fleet else OF_DECISIONS[first]
    is_right = _right_in_fleet(recorded) if fleet else right_of_decisions(truth, recorded)
    return CaseRow(
        case=name,
        origin=voyages.origin,
        family=rest.partition("-")[0] if fleet else first,
        hidden="; ".join(f"{effect} {size:g}" for effect, size in truth["hidden"].items()),
        in_ship_file=truth.get("knows", ""),
        verdict=recorded["verdict"],
        named="; ".join(recorded["missing"]),
        reason=recorded["reason"],
        right=_mark(is_right),
        verdict_before=before["verdict"] if before else "",
        named_before="; ".join(before["missing"]) if before else "",
        right_before=_mark(right_of_decisions(truth, before)) if before else "",
        source=voyages.source,
        recorded=voyages.recorded,
    )


def _right_in_fleet(recorded: Mapping[str, Any]) -> bool:
    hidden = recorded["truth"]["hidden"]
    kind = "nothing" if not hidden else "outside" if set(hidden) & set(OUTSIDE) else "causes"
    return right_of_fleet(
        {**recorded, "hidden": hidden, "kind": kind, "weather": recorded["facts"]["weather"]}
    )


def _mark(is_right: bool) -> str:
    return "right" if is_right else "wrong"


def taken_in() -> list[CaseRow]:
    """The rows of all recorded answers."""
    return [case_row(name, row) for name, row in json.loads(RECORDED.read_text()).items()]


def read() -> list[CaseRow]:
    """The rows of the table."""
    with CASES.open(newline="") as file:
        return [CaseRow(**row) for row in csv.DictReader(file)]


def write(rows: Sequence[CaseRow]) -> None:
    with CASES.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerows([CaseRow._fields, *rows])


def _answer(verdict: str, named: str) -> str:
    return f"`{verdict}` {named.replace(';', ',')}".rstrip()


def _bold(mark: str) -> str:
    return f"**{mark}**" if mark == "wrong" else mark


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [f"| {' | '.join(cells)} |" for cells in (head, *rows)]
    return "\n".join([lines[0], "|---" * len(head) + "|", *lines[1:]])


def decisions(rows: Sequence[CaseRow]) -> str:
    """The table of docs/results/decision.md: what was answered before, and after."""
    return _table(
        ("voyage", "before", "", "after", "reason", ""),
        [
            (
                r.case,
                _answer(r.verdict_before, r.named_before) if r.verdict_before else "",
                _bold(r.right_before),
                _answer(r.verdict, r.named),
                f"`{r.reason}`",
                _bold(r.right),
            )
            for r in rows
            if r.source == DECISIONS
        ],
    )


def _shares(rows: Sequence[CaseRow]) -> str:
    out = []
    for origin in dict.fromkeys(r.origin for r in rows):
        of = [r for r in rows if r.origin == origin]
        out.append(
            (origin, _share([r for r in of if _unknown(r)]), _share([r for r in of if not _unknown(r)]))
        )
    return _table(
        ("voyages", "right where something is unknown to the ship file", "right where nothing is"), out
    )


def _unknown(row: CaseRow) -> bool:
    """Whether something is hidden that the ship file does not have."""
    return any(effect.rpartition(" ")[0] != row.in_ship_file for effect in row.hidden.split("; ") if effect)


def _share(rows: Sequence[CaseRow]) -> str:
    return f"{sum(r.right == 'right' for r in rows)} of {len(rows)}" if rows else "-"


def cases_page(rows: Sequence[CaseRow]) -> str:
    """docs/results/cases.md."""
    answers = [
        (
            r.case,
            r.hidden or "nothing",
            r.in_ship_file,
            _answer(r.verdict, r.named),
            f"`{r.reason}`",
            _bold(r.right),
            r.recorded,
        )
        for r in rows
    ]
    return f"""# Every recorded answer of a diagnosis

{len(rows)} voyages with a known truth, and what `twin diagnose` answered: a row a case in
[cases.csv](cases.csv), of which `python docs/results_page.py` makes this page and the table of
[the decision](decision.md). The same answers, with the facts on which they rest, are in
`tests/study/diagnosis/recorded_facts.json`, where a test decides each again.

The voyages have been looked at, and those of the random ships are no sample: rates stand in
[the decision on random ships](judgement.md). **Right** is what each benchmark asks: every hidden cause of
ship and instruments is named and no other. On random ships weather that is named never counts against an
answer, and `undecided` is right on a healthy ship; elsewhere it is not. Sizes: 1 is plain to see.

{_shares(rows)}

{_table(("case", "hidden", "in the ship file", "answer", "reason", "", "recorded"), answers)}
"""


def decision_page(text: str, rows: Sequence[CaseRow]) -> str:
    """docs/results/decision.md with its table as the rows have it now."""
    before, _, rest = text.partition(BEGIN)
    return f"{before}{BEGIN}\n{decisions(rows)}\n{END}{rest.partition(END)[2]}"


def answers() -> list[dict[str, Any]]:
    """The fleet's answers, as rows of `python -m bench.fleet run`."""
    return kept_rows.read(*keep_answers.FLEET)


def judgement_page(rows: Sequence[Mapping[str, Any]]) -> str:
    """docs/results/judgement.md of these answers; what is written by hand at its end stays."""
    new = kept_rows.read(*keep_answers.NEW_SHIPS)
    return judgement(rows, new, json.loads(keep_answers.FIT.read_text())) + by_hand(JUDGEMENT_PAGE)


if __name__ == "__main__":
    if "--take-in" in sys.argv:
        write(taken_in())
    CASES_PAGE.write_text(cases_page(read()))
    DECISION_PAGE.write_text(decision_page(DECISION_PAGE.read_text(), read()))
    JUDGEMENT_PAGE.write_text(judgement_page(answers()))

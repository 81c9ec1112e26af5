"""A row's facts, decided by the table of today."""

from dataclasses import replace
from typing import Any

from bench.fleet.answer_score import Row
from twin.study.diagnosis.decision import Decision, decide
from twin.study.diagnosis.facts import Facts


def read_facts(row: Row) -> Facts:
    """The facts of a row; how many references reach its score is got from p where the row is older than the
    fact."""
    facts, p, least = Facts.read(row["facts"]), row.get("p_value"), row.get("p_value_at_best")
    if facts.reached is not None or p is None or least is None:
        return facts
    n = round(1 / least) - 1
    return replace(facts, reached=round(p * (n + 1) - 1) / n)


def decided(row: Row) -> dict[str, Any]:
    """The row with the answer that the decision of today gives to its facts."""
    d = decided_again(row, read_facts(row))
    return {**row, "missing": list(d.missing), "verdict": d.verdict, "reason": d.reason}


def decided_again(row: Row, facts: Facts) -> Decision:
    """What the table of today decides. An answer of two searches stays as it is: its facts are those of both,
    and each was decided by its own."""
    d = decide(facts)
    if not row.get("further"):
        return d
    named = tuple(row["missing"])
    others = {n: why for n, why in d.not_named.items() if n not in named}
    return replace(d, verdict=row["verdict"], reason=row["reason"], missing=named, not_named=others)

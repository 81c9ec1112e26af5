"""The decision fitted, with each form of hull held out in turn: `python -m bench.fleet fit FOLDER`.

Two forms are asked. The table of rules as it is (twin/study/diagnosis/decision.py) with its thresholds moved,
one at a time, as long as the ships of the other forms gain by it. And a logistic model that is monotone in
a few facts, which says of each cause of the explanation how likely it is there, in the place of the rules
that name."""

import argparse
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from bench.fleet import answer_score, probability_fit
from bench.fleet.answer_score import Row, Share, share
from bench.fleet.decided_again import decided_again, read_facts
from bench.fleet.fleet_page import lines, rows_of
from bench.fleet.probability_fit import logistic
from twin.study.diagnosis import criteria, decision, naming
from twin.study.diagnosis.calibrated_probability import FACTS
from twin.study.diagnosis.facts import Cause, Facts

GRID = {  # what is tried of each threshold that acts on facts alone (others steer the search as well)
    "NAMED": (0.7, 0.8, 0.9, 0.95),
    "CERTAIN": (0.7, 0.8, 0.9, 0.95, 0.99),
    "LOST": (0.3, 0.5, 0.7, 0.9),
    "BETTER": (0.0, 0.05, 0.1, 0.15, 0.2),
    "SIGNIFICANT": (2.0, 3.0, 4.0, 5.0, 6.0, 8.0),
    "USUAL": (0.1, 0.25, 0.5, 2.0),
    "CHANGED": (1.0, 2.0, 3.0, 4.0),
    "POWER": (0.5, 0.6, 0.75),
}
BEFORE = {
    "NAMED": 0.8,
    "SIGNIFICANT": 3.0,
    "USUAL": 2.0,
}  # before the fleet was asked; the others stand as they did
ALARMS = 0.04  # share of healthy voyages on which an alarm may be raised, at the working point
COST = 5.0  # of a false alarm beyond that, in hidden causes that are named
WRONG = 0.5  # of a wrong name
HEALTHY = 0.98  # share of the healthy voyages that end within `NEARLY` times the expected error


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="+", help="folders with rows.jsonl")
    parser.add_argument("--json", type=Path, metavar="FILE.json", default=Path("fit.json"))


@contextmanager
def thresholds(values: Mapping[str, float]) -> Iterator[None]:
    """The table with these thresholds."""
    before = {k: getattr(criteria, k) for k in values}
    try:
        for k, v in values.items():
            setattr(criteria, k, v)
        yield
    finally:
        for k, v in before.items():
            setattr(criteria, k, v)


Answer = tuple[tuple[str, ...], str]
Decide = Callable[[Row], Answer]


def by_table(row: Row) -> Answer:
    d = decided_again(row, row["read"])
    return d.missing, d.verdict


def worth(rows: Sequence[Row], decide: Decide) -> float:
    """What an answer is worth on average: right ones, less wrong names, less alarms beyond what may be."""
    said = [(r, *decide(r)) for r in rows]
    right = [answer_score.right(r, m, v) for r, m, v in said if r["kind"] != "nothing" and can_be_named(r)]
    wrong = [bool(answer_score.wrong_names(r, m)) for r, m, _ in said if r["kind"] != "nothing"]
    alarm = [bool(answer_score.causes(m)) or v == "unknown" for r, m, v in said if r["kind"] == "nothing"]
    return _mean(right) - WRONG * _mean(wrong) - COST * max(0.0, _mean(alarm) - ALARMS)


def _mean(some: Sequence[bool]) -> float:
    return float(np.mean(some)) if some else 0.0


def can_be_named(row: Row) -> bool:
    """Whether it can be asked that a cause is named at all: its oracle gains, or it has no oracle."""
    return answer_score.kind(row) in ("outside", "by now") or answer_score.gains(row)


def moved(rows: Sequence[Row]) -> dict[str, float]:
    """Thresholds by coordinate ascent from today's; a move must be worth a case in a hundred."""
    best = {k: float(getattr(criteria, k)) for k in GRID} | BEFORE
    with thresholds(best):
        top = worth(rows, by_table)
    for _ in range(2):
        for name, grid in GRID.items():
            for value in grid:
                with thresholds(best | {name: value}):
                    new = worth(rows, by_table)
                if new > top + 0.01:
                    top, best = new, best | {name: value}
    return best


def healthy_limits(rows: Sequence[Row]) -> dict[str, float]:
    """What HEALTHY of the healthy voyages end within, in expected errors, the day's weather in the model: of
    all (""), and of all but a form of hull, by its name."""
    errors = [(answer_score.form(r), r["read"].error_nothing) for r in rows if r["kind"] == "nothing"]
    return {
        left_out: float(np.quantile([e for of, e in errors if of != left_out], HEALTHY))
        for left_out in ("", *_forms(rows))
    }


def examples(rows: Sequence[Row]) -> tuple[np.ndarray, np.ndarray]:
    """(M, F) facts and (M,) truth of every cause of every explanation."""
    found = [e for row in rows for e in probability_fit.of_causes(row)]
    return np.array([x for x, _ in found]).reshape(-1, len(FACTS)), np.array([so for _, so in found], float)


def probability(w: np.ndarray, f: Facts, c: Cause) -> float:
    return float(1 / (1 + np.exp(-(w[0] + np.dot(w[1:], probability_fit.values(f, c, decision.decide(f)))))))


def by_logistic(w: np.ndarray, limit: float) -> Decide:
    """Causes of the explanation that are likelier than the limit are named; where none is, the table without
    its names."""

    def decide(row: Row) -> Answer:
        f: Facts = row["read"]
        named = [c.effect for c in f.causes if c.in_explanation and probability(w, f, c) >= limit]
        if named:
            return (*named, *naming.weather_named(f)), "missing"
        d = decision.decide(f)
        if answer_score.causes(d.missing):
            return tuple(n for n in d.missing if n in answer_score.OF_THE_VOYAGE), "undecided"
        return d.missing, d.verdict

    return decide


def working_point(rows: Sequence[Row], w: np.ndarray) -> float:
    limits = np.round(np.arange(0.3, 0.96, 0.05), 2)
    return float(max(limits, key=lambda t: worth(rows, by_logistic(w, float(t)))))


def outcome(rows: Sequence[Row], decide: Decide) -> dict[str, tuple[int, int]]:
    """Counts of the figures under a decision."""
    said = [(r, *decide(r)) for r in rows]

    def of(
        which: Callable[[Row], bool], what: Callable[[Row, tuple[str, ...], str], bool]
    ) -> tuple[int, int]:
        return _pair(share([what(r, m, v) for r, m, v in said if which(r)]))

    return {
        "single, gains": of(lambda r: r["kind"] == "single" and answer_score.gains(r), answer_score.right),
        "single, all": of(lambda r: r["kind"] == "single", answer_score.right),
        "pair and triple, gains": of(
            lambda r: r["kind"] in ("pair", "triple") and answer_score.gains(r), answer_score.right
        ),
        "outside": of(lambda r: answer_score.kind(r) == "outside", answer_score.right),
        "wrong name": of(
            lambda r: r["kind"] != "nothing", lambda r, m, v: bool(answer_score.wrong_names(r, m))
        ),
        "healthy, named": of(lambda r: r["kind"] == "nothing", lambda r, m, v: bool(answer_score.causes(m))),
        "healthy, alarm": of(
            lambda r: r["kind"] == "nothing", lambda r, m, v: bool(answer_score.causes(m)) or v == "unknown"
        ),
    }


def _pair(s: Share) -> tuple[int, int]:
    return s.k, s.n


def added(all_of: Sequence[dict[str, tuple[int, int]]]) -> dict[str, str]:
    return {k: str(Share(sum(o[k][0] for o in all_of), sum(o[k][1] for o in all_of))) for k in all_of[0]}


def chosen(rows: Sequence[Row]) -> dict[str, dict[str, Any]]:
    """What the ships of the other forms ask for, a form: thresholds that differ from those of before,
    and the probability from which the logistic model names a cause. (Minutes.)"""
    out = {}
    for form in _forms(rows):
        others = [r for r in rows if answer_score.form(r) != form]
        limit = working_point(others, logistic(*examples(others)))
        out[form] = {"thresholds": _changed(moved(others)), "limit": limit}
    return out


def held_out(rows: Sequence[Row], asked_for: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """What becomes of each form of hull with what the others ask for (`chosen`): the figures of the table as
    it was before, with its thresholds moved, and of the logistic model; and the same of that by the
    probability from which it names a cause."""
    held: dict[str, list[dict[str, tuple[int, int]]]] = {"before": [], "thresholds moved": [], "logistic": []}
    curve: dict[float, list[dict[str, tuple[int, int]]]] = {}
    for form, of in asked_for.items():
        own, others = ([r for r in rows if (answer_score.form(r) == form) == its] for its in (True, False))
        for name, moves in (("before", {}), ("thresholds moved", of["thresholds"])):
            with thresholds(BEFORE | moves):
                held[name].append(outcome(own, by_table))
        w = logistic(*examples(others))
        held["logistic"].append(outcome(own, by_logistic(w, of["limit"])))
        for t in np.round(np.arange(0.2, 0.99, 0.05), 2).tolist():
            curve.setdefault(t, []).append(outcome(own, by_logistic(w, t)))
    return {
        "held_out": {name: added(each) for name, each in held.items()},
        "curve": {str(t): added(each) for t, each in curve.items()},
    }


def with_facts(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """The rows with their facts read, as all here asks for them."""
    return [{**r, "read": read_facts(r)} for r in rows]


def of_one_search(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Those that the table can decide again: an answer of two searches was decided by the facts of each."""
    return [r for r in rows if not r.get("further")]


def run(args: argparse.Namespace) -> int:
    rows = of_one_search(with_facts(rows_of(args.folder)))
    asked_for, w = chosen(rows), logistic(*examples(rows))
    result = held_out(rows, asked_for) | {
        "voyages": len(rows),
        "chosen_by_form_held_out": asked_for,
        "of_all": {"thresholds": moved(rows), "limit": working_point(rows, w), "weights": _weights(w)},
        "probabilities": probability_fit.fitted(probability_fit.examples(rows)),
    }
    result["page"] = fitted_lines(result) + probability_fit.page_lines(result["probabilities"])
    args.json.write_text(json.dumps(result, indent=1))
    print("\n".join(result["page"]))
    return 0


def _forms(rows: Sequence[Row]) -> list[str]:
    return sorted({answer_score.form(r) for r in rows})


def _changed(best: Mapping[str, float]) -> dict[str, float]:
    return {k: v for k, v in best.items() if v != BEFORE.get(k, getattr(criteria, k))}


def _weights(w: np.ndarray) -> dict[str, float]:
    return dict(zip(["constant", *FACTS], [round(float(v), 3) for v in w], strict=True))


def fitted_lines(result: Mapping[str, Any]) -> list[str]:
    """What was fitted, for the page, in two sections."""
    held: Mapping[str, Mapping[str, str]] = result["held_out"]
    body = [(figure, *(held[name][figure] for name in held)) for figure in held["before"]]
    text = (
        "By the table with the thresholds that were conventions, before any fit; with those that the other "
        "forms ask for; and by a logistic model of the facts, fitted to the other forms."
    )
    out = lines("The decision fitted, each form of hull held out in turn", text, ("", *held), body)
    keys = ("single, gains", "pair and triple, gains", "wrong name", "healthy, named")
    text = "Of that model with each form of hull held out, by the probability from which a cause is named."
    curve = [(t, *(c[k] for k in keys)) for t, c in result["curve"].items()]
    return out + lines("Names against false alarms", text, ("from", *keys), curve)

"""The probabilities that are told, fitted to the answers on random ships, each form of hull held out in turn.

Four questions (twin/study/diagnosis/calibrated_probability.py), each with a logistic model that is monotone
in its facts: whether a cause of the explanation is there, one that the explanation does without, none at
all, one without a name. An answer is held against what was hidden."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import minimize

from bench.fleet.answer_score import Row, causes, form, hidden_causes, kind, posterior, share
from bench.fleet.decided_again import decided_again
from bench.fleet.fleet_page import lines
from twin.study.diagnosis.calibrated_probability import FACTS, log_odds, posterior_of_unknown, unnamed
from twin.study.diagnosis.decision import Decision
from twin.study.diagnosis.facts import Cause, Facts

RIDGE = 1.0
BINS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.8, 0.85, 0.95, 1.0)


@dataclass(frozen=True)
class AnswerExample:
    """One question of one answer: the facts that the model is asked with, and whether it is so."""

    question: str
    form: str  # of the hull: families that share one are left out together
    facts: list[float]
    so: bool


FactsAndTruth = tuple[list[float], bool]  # facts, and whether it is so


def values(f: Facts, c: Cause, d: Decision) -> list[float]:
    """What the model of a cause of the explanation is asked with."""
    return [fact(f, c, d) for fact in FACTS.values()]


def of_causes(row: Row) -> list[FactsAndTruth]:
    """Each cause of the explanation."""
    f: Facts = row["read"]
    d = decided_again(row, f)
    return [(values(f, c, d), c.effect in hidden_causes(row)) for c in f.causes if c.in_explanation]


def _of_causes_beside(row: Row) -> list[FactsAndTruth]:
    within = {c.effect for c in row["read"].causes if c.in_explanation}
    return [
        ([log_odds(posterior(c))], c["effect"] in hidden_causes(row))
        for c in row["candidates"]
        if c and c["effect"] not in within and causes([c["effect"]])
    ]


def _of_nothing(row: Row) -> list[FactsAndTruth]:
    """By the posterior, also of rows whose answer sets it aside (a stretch had a push of its own)."""
    f: Facts = row["read"]
    return [([log_odds(f.nothing), unnamed(f, decided_again(row, f))], not hidden_causes(row))]


def _of_unknown(row: Row) -> list[FactsAndTruth]:
    verdict, posterior = decided_again(row, row["read"]).verdict, posterior_of_unknown(row["read"])
    return [([log_odds(posterior), float(verdict == "unknown")], kind(row) == "outside")]


@dataclass(frozen=True)
class ProbabilityModel:
    """A question, its facts by name, and what a row has to say of it."""

    asks: str
    facts: tuple[str, ...]
    of: Callable[[Row], list[FactsAndTruth]]


QUESTIONS = {  # weights in calibrated_probability.py -> what they answer
    "OF_CAUSE": ProbabilityModel("a cause of the explanation is there", tuple(FACTS), of_causes),
    "OF_CAUSE_BESIDE": ProbabilityModel(
        "a cause beside the explanation is there", ("log_odds",), _of_causes_beside
    ),
    "OF_NOTHING": ProbabilityModel(
        "no cause of ship and instruments is there", ("log_odds", "unnamed"), _of_nothing
    ),
    "OF_UNKNOWN": ProbabilityModel("what is there has no name", ("log_odds", "verdict"), _of_unknown),
}


def logistic(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Weights of a constant and of each fact, none below zero, by penalised likelihood."""
    X = np.column_stack([np.ones(len(x)), x])

    def loss(w: np.ndarray) -> tuple[float, np.ndarray]:
        s = X @ w
        p = 1 / (1 + np.exp(-s))
        value = float(np.sum(np.logaddexp(0, s) - y * s) + 0.5 * RIDGE * w[1:] @ w[1:])
        return value, X.T @ (p - y) + RIDGE * np.concatenate([[0], w[1:]])

    start = np.concatenate([[-1.0], np.full(x.shape[1], 0.2)])
    bounds = [(None, None), *((0.0, None) for _ in range(x.shape[1]))]
    return np.asarray(minimize(loss, start, jac=True, bounds=bounds, method="L-BFGS-B").x)


def examples(rows: Sequence[Row]) -> list[AnswerExample]:
    """Every question of every row."""
    return [
        AnswerExample(name, form(row), facts, so)
        for row in rows
        for name, question in QUESTIONS.items()
        for facts, so in question.of(row)
    ]


def _arrays(found: Sequence[AnswerExample]) -> tuple[np.ndarray, np.ndarray]:
    return np.array([e.facts for e in found], float), np.array([e.so for e in found], float)


def _held_out(found: Sequence[AnswerExample]) -> tuple[np.ndarray, np.ndarray]:
    """What the fit to the other forms of hulls says of each example, and whether it is so."""
    told, so = [], []
    for left_out in sorted({e.form for e in found}):
        w = logistic(*_arrays([e for e in found if e.form != left_out]))
        x, y = _arrays([e for e in found if e.form == left_out])
        told.append(1 / (1 + np.exp(-(w[0] + x @ w[1:]))))
        so.append(y)
    return np.concatenate(told), np.concatenate(so)


def fitted(found: Sequence[AnswerExample], new: Sequence[AnswerExample] = ()) -> dict[str, Any]:
    """Of each question: the weights fitted to all, and the reliability with each form of hull held out; and
    what those that are fitted without the `new` ships are worth on them."""
    out = {}
    for name, question in QUESTIONS.items():
        own, others = ([e for e in some if e.question == name] for some in (found, new))
        w = logistic(*_arrays([*own, *others]))
        out[name] = {
            "weights": dict(zip(("constant", *question.facts), [round(float(v), 2) for v in w], strict=True)),
            "held_out": _reliability(*_held_out([*own, *others])),
        }
        if others:
            (x, y), w = _arrays(others), logistic(*_arrays(own))
            out[name]["new"] = _reliability(1 / (1 + np.exp(-(w[0] + x @ w[1:]))), y)
    return out


def _reliability(p: np.ndarray, y: np.ndarray) -> dict[str, Any]:
    """Of what was told (N,) and what was so (N,): by what was told, the mean of it and how often it was so;
    and the mean log likelihood."""
    bins = {f"{lo:g} to {hi:g}": (p >= lo) & (p < hi) for lo, hi in pairwise(BINS)}
    return {
        "log_likelihood": float(np.mean(np.log(np.where(y > 0.5, p, 1 - p)))),
        "so": {
            told: [float(p[i].mean()), str(share((y[i] > 0.5).tolist()))]
            for told, i in bins.items()
            if i.any()
        },
    }


def page_lines(found: Mapping[str, Any]) -> list[str]:
    """The reliability of each probability, for the page."""
    out: list[str] = []
    for name, one in found.items():
        weights = ", ".join(f"{k} {v:g}" for k, v in one["weights"].items())
        held, new = one["held_out"], one.get("new")
        text = (
            f"What the fit to ships of other forms says, and how often it is so. Fitted to all: {weights}. "
            f"Mean log likelihood with the form left out: {held['log_likelihood']:.3f}"
        )
        text += f"; on the new ships, of a fit without them: {new['log_likelihood']:.3f}." if new else "."
        told = held["so"] | (new["so"] if new else {})
        body = [
            (bin, *(cell for of in (held, new) if of for cell in _cells(of["so"].get(bin))))
            for bin in sorted(told)
        ]
        titles = ("told", "mean told", "so", *(("mean told, new ships", "so, new ships") if new else ()))
        title = f"Told that {QUESTIONS[name].asks}: each form of hull held out in turn"
        out += lines(title, text, titles, body)
    return out


def _cells(of: tuple[float, str] | None) -> tuple[str, str]:
    return (f"{of[0]:.2f}", of[1]) if of else ("-", "-")

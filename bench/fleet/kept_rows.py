"""The fleet's answers as they are kept in docs/results: a table, a row an answer, and beside it the facts on
which each rests (twin/study/diagnosis/facts.py), line for line; those that are false, 0, null or empty are
left out.

Rounded: sizes to five digits, posteriors to four, facts to three; no decision turned by it."""

import csv
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from bench.fleet.answer_score import Row, answered_weather, posterior, right, truths
from twin.study.diagnosis.facts import Cause, Facts, Left

NONE: dict[Any, Any] = {bool: False, float: 0.0, float | None: None, tuple[str, ...]: []}  # facts by type
COLUMNS = (
    "voyage",
    "family",
    "ship",
    "kind",
    "hidden",
    "verdict",
    "reason",
    "named",
    "further",
    "weather",
    "right",
    "posteriors",
    "sizes",
    "oracle_without_m",
    "oracle_with_m",
    "gain_by_each",
    "p_value",
    "p_value_at_best",
    "cpu_s",
    "calibration_s",
)


def digits(x: Any, n: int = 3) -> Any:
    """A value with its numbers, and those within it, to so many significant digits."""
    if isinstance(x, float):
        return float(f"{x:.{n}g}")
    if isinstance(x, Mapping):
        return {k: digits(v, n) for k, v in x.items()}
    return [digits(v, n) for v in x] if isinstance(x, (list, tuple)) else x


def _shown(x: float | None, n: int = 3) -> str:
    return "" if x is None else f"{x:.{n}g}"


def _number(text: str) -> float | None:
    return float(text) if text else None


def line(row: Row) -> dict[str, str]:
    """The row of an answer in the table. Hidden: each with its strength (1 is plain to see). Sizes: of each
    cause that is named and hidden its numbers in SI units, as estimate/low95/high95/truth."""
    oracle = row.get("oracle") or {}
    return {
        "voyage": row["key"],
        "family": row["family"],
        "ship": f"{row['family']}-{row['seed']}",
        "kind": row["kind"],
        "hidden": _pairs({name: _shown(strength) for name, strength in row["hidden"].items()}),
        "verdict": row["verdict"],
        "reason": row["reason"],
        "named": "; ".join(row["missing"]),
        "further": "; ".join(row.get("further", ())),
        "weather": "; ".join(sorted(answered_weather(row))),
        "right": "right" if right(row) else "wrong",
        "posteriors": _pairs({c["effect"]: _shown(posterior(c), 4) for c in row["candidates"]}),
        "sizes": _pairs(_sizes(row)),
        "oracle_without_m": _shown(oracle.get("without_m"), 5),
        "oracle_with_m": _shown(oracle.get("with_m"), 5),
        "gain_by_each": _pairs({name: _shown(of) for name, of in oracle.get("gain_by_each", {}).items()}),
        "p_value": _shown(row.get("p_value"), 4),
        "p_value_at_best": _shown(row.get("p_value_at_best"), 4),
        "cpu_s": _shown(row["cpu_s"]),
        "calibration_s": _shown(row["calibration_s"]),
    }


def _pairs(of: Mapping[str, str]) -> str:
    return "; ".join(f"{name} {text}" for name, text in of.items())


def _sizes(row: Row) -> dict[str, str]:
    true, out = truths(row), {}
    for c in row["candidates"]:
        for p in c["parameters"] if c["effect"] in row["missing"] else ():
            label = f"{c['effect']}.{p['name']}"
            if label in true:
                numbers = (p["value"], p["low95"], p["high95"], true[label])
                out[label] = "/".join(_shown(x, 5) for x in numbers)
    return out


def write(answers: Sequence[Row], table: Path, facts: Path) -> None:
    """Both files of these answers."""
    with table.open("w", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows(map(line, answers))
    facts.write_text("".join(f"{_facts_line(row)}\n" for row in answers))


def _facts_line(row: Row) -> str:
    return json.dumps(_shortened(digits(row["facts"])), separators=(",", ":"))


def _none(kind: type) -> dict[str, Any]:
    """The facts of this kind of which nothing has to be said, by name."""
    return {f.name: NONE[f.type] for f in fields(kind) if f.type in NONE}


def _shortened(facts: Mapping[str, Any]) -> dict[str, Any]:
    out = _without(facts, Facts) | {"left": _without(facts["left"], Left)}
    return out | {of: [_without(c, Cause) for c in facts[of]] for of in ("causes", "weather")}


def _without(of: Mapping[str, Any], kind: type) -> dict[str, Any]:
    none = _none(kind)
    return {name: x for name, x in of.items() if name not in none or x != none[name]}


def _whole(facts: Mapping[str, Any]) -> dict[str, Any]:
    """What `_shortened` had."""
    out = {**_none(Facts), **facts, "left": _none(Left) | facts["left"]}
    return out | {of: [_none(Cause) | c for c in facts[of]] for of in ("causes", "weather")}


def read(table: Path, facts: Path) -> list[dict[str, Any]]:
    """The rows of both files, with the names that rows of `python -m bench.fleet run` have, as far as the
    page asks for them; and `truths`, the true numbers."""
    with table.open(newline="") as file:
        known = map(json.loads, facts.read_text().splitlines())
        return [_row(one, of) for one, of in zip(csv.DictReader(file), known, strict=True)]


def _row(of: Mapping[str, str], facts: dict[str, Any]) -> dict[str, Any]:
    numbers = {name: [float(x) for x in text.split("/")] for name, text in _named(of["sizes"])}
    named = [name for name in of["named"].split("; ") if name]
    told = {name for name in of["weather"].split("; ") if name} - set(named)
    each = {name: float(gain) for name, gain in _named(of["gain_by_each"])}
    without, best = _number(of["oracle_without_m"]), _number(of["oracle_with_m"])
    return {
        "key": of["voyage"],
        "family": of["family"],
        "seed": int(of["ship"].rpartition("-")[2]),
        "kind": of["kind"],
        "hidden": {name: float(strength) for name, strength in _named(of["hidden"])},
        "verdict": of["verdict"],
        "reason": of["reason"],
        "missing": named,
        "further": [name for name in of["further"].split("; ") if name],
        "weather": [{"effect": name, "probability": 1.0} for name in sorted(told)],
        "candidates": [
            {"effect": name, "posterior": float(p), "parameters": _parameters(name, numbers)}
            for name, p in _named(of["posteriors"])
        ],
        "truths": {name: values[3] for name, values in numbers.items()},
        "oracle": None if without is None else {"without_m": without, "with_m": best, "gain_by_each": each},
        "p_value": _number(of["p_value"]),
        "p_value_at_best": _number(of["p_value_at_best"]),
        "cpu_s": float(of["cpu_s"]),
        "calibration_s": float(of["calibration_s"]),
        "facts": _whole(facts),
    }


def _named(text: str) -> Iterator[tuple[str, str]]:
    for part in text.split("; ") if text else ():
        name, _, rest = part.rpartition(" ")
        yield name, rest


def _parameters(effect: str, numbers: Mapping[str, Sequence[float]]) -> list[dict[str, Any]]:
    return [
        {"name": label.partition(".")[2], "value": value, "low95": low, "high95": high}
        for label, (value, low, high, _) in numbers.items()
        if label.partition(".")[0] == effect
    ]

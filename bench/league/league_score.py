"""The league's rows as numbers: the JSON of docs/json.md, and the tables behind it."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from twin.physics.effect import SensorFault
from twin.physics.effects import find

Row = dict[str, Any]
SCHEMA_VERSION = 1


def named(row: Row) -> bool:
    """The hidden effect comes first."""
    return row["missing"][:1] == list(row["missing_truly"])[:1]


def in_group(row: Row) -> bool:
    """It is among the named, or in the group that the data could not tell from the first of them; or, when
    nothing was named, in the small group of which one is surely there."""
    return row["missing_truly"][0] in {*row["missing"], *row["group"]}


def of_instruments(row: Row) -> bool:
    """What is hidden is a fault of an instrument, which need not move the ship."""
    return all(issubclass(find(n), SensorFault) for n in row["hidden"])


def alarm(row: Row) -> bool:
    return row["verdict"] in ("missing", "unknown", "failed")


def recognised(row: Row) -> bool:
    """An effect outside the catalogue was not called by a wrong name, nor overlooked."""
    return row["verdict"] in ("unknown", "undecided")


def both(row: Row) -> bool:
    """Both are named, or one that the other is a part of (a changing current has a mean)."""
    return set(row["missing_truly"]) <= {part for n in row["missing"] for part in (n, *find(n).holds)}


def share(rows: Sequence[Row], test: Any) -> float | None:
    return sum(bool(test(r)) for r in rows) / len(rows) if rows else None


def of_kind(rows: Sequence[Row], *kinds: str) -> list[Row]:
    return [r for r in rows if r["kind"] in kinds]


def contract(rows: Sequence[Row]) -> dict[str, Any]:
    """The keys that scripts hold on to; shares are of the cases counted beside them."""
    single, nothing = of_kind(rows, "effect"), of_kind(rows, "none", "decoy")
    outside, pairs = of_kind(rows, "outside"), of_kind(rows, "pair")
    return {
        "schema_version": SCHEMA_VERSION,
        "cases": len(rows),
        "named": share(single, named),
        "named_in_group": share(single, in_group),
        "false_alarms": share(nothing, alarm),
        "nothing_cases": len(nothing),
        "unknown_recognised": share(outside, recognised),
        "unknown_cases": len(outside),
        "pairs_found": share(pairs, both),
        "pair_cases": len(pairs),
        "coverage95": coverage(rows),
        "error_after_over_oracle": ratio(single, "after", "oracle"),
        "seconds_median": middle([r["seconds"] for r in rows if "seconds" in r]),
        "effects": {n: of_effect(r) for n, r in by_effect(single).items()},
    }


def by_effect(rows: Sequence[Row]) -> dict[str, list[Row]]:
    names = dict.fromkeys(n for r in rows for n in r["hidden"])
    return {n: [r for r in rows if n in r["hidden"]] for n in names}


def of_effect(rows: Sequence[Row]) -> dict[str, Any]:
    errors = {f"error_{k}_m": mean([r[k] for r in rows if k in r]) for k in ("before", "after", "oracle")}
    return {"cases": len(rows), "named": share(rows, named), "named_in_group": share(rows, in_group)} | errors


def coverage(rows: Sequence[Row]) -> float | None:
    """Share of 95 % intervals of rightly named effects that hold the truth."""
    held = [p["covered"] for r in rows for p in r.get("parameters", [])]
    return sum(held) / len(held) if held else None


def ratio(rows: Sequence[Row], above: str, below: str) -> float | None:
    """Geometric mean of the cases' ratios, so that a tanker does not outweigh a boat."""
    logs = [np.log(r[above] / r[below]) for r in rows if r.get(below, 0) > 0 and r.get(above, 0) > 0]
    return float(np.exp(np.mean(logs))) if logs else None


def mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if len(values) else None


def middle(values: Sequence[float]) -> float | None:
    return float(np.median(values)) if len(values) else None


def called(row: Row) -> str:
    """What the answer was, in a word or two."""
    return " + ".join(row["missing"]) if row["missing"] else row["verdict"]


def confusion(rows: Sequence[Row]) -> Counter[str]:
    """What was said where the right name did not come first."""
    return Counter(called(r) for r in rows if not named(r))

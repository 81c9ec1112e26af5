"""The page of the pond: docs/results/real-esso-osaka.md."""

from collections.abc import Mapping, Sequence
from typing import Any

from bench.fleet.answer_score import causes, share

Row = Mapping[str, Any]
HEAD = """# Real data: Esso Osaka in an open pond

```sh
SHIPTWIN_DATA=DIR python -m bench.real.esso_osaka FOLDER --page docs/results/real-esso-osaka.md
```

A 3 m model of a tanker, steered in a pond under the open sky, with the wind measured on board (FRT-DS-
ESSO: Wakita et al. 2022, doi 10.1007/s00773-021-00867-1; Miyauchi et al. 2022, doi
10.1007/s00773-022-00889-3). The wind is 4 to 29 times as fast as the model, on the calmest runs too. The
model is calibrated on the runs with the least wind for their speed, chosen by that alone, and asked of every
other zigzag and circle: with the wind taken from it (**hidden**), with the wind as calibration found it
(**given**), and given, with a fault of known size put into the readings.

Not blind: these runs have been asked again and again, and with one answer more or less right the difference
is chance. Decisions were prompted by them or judged on them:
[0023](../decisions/0023-what-a-receiver-or-a-compass-errs-by-is-no-force.md),
[0024](../decisions/0024-the-expected-error-has-the-level-of-the-reference-voyages.md),
[0025](../decisions/0025-what-a-model-leaves-over-has-one-memory.md),
[0032](../decisions/0032-a-slope-of-the-position-is-no-second-reading.md) and
[0035](../decisions/0035-clocks-differ-from-voyage-to-voyage-as-the-references-tell.md).
"""
STREAM = {"Current", "VaryingCurrent"}


def page(rows: Sequence[Row]) -> str:
    """The whole page, of the rows that are there."""
    out = [HEAD]
    for references in dict.fromkeys(r["references"] for r in rows):
        own = [r for r in rows if r["references"] == references]
        out += [f"## References: {references}", "", *_figures(own), "", *_table(own), ""]
    return "\n".join(out)


def _figures(rows: Sequence[Row]) -> list[str]:
    """What was asked for, counted over single runs."""
    one = [r for r in rows if r["runs"] == 1]
    hidden = [r for r in one if r["wind"] == "hidden"]
    given = [r for r in one if r["wind"] == "given" and not r["effects"]]
    planted = [r for r in one if r["effects"]]
    out = [
        "| single runs | goal | |",
        "|---|---|---|",
        f"| wind hidden: `Wind` named | >= 80 % | {share(['Wind' in r['missing'] for r in hidden])} |",
        f"| wind hidden: a cause named | | {share([_cause_named(r) for r in hidden])} |",
        f"| wind given: a cause named, or `unknown` | <= 5 % | {share([_alarm(r) for r in given])} |",
        f"| wind given: a stream named, which a pond has not | | {share([_stream(r) for r in given])} |",
        f"| wind given: nothing missing | >= 70 % | {share([_nothing(r) for r in given])} |",
    ]
    if planted:
        right = [causes(r["missing"]) == set(r["effects"]) for r in planted]
        wrong = [bool(causes(r["missing"]) - set(r["effects"])) for r in planted]
        out += [
            f"| planted: named alone | | {share(right)} |",
            f"| planted: a wrong name | | {share(wrong)} |",
        ]
    return out


def _table(rows: Sequence[Row]) -> list[str]:
    head = ("run", "wind / speed", "wind", "put into the readings", "verdict", "reason", "named", "error m")
    out = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    for r in sorted(rows, key=lambda r: (r["runs"], r["of"], r["wind"] == "given", r["put"])):
        cells = (
            r["of"].replace("_", " "),
            f"{r['windiness']:.1f}",
            r["wind"],
            r["put"],
            f"`{r['verdict']}`",
            f"`{r['reason']}`",
            " + ".join(r["missing"]),
            _error(r),
        )
        out.append(f"| {' | '.join(cells)} |")
    return out


def _nothing(r: Row) -> bool:
    return bool(r["verdict"] == "nothing_missing")


def _cause_named(r: Row) -> bool:
    return bool(causes(r["missing"]))


def _alarm(r: Row) -> bool:
    return _cause_named(r) or r["verdict"] == "unknown"


def _stream(r: Row) -> bool:
    return bool(STREAM & set(r["missing"]))


def _error(r: Row) -> str:
    """Open-loop error on held-out parts: without what is named, with it, and as expected of the ship."""
    path = r["path"]
    named = [c for c in r["candidates"] if c["effect"] in r["missing"] and c["error_with"] is not None]
    with_it = f" to {named[0]['error_with']:.2g}" if named else ""
    expected = f" (expected {path['error_floor']:.2g})" if path["error_floor"] is not None else ""
    return f"{path['error_without']:.2g}{with_it} after {path['horizon_s']:.0f} s{expected}"

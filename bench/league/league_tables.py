"""Tables of the league's rows, in Markdown."""

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from bench.league import league_score
from bench.league.league_score import Row

RATES = ["cases", "named", "in its group", "wrong"]
GAINS = (("less than 5 %", -float("inf"), 0.05), ("5 to 20 %", 0.05, 0.2), ("more", 0.2, 1.0))
DECOYS = {
    "wind_no_force": "strong wind is measured, none acts",
    "waves_no_force": "high waves are measured, none act",
    "": "calm, nothing hidden",
}


def table(title: str, columns: Sequence[str], lines: Sequence[Sequence[Any]]) -> str:
    """A title and a Markdown table."""
    rows = [columns, ["---"] * len(columns), *lines]
    return f"{title}\n\n" + "\n".join("| " + " | ".join(map(str, row)) + " |" for row in rows)


def share(value: float | None) -> str:
    return "" if value is None else f"{100 * value:.0f} %"


def number(value: float | None) -> str:
    return "" if value is None else f"{value:.2f}"


def wrong(row: Row) -> bool:
    """Another effect came first."""
    return bool(row["missing"]) and not league_score.named(row)


def rates(rows: Sequence[Row]) -> list[str]:
    return [str(len(rows))] + [
        share(league_score.share(rows, t)) for t in (league_score.named, league_score.in_group, wrong)
    ]


def ratios(rows: Sequence[Row]) -> list[str]:
    pairs = (("after", "before"), ("oracle", "before"), ("after", "oracle"))
    return [number(league_score.ratio(rows, *p)) for p in pairs]


def by(what: str, rows: Sequence[Row]) -> str:
    """Single effects by hull, strength, manoeuvre or seed, with the false alarms of the same."""

    def value(row: Row) -> Any:
        return min(row["hidden"].values(), default=None) if what == "strength" else row[what]

    single, lines = league_score.of_kind(rows, "effect"), []
    for v in sorted({value(r) for r in single}):
        mine = [r for r in single if value(r) == v]
        nothing = [
            r
            for r in league_score.of_kind(rows, "none", "decoy")
            if what in ("hull", "manoeuvre") and r[what] == v
        ]
        lines.append([v, *rates(mine), share(league_score.share(nothing, league_score.alarm)), *ratios(mine)])
    columns = [what, *RATES, "false alarms", "after/before", "oracle/before", "after/oracle"]
    return table(f"## By {what}", columns, lines) if lines else ""


def effects(rows: Sequence[Row]) -> str:
    """One line an effect, with what was said where its name was not first."""
    lines = []
    for name, mine in sorted(league_score.by_effect(league_score.of_kind(rows, "effect")).items()):
        lines.append([name, *rates(mine), *ratios(mine), counted(league_score.confusion(mine))])
    columns = ["hidden", *RATES, "after/before", "oracle/before", "after/oracle", "called instead"]
    return table("## By effect", columns, lines) if lines else ""


def gain(rows: Sequence[Row]) -> str:
    """Forces, flows and lags by what there is to win: a name that leads it no better is worth little, and
    can hardly be found."""
    mine = [
        r
        for r in league_score.of_kind(rows, "effect")
        if not league_score.of_instruments(r) and r.get("before") and "oracle" in r
    ]
    lines = []
    for words, least, most in GAINS:
        here = [r for r in mine if least <= 1.0 - r["oracle"] / r["before"] < most]
        if here:
            lines.append([words, *rates(here), *ratios(here), counted(league_score.confusion(here))])
    columns = [
        "the true effect takes away",
        *RATES,
        "after/before",
        "oracle/before",
        "after/oracle",
        "called instead",
    ]
    words = (
        "Held-out error that the true effect, added in the catalogue's form, takes away; faults of "
        "instruments are left out."
    )
    return table(f"## By what there is to win\n\n{words}", columns, lines) if lines else ""


def counted(answers: "Counter[str]") -> str:
    return ", ".join(f"{name} {n}" if n > 1 else name for name, n in answers.most_common())


def parameters(rows: Sequence[Row]) -> str:
    """Numbers of rightly named effects beside the truth."""
    held: dict[str, list[dict[str, Any]]] = {}
    for r in league_score.of_kind(rows, "effect", "pair"):
        for p in r.get("parameters", []):
            held.setdefault(p["name"], []).append(p)
    lines = []
    for name, found in sorted(held.items()):
        covered = sum(p["covered"] for p in found) / len(found)
        lines.append(
            [name, len(found), share(league_score.middle([p["error"] for p in found])), share(covered)]
        )
    words = (
        "Of rightly named effects whose forms allow a comparison; error as a share of the effect's true size."
    )
    columns = ["parameter", "cases", "median error", "95 % interval holds the truth"]
    return table(f"## Numbers beside the truth\n\n{words}", columns, lines) if lines else ""


def nothing(rows: Sequence[Row]) -> str:
    def what(row: Row) -> str:
        known = "".join(row["known"])
        return f"strong {known} acts and is in the model" if known else DECOYS["".join(row["decoys"])]

    mine = league_score.of_kind(rows, "none", "decoy")
    return answers("## Nothing hidden", "voyage", mine, what, "false alarms", league_score.alarm)


def outside(rows: Sequence[Row]) -> str:
    mine = league_score.of_kind(rows, "outside")
    return answers(
        "## Effects outside the catalogue", "hidden", mine, hidden, "recognised", league_score.recognised
    )


def pairs(rows: Sequence[Row]) -> str:
    mine = league_score.of_kind(rows, "pair")
    one = share(league_score.share(mine, lambda r: set(r["missing_truly"]) & set(r["missing"])))
    words = f"Both named in {share(league_score.share(mine, league_score.both))}, at least one in {one}; "
    words += f"held-out error after/oracle {ratios(mine)[2]}."
    return answers(f"## Two at once\n\n{words}", "hidden", mine, hidden, "both", league_score.both)


def straight(rows: Sequence[Row]) -> str:
    words = "Nothing but a straight course: `undecided` is right, a wrong name is not."
    mine = league_score.of_kind(rows, "straight")
    return answers(f"## Straight sailing only\n\n{words}", "hidden", mine, hidden, "wrong name", called_wrong)


def called_wrong(row: Row) -> bool:
    return bool(row["missing"]) and not set(row["hidden"]) & set(row["missing"])


def hidden(row: Row) -> str:
    return " + ".join(row["hidden"])


def answers(
    title: str,
    head: str,
    rows: Sequence[Row],
    what: Callable[[Row], str],
    rate: str,
    test: Callable[[Row], bool],
) -> str:
    """What was said, by what there was."""
    lines = []
    for name in sorted({what(r) for r in rows}):
        mine = [r for r in rows if what(r) == name]
        said = counted(Counter(league_score.called(r) for r in mine))
        lines.append([name, len(mine), share(league_score.share(mine, test)), said])
    return table(title, [head, "cases", rate, "answers"], lines) if lines else ""

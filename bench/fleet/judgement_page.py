"""docs/results/judgement.md, as far as it is made of the kept answers (keep_answers.py): of the fleet, and of
ships that no fit had seen when they were asked."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from bench.fleet import (
    addition_proof,
    answer_score,
    decision_fit,
    kept_ships,
    probability_fit,
    several_voyages,
)
from bench.fleet.addition_proof import KEPT_ADDITIONS
from bench.fleet.answer_score import Row, share
from bench.fleet.decided_again import decided
from bench.fleet.fleet_figures import FIGURES, SHORT, figures
from bench.fleet.fleet_page import cost, head, in_detail, in_short, lines
from bench.fleet.several_voyages import KEPT_TOGETHER
from bench.fleet.voyage_plan import practice

ADDED = (
    "Asked on 27 November 2026 of the fleet as it was then, with the names of that day. `twin add` of the "
    "lasting causes that were named on {voyages} voyages of {ships} ships, fitted to that voyage and proved "
    "on two more with the same fault, on other days and courses; and proved by thirds of the voyage itself "
    "(`--cross-validated`). Errors: open-loop position error at the longest horizon on the two voyages, "
    "median (10 to 90 %); healthy: of the same ship file on the same days and courses with nothing wrong. "
    "Made by `python -m bench.fleet add FOLDER --keep`."
)
SEVERAL = (
    "{cases} voyages of the fleet of before 30 November 2026 asked alone, and together with one and two more "
    "of the same ship, on other days and courses, with the same fault; in the order of the ships until the "
    "time was over, so that {families}. Made by `python -m bench.fleet together FOLDER --kinds single pair "
    "nothing --keep`."
)
STRICTER = (4.0, 5.0, 6.0, 7.0, 8.0)  # SIGNIFICANT, about the one that stands


def judgement(rows: Sequence[Row], new: Sequence[Row], fit: Mapping[str, Mapping[str, Any]]) -> str:
    """The page of these rows and those of `new` ships; `fit`: what the ships of the other forms ask for
    (decision_fit.chosen)."""
    read, unseen = decision_fit.with_facts(rows), decision_fit.with_facts(new)
    once = decision_fit.of_one_search(read)
    fitted = decision_fit.fitted_lines(decision_fit.held_out(once, fit))
    told = probability_fit.fitted(probability_fit.examples(read), probability_fit.examples(unseen))
    every = [*rows, *new]
    tables = [*_figures(rows, new), *_further(), *in_detail(every)]
    tables += [*_practices([decided(r) for r in every]), *fitted, *_healthy(read), *_moved(once)]
    return "\n".join([*head(every), *tables, *probability_fit.page_lines(told), *cost(every)]) + "\n"


def _figures(rows: Sequence[Row], new: Sequence[Row]) -> list[str]:
    batches: list[list[Row]] = [[decided(r) for r in rows], list(new), [*map(decided, rows), *new]]
    each = [figures(batch) for batch in batches]
    measured = [name for name in FIGURES if each[-1][name].n]
    body = [(name, FIGURES[name][0], *(of[name] for of in each)) for name in measured]
    for name, goal, of in (
        ("95 % intervals of rightly named causes that hold the truth", "90 to 98 %", _intervals),
        ("causes with a posterior of 0.95 or more that are there", "", _sure),
    ):
        body.append((name, goal, *(of(batch) for batch in batches)))
    text = (
        f"{len(rows)} voyages of ships of which earlier fits had seen voyages, as the table of today decides "
        f"them; {len(new)} of [new ships](new-ships.md), as they were answered when no fit and no look had "
        "seen any; and both, to which the probabilities that are told are fitted by now."
    )
    titles = (f"earlier ships ({len(rows)})", f"new ships ({len(new)})", f"both ({len(rows) + len(new)})")
    return lines("Figures", text, ("", "goal", *titles), body)


def _further() -> list[str]:
    """What the owner does after an answer."""
    added, together = (kept_ships.kept(path) for path in (KEPT_ADDITIONS, KEPT_TOGETHER))
    ships = len({row["key"].rpartition("-")[0] for row in added})
    out = ["", "## What was named, added", "", ADDED.format(voyages=len(added), ships=ships), ""]
    out += addition_proof.table(added)
    out += [
        "",
        "## Voyages asked together",
        "",
        SEVERAL.format(cases=len(together), families=_families(together)),
        "",
    ]
    return out + several_voyages.table(together)


def _families(rows: Sequence[Row]) -> str:
    """How many of the rows are of each family."""
    count = Counter(row["key"].partition("-")[0] for row in rows).most_common()
    return " and ".join(f"{n} are of `{family}`" for family, n in count)


def _practices(rows: Sequence[Row]) -> list[str]:
    """The figures by how many reference voyages the ship had, and how they were chosen."""
    ships = {(r["family"], r["seed"]): practice(r["family"], r["seed"])[:2] for r in rows}
    body = []
    for which in sorted(set(ships.values())):
        own = [r for r in rows if ships[r["family"], r["seed"]] == which]
        of = figures(own)
        body.append(
            (
                which[0],
                "calm days chosen" if which[1] else "days as they come",
                sum(x == which for x in ships.values()),
                *(in_short(of[name]) for name in SHORT.values()),
            )
        )
    text = "By the practice of the owner."
    return lines("By reference voyages", text, ("references", "of", "ships", *SHORT), body)


def _intervals(rows: Sequence[Row]) -> answer_score.Share:
    return share([inside for r in rows for _, inside in answer_score.intervals(r)])


def _sure(rows: Sequence[Row]) -> answer_score.Share:
    return share([there for r in rows for p, there in answer_score.answered_posteriors(r) if p >= 0.95])


def _moved(rows: Sequence[Row]) -> list[str]:
    """The decision asked again with one threshold moved."""
    at = {}
    for value in STRICTER:
        with decision_fit.thresholds({"SIGNIFICANT": value}):
            at[value] = decision_fit.outcome(rows, decision_fit.by_table)
    body = [(name, *(f"{of[name][0]} of {of[name][1]}" for of in at.values())) for name in at[STRICTER[0]]]
    text = (
        f"{len(rows)} voyages of the earlier ships, decided by the table of today with `SIGNIFICANT` as "
        "it is (6) and moved; what was found by two searches is left out: each was decided by its own facts."
    )
    titles = ("", *(f"`SIGNIFICANT` {value:g}" for value in STRICTER))
    return lines("One threshold moved", text, titles, body)


def _healthy(rows: Sequence[Row]) -> list[str]:
    """How far healthy voyages end from where the model with the day's weather has them."""
    limits = decision_fit.healthy_limits(rows)
    others = [limit for left_out, limit in limits.items() if left_out]
    count = sum(r["kind"] == "nothing" for r in rows)
    return [
        "",
        f"`NEARLY` is on no grid, for it steers the search as well: {decision_fit.HEALTHY:.0%} of the "
        f"{count} healthy voyages end within {limits['']:.2f} times the expected error, {min(others):.2f} to "
        f"{max(others):.2f} with a form left out.",
    ]

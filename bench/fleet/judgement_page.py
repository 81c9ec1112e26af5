"""docs/results/judgement.md, as far as it is made of the kept answers (keep_answers.py): the first batch, the
second one that no fit had seen, and both with the latest answer to each voyage."""

from collections.abc import Mapping, Sequence
from typing import Any

from bench.fleet import answer_score, decision_fit, probability_fit
from bench.fleet.answer_score import Row, share
from bench.fleet.fleet_page import FIGURES, SHORT, decided, figures, in_short, lines, page
from bench.fleet.kept_rows import of_batch, together
from bench.fleet.voyage_plan import practice

STRICTER = (5.0, 6.0, 7.0, 8.0)  # SIGNIFICANT, from the one that stands


def judgement(rows: Sequence[Row], fit: Mapping[str, Mapping[str, Any]]) -> str:
    """The page of these rows; `fit`: what families of ships ask for (decision_fit.chosen), by `first` and
    `together`."""
    first, both = of_batch(rows, "first"), together(rows)
    fitted = decision_fit.held_out(decision_fit.with_facts(first), fit["first"])
    out = [page(first, {"page": decision_fit.fitted_lines(fitted)}).rstrip("\n")]
    return (
        "\n".join(
            [
                *out,
                *_second(of_batch(rows, "blind"), both, len(of_batch(rows, "again"))),
                *_practices([decided(r) for r in both]),
                *_all(both, fit),
            ]
        )
        + "\n"
    )


def _second(blind: Sequence[Row], both: Sequence[Row], again: int) -> list[str]:
    one, two = figures(blind), figures([decided(r) for r in both])
    body = [(name, FIGURES[name][0], one[name], two[name]) for name in FIGURES]
    for name, of in (
        ("95 % intervals of rightly named causes that hold the truth", _intervals),
        ("causes with a posterior of 0.95 or more that are there", _sure),
    ):
        body.append((name, "", of(blind), of(both)))
    text = (
        f"{len(blind)} further voyages of the same ships, asked by the table of today before anything was "
        f"fitted to them. Beside them all {len(both)} voyages of both batches, with the latest of their "
        f"answers: {again} were asked again, most of them when something was mended that could touch them. "
        "Nine voyages stand in both batches."
    )
    head = ("", "goal", f"second batch, blind ({len(blind)})", f"both, latest answer ({len(both)})")
    return lines("The second batch", text, head, body)


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
    text = "All voyages of both batches with the latest of their answers, by the practice of the owner."
    return lines("By reference voyages", text, ("references", "of", "ships", *SHORT), body)


def _intervals(rows: Sequence[Row]) -> answer_score.Share:
    return share([inside for r in rows for _, inside in answer_score.intervals(r)])


def _sure(rows: Sequence[Row]) -> answer_score.Share:
    return share([there for r in rows for p, there in answer_score.answered_posteriors(r) if p >= 0.95])


def _all(both: Sequence[Row], fit: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """The decision asked again of all voyages: one threshold moved, each family held out, and what the
    probabilities that are told are worth."""
    rows = decision_fit.with_facts(both)
    at = {}
    for value in STRICTER:
        with decision_fit.thresholds({"SIGNIFICANT": value}):
            at[value] = decision_fit.outcome(rows, decision_fit.by_table)
    fitted = decision_fit.held_out(rows, fit["together"])
    moved = fitted["held_out"]["thresholds moved"]
    body = [
        (name, *(f"{of[name][0]} of {of[name][1]}" for of in at.values()), moved[name])
        for name in at[STRICTER[0]]
    ]
    text = (
        "All voyages of both batches with the latest of their answers, decided by the table of today with "
        "`SIGNIFICANT` as it is (5) and moved; and with the thresholds that the other families ask for."
    )
    head = ("", *(f"`SIGNIFICANT` {value:g}" for value in STRICTER), "each family held out")
    out = lines("The thresholds asked again", text, head, body)
    return out + probability_fit.page_lines(probability_fit.fitted(probability_fit.examples(rows)))

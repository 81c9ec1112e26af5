"""docs/results/judgement.md, as far as it is made of the kept answers (keep_answers.py): the first batch, the
second and the third, which no fit had seen, and all with the latest answer to each voyage."""

from collections.abc import Mapping, Sequence
from typing import Any

from bench.fleet import answer_score, decision_fit, probability_fit
from bench.fleet.answer_score import Row, share
from bench.fleet.decided_again import decided
from bench.fleet.fleet_page import FIGURES, SHORT, figures, in_short, lines, page
from bench.fleet.kept_rows import of_batch, together
from bench.fleet.voyage_plan import practice

STRICTER = (5.0, 6.0, 7.0, 8.0)  # SIGNIFICANT, from the one that stands


def judgement(rows: Sequence[Row], fit: Mapping[str, Mapping[str, Any]]) -> str:
    """The page of these rows; `fit`: what families of ships ask for (decision_fit.chosen), by `first` and
    `together`."""
    first, every = of_batch(rows, "first"), together(rows)
    fitted = decision_fit.held_out(decision_fit.with_facts(first), fit["first"])
    out = [page(first, {"page": decision_fit.fitted_lines(fitted)}).rstrip("\n")]
    return (
        "\n".join(
            [
                *out,
                *_blind(rows, every),
                *_practices([decided(r) for r in every]),
                *_all(every, fit),
            ]
        )
        + "\n"
    )


def _blind(rows: Sequence[Row], every: Sequence[Row]) -> list[str]:
    second, third, again = (of_batch(rows, asked) for asked in ("blind", "third", "again"))
    one, two, three = figures(second), figures(third), figures([decided(r) for r in every])
    body = [(name, FIGURES[name][0], one[name], two[name], three[name]) for name in FIGURES]
    for name, of in (
        ("95 % intervals of rightly named causes that hold the truth", _intervals),
        ("causes with a posterior of 0.95 or more that are there", _sure),
    ):
        body.append((name, "", of(second), of(third), of(every)))
    text = (
        f"{len(second)} further voyages of the same ships, asked by the table of today before anything was "
        f"fitted to them; and {len(third)} of new ships, of which no fit had seen any, asked again with what "
        f"was named in the model. Beside them all {len(every)} voyages, with the latest of their answers: "
        f"{len(again)} were asked again, most of them when something was mended that could touch them. Nine "
        "voyages stand in the first two batches."
    )
    head = ("", "goal", f"second batch ({len(second)})", f"third batch ({len(third)})", f"all ({len(every)})")
    return lines("The second batch and the third", text, head, body)


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
    text = "All voyages of the three batches with the latest of their answers, by the practice of the owner."
    return lines("By reference voyages", text, ("references", "of", "ships", *SHORT), body)


def _intervals(rows: Sequence[Row]) -> answer_score.Share:
    return share([inside for r in rows for _, inside in answer_score.intervals(r)])


def _sure(rows: Sequence[Row]) -> answer_score.Share:
    return share([there for r in rows for p, there in answer_score.answered_posteriors(r) if p >= 0.95])


def _all(every: Sequence[Row], fit: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """The decision asked again of all voyages: one threshold moved, each family held out, and what the
    probabilities that are told are worth."""
    rows = decision_fit.with_facts(every)
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
        "All voyages of the three batches with the latest of their answers, decided by the table of today "
        "with `SIGNIFICANT` as it is (5) and moved; and with the thresholds that the other families ask for."
    )
    head = ("", *(f"`SIGNIFICANT` {value:g}" for value in STRICTER), "each family held out")
    out = lines("The thresholds asked again", text, head, body)
    return out + probability_fit.page_lines(probability_fit.fitted(probability_fit.examples(rows)))

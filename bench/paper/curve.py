"""Error over amount of data: the hybrid and the LSTM on the first runs alone, judged on the same unseen
zigzags.

For every `n` runs that teach there is a third of that, at least one, that says when to stop.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from bench.paper import filter as paper_filter
from bench.paper import lstm as paper_lstm
from bench.paper.lab import LabCourse, judge
from bench.paper.models import Workshop, named
from bench.paper.nominal_ship import nominal
from bench.paper.stats import summary
from twin.physics.model import Model


def curve(
    shop: Workshop,
    tuning: paper_filter.Tuning,
    judged_on: Sequence[LabCourse],
    sizes: Sequence[int],
    epochs: int,
    seeds: Sequence[int],
) -> list[dict[str, Any]]:
    """A row for each size; errors as in Table 3, and the last model's for all seeds."""
    rows, plain, seed = [], Model(nominal()), seeds[0]
    for n in sizes:
        small = less(shop, n)
        taught = small.taught(plain, seed, f"hybrid-of-{n}")
        lstm = paper_lstm.train(
            small.legs["train"],
            small.legs["validation"],
            epochs,
            seed,
            keep=shop.work / f"lstm-of-{n}-{epochs}-{seed}.pt",
        )
        _, added = named(small.parts["train"], plain)
        on_top = [small.taught(added, some, f"added-of-{n}").network for some in seeds]
        hybrid = judge(paper_filter.predict(judged_on, plain, taught.network, tuning), judged_on)
        both = [
            summary(judge(paper_filter.predict(judged_on, added, network, tuning), judged_on))
            for network in on_top
        ]
        rows.append(
            {
                "runs": n,
                "hours": sum(c.water.t[-1] for c in small.parts["train"]) / 3600.0,
                "hybrid": summary(hybrid),
                "physics_added_hybrid": both[0],
                "by_seed": [[x["heading_mae_deg"], x["lateral_mae_m"]] for x in both],
                "lstm": summary(judge([paper_lstm.predict(lstm, c) for c in judged_on], judged_on)),
            }
        )
    return rows


def less(shop: Workshop, n: int) -> Workshop:
    """The workshop of who has only n runs to learn from."""
    count = {"train": n, "validation": max(1, n // 3), "test": 1}
    settings = replace(
        shop.settings, rollout_batch=64, rollout_epochs=min(100, 4 * shop.settings.rollout_epochs)
    )
    legs = {part: some[: count[part]] for part, some in shop.legs.items()}
    return replace(
        shop,
        settings=settings,
        legs=legs,
        parts={part: some[: count[part]] for part, some in shop.parts.items()},
    )

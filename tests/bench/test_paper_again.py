"""The gap on more runs: what is sailed again is the same but for its seeds, and the page says what was
compared."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from bench.paper import paper_voyages
from bench.paper.again import PAIRS, again, page
from bench.paper.gap import among_like, change_of


def test_what_is_sailed_again_is_the_same_but_for_seeds_that_nobody_had():
    cases = paper_voyages.lessons(paper_voyages.FULL_PLAN)
    made = again(cases, 45, 13, 3)
    assert len(made["validation again"]) == 39 and len(made["test again"]) == 42
    for part, some in (("validation again", cases[45:58]), ("test again", cases[58:])):
        assert [replace(c, seed=0) for c in made[part]] == 3 * [replace(c, seed=0) for c in some]
    seeds = [c.seed for c in (*cases, *made["validation again"], *made["test again"])]
    assert len(set(seeds)) == len(seeds)


def test_voyages_drawn_among_their_like_do_not_scatter_by_kind():
    """Test: two parts whose windows err by 1 in one sea and by 10 in another, the same in both. Expected: no
    gap and no doubt among like ones; a wide interval by voyage."""
    voyage = np.repeat(np.arange(6), 4)
    error = np.where(voyage < 3, 1.0, 10.0)
    e, kinds = SimpleNamespace(voyage=voyage, heading_deg=error), 3 * ["TS-01 mixed"] + 3 * ["TS-03 mixed"]
    both = {"validation": e, "test": e}
    assert among_like(both, dict.fromkeys(both, kinds), "heading_deg", 500)["among_like_95"] == [0.0, 0.0]
    low, high = change_of(both, "heading_deg", 500)["by_voyage_95"]
    assert low < -30.0 and high > 30.0


def test_the_page_holds_every_pair_with_its_interval():
    x = {
        "validation": 0.2,
        "test": 0.25,
        "change_percent": 25.0,
        "by_voyage_95": [-1.0, 51.0],
        "among_like_95": [9.0, 41.0],
    }
    found = {"runs": {"validation": 13, "test": 14}} | {
        name: {"heading": x, "lateral": x} for name in ("hybrid", "analytic_current")
    }
    text = "\n".join(page({"times": 3, "pairs": dict.fromkeys(PAIRS, found)}, True))
    assert all(text.count(f"| {said} | 13, 14 |") == 2 for said in PAIRS)
    assert (
        "`twin-bench gap --full --times 3`"
    ) in text and "| 0.200, 0.250 | +25.0 % | -1.0 to +51.0 % | +9.0 to +41.0 % |" in text

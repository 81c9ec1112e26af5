"""In which set of effects what is named stands with its numbers."""

from types import SimpleNamespace

import numpy as np
import pytest

from twin.study.diagnosis.answer import SearchAnswer
from twin.study.diagnosis.open_loop_check import OpenLoopCheck
from twin.study.diagnosis.refine import Found
from twin.study.reference.evidence import Hypothesis

ALONE, BESIDE = ("HullFouling",), ("HullFouling", "Wind")
WORN = ("HullFouling", "RudderWear")


def answered(*missing, struck=(), **error_m):
    """An answer that names these effects. Of every set of effects (its names joined by _): how far off [m] it
    leads the ship, where 10 m are expected; the more effects the likelier one step ahead. `struck`: sets
    that the search took from its book."""
    ends = {(): 30.0} | {tuple(names.split("_")): m for names, m in error_m.items()}
    found = {
        s: Found(
            Hypothesis(s, "usual", 20.0 * len(s), 0.0),
            SimpleNamespace(z=np.ones(3)),
            None,
            open_loop_error_m=m,
            expected_error_m=10.0,
        )
        for s, m in ends.items()
    }
    path = OpenLoopCheck(found, {"usual": 10.0}, dict.fromkeys(found, 0.0), 20.0, frozenset(), {"Wind"})
    weighed = path.weigh([f.hypothesis for s, f in found.items() if s not in struck])
    case = SimpleNamespace(
        causes=lambda s: tuple(n for n in s if n != "Wind"),
        day=lambda s: tuple(n for n in s if n == "Wind"),
        effects=[SimpleNamespace(owner="Wind", name="c_x")],
        catalogue={"Wind": SimpleNamespace(size="")},
    )
    best, named = SimpleNamespace(best=weighed[0]), SimpleNamespace(missing=missing)
    return SearchAnswer(case, weighed, found, {}, path, best, None, named)


def test_the_numbers_of_a_named_cause_come_from_a_set_that_stands_in_what_was_weighed():
    """Test: fouling leads the ship as near as expected; with wind beside it, likelier one step ahead, it ends
    farther off and drops out. Expected: the number of fouling alone."""
    told = answered("HullFouling", HullFouling=9.0, HullFouling_Wind=12.0, Wind=29.0)
    assert BESIDE not in {h.effects for h in told.weighed}
    assert told.shown == ALONE
    assert answered("HullFouling", HullFouling=9.0, HullFouling_Wind=9.0).shown == BESIDE


def test_a_set_that_the_search_struck_out_gives_no_numbers():
    """Test: a set with a load that does not float is found and not in the book."""
    assert answered("HullFouling", struck=[BESIDE], HullFouling=9.0, HullFouling_Wind=9.0).shown == ALONE


@pytest.mark.parametrize(
    "ends, shown",
    [
        ({"HullFouling": 9.0}, ALONE),
        ({"HullFouling_RudderWear": 9.0}, WORN),  # only beside another cause
    ],
)
def test_a_named_cause_has_its_numbers_where_no_set_holds_the_named_weather_beside_it(ends, shown):
    assert answered("HullFouling", "Wind", Wind=9.0, **ends).shown == shown


def test_where_no_set_that_was_weighed_holds_what_is_named_the_likeliest_is_shown():
    assert answered("RudderWear", HullFouling=9.0).shown == ALONE
